#!/usr/bin/env python3
"""Includes point one way: scenes, include: to themselves; kernel: to include; frontend: to both; c
to include; tests and perf to anything. In the kernel and the frontend each room includes itself and
those before it, and every source is in a room. Components, a header and its source each, do not
include each other round in a circle. None asks the environment: what a program does follows from
its command line, and a benchmark's numbers from its sources.

    layering.py ROOT           lists what is against that
    layering.py --self-test    plants an offence against each rule, and finds them and no others
"""
import graphlib
import pathlib
import re
import sys
import tempfile

ALLOWED = {"scenes": r"scenes/", "include": r"grelha/", "kernel": r"kernel/|grelha/",
           "frontend": r"(frontend|kernel|grelha)/", "c": r"c/|grelha/|grelha\.h$"}
ROOMS = {"kernel": "base scene shapes grid world traverse query shade picture isa".split(),
         "frontend": "files images scene ply nff input commands jobs cli".split()}
# `grelha scene` offers the generators.
EXCEPTION = ("frontend/cli/main.cpp", "scenes/generators.hpp")
OURS = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<]'
                  r'((?:scenes|kernel|grelha|frontend|tests|perf|c/|\.)[^"<>]*)[">]', re.M)
SETTING = re.compile(r'getenv\((?!"TERM")|environ\[')  # TERM: what a terminal can do


def may_include(file, included):
    layer, *inner = file.split("/")
    if not re.match(ALLOWED[layer], included):
        return (file, included) == EXCEPTION
    rooms, to = ROOMS.get(layer, []), included.split("/")
    if to[0] != layer or inner[0] not in rooms:
        return True
    return to[1] in rooms[:rooms.index(inner[0]) + 1]


def complaints(root):
    graph = {}
    for path in sorted(p for layer in (*ALLOWED, "perf") for p in (root / layer).rglob("*")
                       if p.suffix in (".hpp", ".cpp", ".h", ".inc")):
        file, text = str(path.relative_to(root)), path.read_text()
        layer, room = file.split("/")[:2]
        if SETTING.search(text):
            yield f"{file} reads variables of the environment"
        if layer == "perf":
            continue
        if layer in ROOMS and (room not in ROOMS[layer] or file.count("/") != 2):
            yield f"{file} is in no room"
        component = re.sub(r"^include/|\.\w+$", "", file)
        for included in OURS.findall(text):
            if not may_include(file, included):
                yield f"{file} includes {included}"
            if (other := re.sub(r"\.\w+$", "", included)) != component:
                graph.setdefault(component, set()).add(other)
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        yield f"a circle: {' <- '.join(error.args[1])}"


PLANTED = {
    "scenes/a.cpp": (["kernel/x.hpp", "scenes/b.hpp"], ["includes kernel/x.hpp"]),
    "include/grelha/a.hpp": (["kernel/base/a.hpp"], ["includes kernel/base/a.hpp"]),
    "kernel/a.hpp": (["../frontend/x.hpp"], ["includes ../frontend/x.hpp", "is in no room"]),
    "kernel/base/a.hpp": (["kernel/base/b.hpp", "grelha/world.hpp"], []),
    "kernel/grid/a.hpp": (["kernel/shapes/a.hpp", "kernel/query/a.hpp", "kernel/attic/a.hpp"],
                          ["includes kernel/query/a.hpp", "includes kernel/attic/a.hpp"]),
    "frontend/nff/a.cpp": (["frontend/jobs/a.hpp", "kernel/isa/a.hpp"],
                           ["includes frontend/jobs/a.hpp"]),
    "frontend/cli/main.cpp": (["scenes/generators.hpp", "scenes/vec.hpp"],
                              ["includes scenes/vec.hpp"]),
    "c/a.cpp": (["c/a.hpp", "grelha.h", "tests/x.hpp"], ["includes tests/x.hpp"]),
    "perf/a.cpp": (['x"  // getenv("SORT'], ["reads variables of the environment"]),
    "perf/b.cpp": (['x"  // getenv("TERM'], []),
}
CIRCLE = {"kernel/grid/b.hpp": "", "kernel/grid/b.cpp": '#include "kernel/grid/c.hpp"\n',
          "kernel/grid/c.hpp": '#include "kernel/grid/b.hpp"\n'}


def self_test():
    texts = {name: "".join(f'#include "{i}"\n' for i in included)
             for name, (included, _) in PLANTED.items()}
    wanted = {f"{name} {wrong}" for name, (_, all_wrong) in PLANTED.items() for wrong in all_wrong}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (texts | CIRCLE).items():
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        found = set(complaints(pathlib.Path(folder)))
    circles = {line for line in found if line.startswith("a circle: kernel/grid/")}
    return [*(f"planted, found otherwise: {line}" for line in sorted((found - circles) ^ wanted)),
            *(["planted circle not found"] if not circles else [])]


if __name__ == "__main__":
    FOUND = list(self_test() if sys.argv[1] == "--self-test" else
                 complaints(pathlib.Path(sys.argv[1])))
    print(*FOUND, sep="\n", end="\n" * bool(FOUND))
    sys.exit(bool(FOUND))
