#!/usr/bin/python3
"""Draws docs/images/architecture.svg, the dependencies of the #include lines. Needs graphviz.

A box is a component of the kernel or of the frontend; arrows that follow from others are omitted.
--check: reports if the picture is out of date. If components include each other, nothing is drawn.
"""
import collections
import graphlib
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LAYERS = {"frontend": "#e8f1fa", "kernel": "#fbf1dd", "include": "#f6eef8", "scenes": "#e9f5e6"}
EVERYWHERE = {"include/grelha"}  # below all else; arrows to it would only hide the others
STYLE = """rankdir=TB; ranksep=.3; nodesep=.15; fontname="Helvetica"; fontsize=16;
node [shape=box style="filled,rounded" fillcolor=white fontname="Helvetica" fontsize=16 height=.32
margin="0.1,0.04"]; edge [color="#00000080" arrowsize=.6];"""


def unit(path):
    if path.parts[0] == "grelha":
        return "include/grelha"
    if len(path.parts) > 2:
        return "/".join(path.parts[:2])
    return f"{path.parent}/{path.stem}"


def arrows():
    found = collections.defaultdict(set)
    for layer in LAYERS:
        for file in sorted((ROOT / layer).rglob("*.[ch]pp")):
            here = unit(file.relative_to(ROOT))
            found[here]
            for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M):
                there = unit(pathlib.Path(name))
                if there != here and there not in EVERYWHERE:
                    found[here].add(there)
    return found


def want_no_cycle(layer):
    """A header and its .cpp are one."""
    found = collections.defaultdict(set)
    for file in (ROOT / layer).rglob("*.[ch]pp"):
        here = str(file.relative_to(ROOT).with_suffix(""))
        included = re.findall(r'^#include "([^"]+)"', file.read_text(), re.M)
        found[here] |= {name.rsplit(".", 1)[0] for name in included} - {here}
    try:
        graphlib.TopologicalSorter(found).prepare()
    except graphlib.CycleError as error:
        sys.exit("files that include each other: " + " -> ".join(reversed(error.args[1])))


def graph():
    found = arrows()
    scenes = [u for u in found if u.startswith("scenes/")]
    for u in scenes:  # the generators are many and alike
        del found[u]
    for targets in found.values():
        if any(t.startswith("scenes/") for t in targets):
            targets -= {t for t in targets if t.startswith("scenes/")}
            targets.add("scenes/*")
    found["scenes/*"] = set()
    lines = ["strict digraph {", STYLE]
    for layer, colour in LAYERS.items():
        lines.append(f'subgraph cluster_{layer} {{ label="{layer}/"; style=filled; '
                     f'color="{colour}";')
        lines += [f'"{u}" [label="{u.split("/")[1]}"];'
                  for u in sorted(found) if u.startswith(layer + "/")]
        lines.append("}")
    lines += [f'"{u}" -> "{t}";'
              for u in sorted(found) if u not in EVERYWHERE for t in sorted(found[u])]
    return "\n".join(lines + ["}"])


def main():
    for layer in "frontend", "scenes", "kernel":
        want_no_cycle(layer)
    if not shutil.which("tred"):
        print("skipped: no graphviz")
        sys.exit(77)
    reduced = subprocess.run(["tred"], input=graph(), capture_output=True, text=True,
                             check=True).stdout
    target = ROOT / "docs/images/architecture.svg"
    if "--check" in sys.argv:
        boxes = set(re.findall(r"<title>([^&<]*/[^&<]*)</title>", target.read_text()))
        wanted = {t for t in re.findall(r'^\s*"([^"]*/[^"]*)"\s*\[', reduced, re.M)}
        if boxes != wanted:
            sys.exit("docs/images/architecture.svg is of other sources "
                     f"(run docs/architecture.py): {sorted(boxes ^ wanted)}")
        return
    svg = subprocess.run(["dot", "-Tsvg"], input=reduced, capture_output=True, text=True,
                         check=True).stdout
    target.write_text(re.sub(r"<!-- Generated.*?-->\n", "", svg, flags=re.S))


main()
