#!/usr/bin/env python3
"""Grid construction beside Embree's trees: runs perf/build.cpp, keeps its figures and draws them.

    ./run perf build [--quick] [options of the benchmark: --scene NAME, --rounds N, --threads N, --scenes DIR]

The benchmark prints the table. A whole run writes docs/build.csv and docs/images/build.svg, a part of one, or --quick, the same
beside the program; the benchmark's own JSON stays there in either case.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "build", "svg.fonttype": "none"})  # the same file from the same figures; text as text
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
WAYS = {"grelha": ("#0072B2", "o"), "embree low": ("#E69F00", "s"), "embree medium": ("#D55E00", "^")}  # after Okabe and Ito


def rows_of(path):
    """Counters by scene, in the order they were measured."""
    known = r"(.* ms|.* bytes|primitives)$"
    return {b["name"].split("/")[0]: {k: v for k, v in b.items() if re.match(known, k)}
            for b in json.loads(path.read_text())["benchmarks"] if not b.get("error_occurred")}


def write_csv(rows, path):
    columns = list(dict.fromkeys(k for r in rows.values() for k in r if k != "primitives"))
    with open(path, "w", newline="") as f:
        table = csv.writer(f, lineterminator="\n")
        table.writerow(["scene", "primitives", *(c.replace(" ", "_") for c in columns)])
        for scene, r in rows.items():
            table.writerow([scene, int(r["primitives"]), *(f"{r[c]:.4g}" if c in r else "" for c in columns)])


def draw(rows, path):
    threads = sorted({int(m[1]) for r in rows.values() for k in r if (m := re.match(r"grelha (\d+) least ms", k))})
    fig, panels = plt.subplots(1, len(threads) + 1, figsize=(5 * len(threads) + 5, .8 + .5 * len(rows)), sharey=True, layout="constrained")
    names = list(rows)[::-1]
    for panel, n in zip(panels, [*threads, None]):
        for way, (colour, marker) in WAYS.items():
            at = [(rows[s], y) for y, s in enumerate(names)]
            value = (lambda r: r.get(f"{way} bytes")) if n is None else \
                    (lambda r: r[k] * 1e6 / r["primitives"] if (k := f"{way} {n} least ms") in r else None)
            points = [(value(r), y) for r, y in at if value(r) is not None]
            if points:
                panel.plot(*zip(*points), marker, color=colour, label=way)
        panel.set(yticks=range(len(names)), yticklabels=names, xlabel="bytes a primitive" if n is None else "ns a primitive",
                  title="memory, the scene's own arrays among it" if n is None else f"time, {n} thread{'s' * (n > 1)}")
        panel.set_xlim(left=0)
        panel.grid(alpha=.3)
    panels[0].legend()
    fig.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0], epilog="Other options go to the benchmark.")
    parser.add_argument("--program", default=ROOT / "build/release/grelha", help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--quick", action="store_true", help="two small scenes, two rounds")
    asked, rest = parser.parse_known_args()
    folder = pathlib.Path(asked.program).resolve().parent
    if asked.quick:
        rest = ["--scene", "balls 3", "--scene", "mount 5", "--rounds", "2", *rest]
    figures = folder / "build.json"
    figures.unlink(missing_ok=True)
    done = subprocess.run([folder / "build", f"--benchmark_out={figures}", "--benchmark_out_format=json", *rest])
    if done.returncode or not figures.exists():
        sys.exit(done.returncode or 1)
    rows = rows_of(figures)
    if not rows:
        sys.exit(1)
    docs = ROOT / "docs" if not rest else None
    table, picture = (docs or folder) / "build.csv", (docs / "images" if docs else folder) / "build.svg"
    write_csv(rows, table)
    draw(rows, picture)
    print(f"\n{table}, {picture}")


if __name__ == "__main__":
    main()
