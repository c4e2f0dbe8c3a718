#!/usr/bin/env python3
"""Closest points beside Embree and CGAL: runs perf/distance.cpp and prints its table.

    ./run perf distance [--keep] [--scene NAME] [--points N] [--rounds N]

--keep writes the table into docs/performance.md.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import table_bench

if __name__ == "__main__":
    table_bench(__doc__, "distance")
