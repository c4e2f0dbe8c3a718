#!/usr/bin/env python3
"""Closest points beside Embree and CGAL: runs perf/distance.cpp and prints its table.

    ./run perf distance [--keep] [--scene NAME] [--points N] [--rounds N]

--keep writes the table into docs/performance.md.
"""
import argparse
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DOCS, ROOT, commit, cpu_name, put_section


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--keep", action="store_true", help="write into docs/performance.md")
    asked, rest = parser.parse_known_args()
    folder = pathlib.Path(asked.program).resolve().parent
    done = subprocess.run([folder / "distance", *rest], stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.stdout)
    section = (f"{done.stdout}\n{cpu_name()}, one thread, commit {commit()}, "
               "`./run perf distance --keep`.")
    if asked.keep:
        put_section(DOCS / "performance.md", "perf/distance.py", section)
    print(section)


if __name__ == "__main__":
    main()
