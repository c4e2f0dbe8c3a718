#!/usr/bin/env python3
"""How many files hold the code that runs behind a call, a stream and a pixel: follows calls through
the debug info of the AVX2 copy, and writes the table of docs/architecture.md.

    docs/files_behind.py
"""
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/architecture.md"
FLAGS = ("-std=c++20 -O3 -g -mavx2 -DNDEBUG -ffp-contract=off -fno-tree-slp-vectorize -fopenmp "
         "-ffunction-sections -w -Iinclude -I.").split()
ENTRIES = {"one call of `closest`": "closest_one", "a stream of rays": "closest",
           "a pixel of a picture": "render_strip"}
CALL = re.compile(r"R_X86_64_(?:PLT32|PC32|GOTPCREL\w*)\s+(.+?)(?:[-+]0x[0-9a-f]+)?$")
PLACE = re.compile(r"\S*?((?:kernel|include/grelha)/\S+):\d+")


def listing():
    with tempfile.TemporaryDirectory() as folder:
        made = f"{folder}/copy.o"
        subprocess.run(["g++", *FLAGS, "-c", "kernel/isa/variant_avx2.cpp", "-o", made], cwd=ROOT,
                       check=True)
        return subprocess.run(["objdump", "-d", "-r", "-l", "-C", "--inlines", made], check=True,
                              capture_output=True, text=True, errors="replace").stdout


def functions(text):
    """Of each function: the files whose lines it holds, and what it calls."""
    found, now = {}, None
    for line in text.splitlines():
        if head := re.match(r"[0-9a-f]+ <(.*)>:$", line):
            now = found.setdefault(head[1], (set(), set()))
        elif now:
            if call := CALL.search(line):
                now[1].add(call[1])
            now[0].update(PLACE.findall(line))
    return found


def files_behind(found, name):
    entry = re.compile(rf"(?:\w+ )?(?:\w+::|\(anonymous namespace\)::)*{name}[(<]")
    seen, files = set(), set()
    to_see = [f for f in found if entry.match(f)]
    while to_see:
        function = to_see.pop()
        if function not in seen:
            seen.add(function)
            files |= found[function][0]
            to_see += [f for f in found[function][1] if f in found]
    return files


def main():
    found = functions(listing())
    rows = ["| behind | files | of them in |", "|---|--:|---|"]
    for label, name in ENTRIES.items():
        files = files_behind(found, name)
        rooms = sorted({re.sub(r"^(kernel/\w+|include)/.*", r"\1", f) for f in files})
        counts = ", ".join(f"{sum(f.startswith(room + '/') for f in files)} "
                           f"{room.removeprefix('kernel/')}" for room in rooms)
        rows.append(f"| {label} | {len(files)} | {counts} |")
    text = PAGE.read_text()
    begin, end = "<!-- made by docs/files_behind.py -->", "<!-- end of files -->"
    head, _, tail = text.partition(begin)
    PAGE.write_text(f"{head}{begin}\n" + "\n".join(rows) + f"\n{end}{tail.partition(end)[2]}")
    print("\n".join(rows))


if __name__ == "__main__":
    main()
