#!/usr/bin/env python3
"""Compares the cost of a ray with Embree: runs perf/trace.cpp, stores its results, draws ratios.

    ./run perf trace [--quick] [--draw] [options of the benchmark: --scene NAME, --kind NAME,
                     --size N, --rounds N, --scenes DIR, ...]

The benchmark prints the tables. A whole run (--rounds may be given) writes docs/trace.csv,
docs/images/trace.svg; any other writes these beside the program. perf/figures.py makes the table of
docs/performance.md. --draw: the chart alone, from docs/trace.csv.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

from matplotlib.lines import Line2D

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DRAW_HELP, ROOT, plt, read_csv, record
from chart import legend_below

FIRST = [
    "rays", "hits", "disagree", "ns/ray", "tests/ray", "cells/ray", "lanes busy", "fell back",
    "ratio", "ratio of the best", "ratio to fast", "ratio of calls", "ratio of streams of 8",
    "ratio by default"]
# Label, then marker and colours (after Okabe and Ito)
FASTER = ("as a render traces them: faster than Embree", {"marker": "o", "color": "#0072B2"})
SLOWER = ("as a render traces them: slower than Embree", {"marker": "s", "color": "#D55E00"})
BEST = ("the best of Grelha's ways, where another is faster",
        {"marker": "D", "markerfacecolor": "none", "markeredgecolor": "#777777"})
TITLES = {
    "primary": "camera rays", "AA + lens": "through a lens,\n16 a pixel",
    "hard shadow": "to a point light", "area 16": "to an area light,\n16 a point",
    "mirror": "off mirrors", "glossy 16": "off rough mirrors,\n16 a point",
    "scattered": "scattered", "shadow of mirror hits": "to a point light,\noff mirrors"
}


def cells_of(figures):
    """Counters by (scene, kind), in the order they were measured."""
    cells = {}
    for b in figures["benchmarks"]:
        if not b.get("error_occurred") and b["run_type"] == "iteration":
            *scene, kind = b["name"].split("/iterations:")[0].split("/")
            known = ("repetition_index", "family_index", "per_family_instance_index", "repetitions",
                     "threads", "iterations", "real_time", "cpu_time")
            cells["/".join(scene), kind] = {
                k: v for k, v in b.items() if isinstance(v, (int, float)) and k not in known}
    return cells


def write_csv(cells, path):
    ways = sorted({k for c in cells.values() for k in c if k.endswith(" ns")},
                  key=lambda k: (not k.startswith("grelha"), k))
    with open(path, "w", newline="") as f:
        table = csv.writer(f, lineterminator="\n")
        table.writerow([
            "scene", "kind", *(k.replace(" ", "_").replace("/", "_a_") for k in FIRST + ways)])
        for (scene, kind), c in cells.items():
            table.writerow([
                scene, kind, *("" if k not in c else int(c[k]) if k == "rays" else f"{c[k]:.4g}"
                               for k in FIRST + ways)])


def cells_from_csv():
    """Reads the results that write_csv stored in docs/; only the columns of the chart."""
    return {(r["scene"], r["kind"]):
            {"ratio": float(r["ratio"]), "ratio of the best": float(r["ratio_of_the_best"])}
            for r in read_csv("trace")
            if r["ratio"]}


def draw(cells, path):
    scenes = list(dict.fromkeys(s for s, _ in cells))[::-1]
    kinds = list(dict.fromkeys(k for _, k in cells))
    fig, panels = plt.subplots(1,
                               len(kinds),
                               figsize=(1.2 + 1.7 * len(kinds), 1.9 + .32 * len(scenes)),
                               sharex=True,
                               sharey=True,
                               layout="constrained",
                               squeeze=False)
    for panel, kind in zip(panels[0], kinds):
        panel.axvline(1, color="#999999", linewidth=1)
        for y, scene in enumerate(scenes):
            c = cells.get((scene, kind))
            if not c:
                continue
            if c["ratio of the best"] < .98 * c["ratio"]:  # the same mark otherwise
                panel.plot(c["ratio of the best"], y, markersize=6, linestyle="", **BEST[1])
            panel.plot(c["ratio"],
                       y,
                       markersize=6,
                       linestyle="",
                       **(FASTER if c["ratio"] < 1 else SLOWER)[1])
        panel.set(xscale="log",
                  xlabel="time / Embree's",
                  yticks=range(len(scenes)),
                  yticklabels=scenes,
                  xticks=[.2, .5, 1, 2])
        panel.set_title(TITLES.get(kind, kind), fontsize=11)
        panel.xaxis.set_major_formatter("{x:g}")
        panel.xaxis.set_minor_formatter("")
        panel.grid(axis="x", alpha=.3)
    panels[0][0].set_ylabel("scene")
    fig.suptitle(
        "Time of tracing rays / time of Embree's best mode (robust) on the same rays, one thread; "
        "left of 1 Grelha is faster",
        fontsize=12)
    handles = [
        Line2D([], [], linestyle="", markersize=6, label=label, **look)
        for label, look in (FASTER, SLOWER, BEST)
    ]
    legend_below(fig, handles, 3)
    fig.savefig(path, metadata={"Date": None})
    plt.close(fig)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0],
                                     epilog="Other options go to the benchmark.")
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--quick", action="store_true", help="small pictures, two rounds")
    parser.add_argument("--draw", action="store_true", help=DRAW_HELP)
    asked, rest = parser.parse_known_args()
    if asked.draw:
        draw(cells_from_csv(), ROOT / "docs/images/trace.svg")
        return
    folder = pathlib.Path(asked.program).resolve().parent
    if asked.quick:
        rest = ["--size", "128", "--rounds", "2", *rest]
    figures = folder / "trace.json"
    done = subprocess.run([
        folder / "trace", f"--benchmark_out={figures}", "--benchmark_out_format=json", *rest])
    if done.returncode == 2 or not figures.exists():
        sys.exit(done.returncode)
    told_by_benchmark = json.loads(figures.read_text())
    cells = cells_of(told_by_benchmark)
    if not cells:
        sys.exit(done.returncode or 1)
    whole = not rest or rest[0] == "--rounds" and len(rest) == 2
    numbers = (ROOT / "docs" if whole else folder) / "trace.csv"
    write_csv(cells, numbers)
    if whole:
        record("trace")
    told = [str(numbers)]
    if all("ratio" in c for c in cells.values()):
        picture = (ROOT / "docs/images" if whole else folder) / "trace.svg"
        draw(cells, picture)
        told.append(str(picture))
    print("\n" + ", ".join(told))
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
