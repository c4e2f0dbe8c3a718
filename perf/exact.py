#!/usr/bin/env python3
"""Wrong answers against time, beside Embree: runs perf/exact.cpp and draws what it prints.

    ./run perf exact [--keep] [--draw] [--rays N] [--rounds N] [--scene NAME]

--keep writes docs/exact.csv, docs/images/exact.svg and the totals of docs/accuracy.md; else CSV and
chart stand beside the program.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import COLOURS, commit, cpu_name, csv_bench, plt

LOOKS = {"grelha calls": ("o", 0), "grelha streams": ("s", 2), "embree robust": ("^", 1),
         "embree": ("v", 4), "CGAL exact": ("D", 3), "CGAL predicates": ("P", 5)}


def wrong(row):
    return sum(int(row[k]) for k in ("lost", "false", "other"))


def draw(rows, about, path):
    rays = int(about.split()[0])
    fig, axes = plt.subplots(figsize=(7, 4.6), layout="constrained")
    for who, (marker, colour) in LOOKS.items():
        own = [r for r in rows if r["who"] == who]
        axes.scatter([float(r["ns"]) for r in own], [100 * wrong(r) / rays for r in own],
                     marker=marker, s=36, facecolors="none", edgecolors=COLOURS[colour], label=who)
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=.01)
    axes.set(xlabel="nanoseconds a ray, one thread", ylabel="wrong answers, % of rays",
             title="Rays at vertices, edges and faces of two scans: 0 is no wrong answer",
             ylim=(-.002, 120))
    axes.set_yticks([0, .01, .1, 1, 10, 100], ["0", ".01", ".1", "1", "10", "100"])
    axes.grid(alpha=.3)
    axes.legend(loc="center left", bbox_to_anchor=(0, .3), fontsize=9)
    fig.savefig(path, metadata={"Date": None})
    plt.close(fig)


def told(rows, about):
    names = [who for who in LOOKS if any(r["who"] == who for r in rows)]
    sums = {who: sum(wrong(r) for r in rows if r["who"] == who) for who in names}
    said = ", ".join(f"{who} {n:,}" for who, n in sums.items())
    return (f"{about}. Wrong in all: {said}. {cpu_name()}, commit {commit()}, "
            "`./run perf exact --keep`.")


if __name__ == "__main__":
    csv_bench(__doc__, "exact", lambda folder: [folder / "exact"], draw, told)
