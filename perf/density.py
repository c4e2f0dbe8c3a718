#!/usr/bin/env python3
"""Every kind of ray and whole pictures at several densities of the grid: runs perf/density.cpp.

    ./run perf density [--keep] [options of the benchmark]

--keep writes docs/density.csv; perf/figures.py makes the table of docs/performance.md of it.
"""
import csv
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import Bench, arguments


def main():
    asked, rest = arguments(__doc__, 1).parse_known_args()
    bench = Bench("density", asked)
    done = subprocess.run([bench.program.parent / "density", "--csv", *rest], text=True,
                          stdout=subprocess.PIPE)
    print(done.stdout)
    if done.returncode:
        sys.exit(done.returncode)
    header, *rows = csv.reader(done.stdout.splitlines())
    bench.write_csv("density", header, rows)


if __name__ == "__main__":
    main()
