#!/usr/bin/env python3
"""Grid construction beside Embree's trees: runs perf/build.cpp, keeps its figures and draws them.

    ./run perf build [--quick] [--draw] [options of the benchmark: --scene NAME, --rounds N,
                     --threads N, --scenes DIR]

The benchmark prints the table. A whole run writes docs/build.csv and docs/images/build.svg, a part
of one, or --quick, the same beside the program; the benchmark's own JSON stays there in either
case. --draw: the chart alone, from docs/build.csv.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys

from matplotlib.lines import Line2D

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DRAW_HELP, ROOT, plt, read_csv, record
from chart import legend_below

# Colour (after Okabe and Ito), marker, label
WAYS = {
    "grelha": ("#0072B2", "o", "Grelha's grids"),
    "embree low": ("#E69F00", "s", "Embree's trees, low quality"),
    "embree medium": ("#D55E00", "^", "Embree's trees, medium quality")
}


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
            figures = (f"{r[c]:.4g}" if c in r else "" for c in columns)
            table.writerow([scene, int(r["primitives"]), *figures])


def rows_from_csv():
    """Reads the results that write_csv stored in docs/."""
    return {
        r["scene"]: {k.replace("_", " "): float(v)
                     for k, v in r.items()
                     if k != "scene" and v}
        for r in read_csv("build")
    }


def draw(rows, path):
    threads = sorted({
        int(m[1]) for r in rows.values() for k in r
        if (m := re.match(r"grelha (\d+) least ms", k))})
    fig, panels = plt.subplots(1,
                               len(threads) + 1,
                               figsize=(4.2 * len(threads) + 5, 1.4 + .5 * len(rows)),
                               sharey=True,
                               layout="constrained")
    names = list(rows)[::-1]
    for panel, n in zip(panels, [*threads, None]):
        for way, (colour, marker, label) in WAYS.items():
            for y, r in enumerate(rows[s] for s in names):
                least, middle = (f"{way} bytes", ) * 2 if n is None else (f"{way} {n} least ms",
                                                                          f"{way} {n} ms")
                if least in r:
                    scale = 1 if n is None else 1e6 / r["primitives"]
                    panel.plot([r[least] * scale, r[middle] * scale], [y, y],
                               color=colour,
                               linewidth=2,
                               alpha=.6)
                    panel.plot(r[least] * scale,
                               y,
                               marker,
                               color=colour,
                               label=label if y == 0 else None)
        panel.set(yticks=range(len(names)),
                  yticklabels=names,
                  xlabel="bytes a primitive" if n is None else "nanoseconds a primitive",
                  title="memory, the scene's own arrays among it"
                  if n is None else f"time, {n} thread{'s' * (n > 1)}")
        panel.set_xlim(left=0)
        panel.grid(alpha=.3)
    panels[0].set_ylabel("scene")
    handles = [
        Line2D([], [], marker=marker, linestyle="", color=colour, label=label)
        for colour, marker, label in WAYS.values()
    ]
    handles.append(
        Line2D([], [],
               color="#777777",
               linewidth=2,
               label="from the least of nine times to their median"))
    legend_below(fig, handles, 4)
    fig.savefig(path, metadata={"Date": None})
    plt.close(fig)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0],
                                     epilog="Other options go to the benchmark.")
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--quick", action="store_true", help="two small scenes, two rounds")
    parser.add_argument("--draw", action="store_true", help=DRAW_HELP)
    asked, rest = parser.parse_known_args()
    if asked.draw:
        draw(rows_from_csv(), ROOT / "docs/images/build.svg")
        return
    folder = pathlib.Path(asked.program).resolve().parent
    if asked.quick:
        rest = ["--scene", "balls 3", "--scene", "mount 5", "--rounds", "2", *rest]
    figures = folder / "build.json"
    figures.unlink(missing_ok=True)
    done = subprocess.run([
        folder / "build", f"--benchmark_out={figures}", "--benchmark_out_format=json", *rest])
    if done.returncode or not figures.exists():
        sys.exit(done.returncode or 1)
    rows = rows_of(figures)
    if not rows:
        sys.exit(1)
    docs = ROOT / "docs" if not rest else None
    table = (docs or folder) / "build.csv"
    picture = (docs / "images" if docs else folder) / "build.svg"
    write_csv(rows, table)
    if docs:
        record("build")
    draw(rows, picture)
    print(f"\n{table}, {picture}")


if __name__ == "__main__":
    main()
