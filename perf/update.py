#!/usr/bin/env python3
"""Scenes that move, beside Embree: runs perf/update.cpp and prints its table.

    ./run perf update [--keep] [--frames N] [--scene NAME]

--keep writes the table into docs/performance.md.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import table_bench

if __name__ == "__main__":
    table_bench(__doc__, "update")
