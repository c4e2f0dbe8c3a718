#!/usr/bin/env python3
"""Three programs as a user writes them, by Grelha and by Embree: their lines and times.

    ./run perf programs [--keep] [--rounds N] [--mesh FILE]

Runs perf/programs.cpp and counts the lines of perf/programs/, without comments and blank ones.
--keep writes docs/programs.csv, of which perf/figures.py makes the figures of docs/library.md.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DOCS, ROOT, record

HEADER = ["program", "mesh", "lines", "embree_lines", "seconds", "embree_seconds", "ratio",
          "agree_percent"]


def lines_of(library):
    """Lines of each program, by its heading."""
    text = (ROOT / f"perf/programs/by_{library}.cpp").read_text()
    found = {}
    for name, body in re.findall(r"^// program: ([^\n]*)\n(.*?)(?=^// (?:program|end))", text,
                                 re.M | re.S):
        lines = [line.strip() for line in body.splitlines()]
        found[name] = sum(bool(line) and not line.startswith("//") for line in lines)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--keep", action="store_true", help="write into docs/")
    asked, rest = parser.parse_known_args()
    folder = pathlib.Path(asked.program).resolve().parent
    done = subprocess.run([folder / "programs", *rest], stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.returncode)
    own, other = lines_of("grelha"), lines_of("embree")
    rows = []
    for row in csv.DictReader(done.stdout.splitlines()):
        name, seconds = row["program"], float(row["grelha"])
        beside = [f"{float(row['embree']):.3f}", f"{seconds / float(row['embree']):.2f}",
                  f"{100 * float(row['agree']):.2f}"] if row["embree"] else [""] * 3
        rows.append([name, row["mesh"], own[name], other[name], f"{seconds:.3f}", *beside])
        print(*rows[-1], sep=", ", flush=True)
    path = (DOCS if asked.keep else folder) / "programs.csv"
    with open(path, "w", newline="") as f:
        csv.writer(f, lineterminator="\n").writerows([HEADER, *rows])
    if asked.keep:
        record("programs")
    print(path)


if __name__ == "__main__":
    main()
