#!/usr/bin/env python3
"""All hits of rays, listed and counted, beside Embree's filters: runs perf/lists.cpp and prints its
table.

    ./run perf lists [--keep] [--size N] [--rounds N] [--scene NAME]

--keep writes the table into docs/performance.md, without times.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import table_bench

if __name__ == "__main__":
    table_bench(__doc__, "lists", columns=(0, 2, 11, 12, 13))
