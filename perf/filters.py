#!/usr/bin/env python3
"""The share of rays that leave each filter of the triangle test: runs `judge filters`, draws it.

    ./run perf filters [--keep] [--draw] [--count RAYS]

--keep writes docs/filters.csv, docs/images/filters.svg and the table of docs/accuracy.md; else CSV
and chart stand beside the program.
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import COLOURS, commit, cpu_name, csv_bench, plt, table

STAGES = {"floats": ("o", 0, "not by floats"), "doubles": ("s", 1, "nor by doubles"),
          "order": ("^", 2, "order of two hits by exact numbers")}


def place_name(row):
    mesh, scale, moved, eye = (row[k] for k in ("mesh", "scale", "moved", "eye"))
    said = []
    if float(scale) != 1:
        said.append(f"size x {float(scale):.0e}".replace("e+", "e"))
    if float(moved):
        said.append(f"moved {float(moved):,.0f}")
    if float(eye) > 1:
        said.append(f"eye {float(eye):,.0f}")
    return f"{mesh}, {', '.join(said)}" if said else mesh


def places(rows):
    """{name of a place: {kind of rays: row}}"""
    found = {}
    for row in rows:
        found.setdefault(place_name(row), {})[row["kind"]] = row
    return found


def draw(rows, _, path):
    found = places(rows)
    fig, axes = plt.subplots(1, 2, figsize=(9, .21 * len(found) + 1.6), sharey=True,
                             layout="constrained")
    ways = {"random rays": lambda kinds, stage: float(kinds["random"][stage]),
            "the worst of five kinds": lambda kinds, stage: max(float(k[stage])
                                                                for k in kinds.values())}
    for ax, (title, value) in zip(axes, ways.items()):
        for stage, (marker, colour, label) in STAGES.items():
            ax.scatter([value(kinds, stage) for kinds in found.values()], range(len(found)), s=30,
                       marker=marker, facecolors="none", edgecolors=COLOURS[colour], label=label)
        ax.set_xscale("symlog", linthresh=.3)
        ax.set_xticks([0, .3, 1, 3, 10, 30, 100], ["0", ".3", "1", "3", "10", "30", "100"])
        ax.set(title=title, xlabel="% of rays", xlim=(-.03, 130))
        ax.grid(alpha=.3)
    axes[0].set_yticks(range(len(found)), found)
    axes[0].invert_yaxis()
    fig.legend(*axes[0].get_legend_handles_labels(), loc="upper center", ncols=3)
    fig.get_layout_engine().set(rect=(0, 0, 1, .96))
    fig.savefig(path, metadata={"Date": None})
    plt.close(fig)


def told(rows, about):
    found = places(rows)
    kinds = list(dict.fromkeys(r["kind"] for r in rows))

    def cell(row):
        return "; ".join(f"{float(row[s]):.3g}" for s in STAGES)

    lines = [[name, *(cell(by_kind[k]) for k in kinds)] for name, by_kind in found.items()]
    return (f"{about}. Each cell: per cent of rays that floats do not decide; that doubles do not "
            "decide either; whose first two hits exact numbers put in order.\n\n"
            + table(["mesh", *kinds], lines)
            + f"\n\n{cpu_name()}, commit {commit()}, `./run perf filters --keep`.")


def judge(folder):
    """Builds the judge, since no program has the name of this script."""
    subprocess.run(["cmake", "--build", folder, "--target", "judge"], check=True,
                   stdout=subprocess.DEVNULL)
    return [folder / "judge", "filters"]


if __name__ == "__main__":
    csv_bench(__doc__, "filters", judge, draw, told)
