#!/usr/bin/env python3
"""Every rung of the ladder at its best density: runs perf/ladder.cpp and keeps what it prints.

    ./run perf ladder [--keep] [options of the benchmark]

--keep writes docs/ladder.csv; perf/figures.py makes the table of docs/performance.md of it.
"""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import Bench, arguments

FAIR = ["--benchmark_repetitions=3", "--benchmark_enable_random_interleaving=true"]


def rows_of(printed):
    """Scene by scene a table of rung, ns a ray, density and times."""
    scene, rays = "", ""
    for line in printed.splitlines():
        heading = re.match(r"(.*), (\w+) rays, each rung at its best density", line)
        if heading:
            scene, rays = heading.groups()
        cells = [cell.strip() for cell in line.strip("| ").split("|")]
        if scene and len(cells) == 4 and re.match(r"[\d.]+$", cells[1]):
            rung, ns, density, times = cells
            yield [rung, scene, rays, f"{float(ns):.3g}", density, times]


def main():
    asked, rest = arguments(__doc__, 1).parse_known_args()
    bench = Bench("ladder", asked)
    done = subprocess.run([bench.program.parent / "ladder", *FAIR, *rest], text=True,
                          stdout=subprocess.PIPE)
    print(done.stdout)
    if done.returncode:
        sys.exit(done.returncode)
    bench.write_csv("ladder", ["rung", "scene", "rays", "ns_a_ray", "density", "times"],
                    rows_of(done.stdout))


if __name__ == "__main__":
    main()
