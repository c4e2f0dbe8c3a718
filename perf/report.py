#!/usr/bin/env python3
"""The four scenes of the 2019 report, step by step: our seconds and gains beside its own.

    ./run perf report [--rounds N] [--scenes DIR] [--keep] [--draw]

DIR holds the course's scene files; where one is missing its generated twin stands in. report.cpp
says what is timed.
"""
import pathlib
import sys
from datetime import date

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import COLOURS, ROOT, Bench, arguments, cores, cpu_name, plt, read_csv, table, times
from chart import set_axis

# name, file of the course, generator and size, samples a pixel; then the report's own seconds
# without grid, with grid, with grid and threads
SCENES = [
    ("balls high", "course-nff/balls_high.nff", ("balls", 4), 1, (12 * 60 + 14, 15, 1.5)),
    ("mount very high", "course-nff/mount_very_high.nff", ("mount", 7), 1,
     (2 * 3600 + 21 * 60 + 3, 32, 5.5)),
    ("BFBoat", "course-nff/p3d1819-rtx/BFboat.nff", ("boat", 10), 1, (14 * 60 + 45, 15, 1.7)),
    ("Distant, lens 32", "course-nff/p3d1819-rtx/distant_balls.nff", ("distant", 3), 32,
     (29, 26, 5.3)),
]
# the report's lens for Distant stands in no file: sharp at the nearest ball, as a comment in it
# says
LENS = "aperture 20\nfocal 0.61\n"
# title, key of report.cpp, whether all threads share the rest of the picture, column of the
# report's figures
STEPS = [("no grid", "no grid", False, 0), ("grid", "grid", False, 1),
         ("grid, mailboxes", "mailboxes", False, None), ("grid, threads", "grid threads", True, 2),
         ("packets", "packets", False, None), ("packets, threads", "packets threads", True, None)]


def find(bench, scenes, name, course, generator, samples):
    original = scenes / course
    if not original.exists():
        return bench.scene(*generator), "its generated twin"
    if samples == 1:
        return original, "the course's file"
    text = original.read_text()
    if "\naperture" not in text:
        text = text.replace("resolution 512 512\n", "resolution 512 512\n" + LENS)
    path = bench.folder / "lens.nff"
    path.write_text(text)
    return path, "the course's file"


def main():
    parser = arguments(__doc__, rounds=5)
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT.parent / "shared/scenes",
                        help="folder of the course's scenes")
    asked = parser.parse_args()
    bench = Bench("report", asked)
    if asked.draw:
        draw(bench, from_csv(read_csv("report")))
        return
    results, csv_rows = [], []
    for name, course, generator, samples, theirs in SCENES:
        path, source = find(bench, asked.scenes, name, course, generator, samples)
        got = bench.tool(path, samples, bench.rounds)
        ours = []
        for title, key, threads, column in STEPS:
            rest = 0 if key.startswith("packets") else got["rest threads" if threads else "rest"]
            ours.append(got[key] + rest)
            csv_rows.append([name, source, title, got["stride"] if key == "no grid" else 1,
                             f"{ours[-1]:.4g}", theirs[column] if column is not None else ""])
        results.append((name, ours, theirs))
        print(f"{name}: done ({source})", flush=True)
    bench.write_csv("report",
                    ["scene", "source", "step", "every_nth_ray", "seconds", "report_seconds"],
                    csv_rows)
    draw(bench, results)
    bench.section(tell(results))


def gain(time, grid):
    return times(grid / time) if time <= grid * 1.05 else "1/" + times(time / grid)


def tell(results):
    rows = []
    for step, (title, _, _, column) in enumerate(STEPS):
        row = [title]
        for _, ours, theirs in results:
            row += [gain(ours[step], ours[1]),
                    "–" if column is None else gain(theirs[column], theirs[1])]
        rows.append(row)
    header = [words for name, *_ in results for words in (name, "the report")]
    return f"""Four scenes of the student report of 2019 at 512 x 512, paths of at most 6 rays:
gains over the row `grid` of the same column, ours with {cores()} threads, the report's with twelve
of an i7-8750H ([seconds](report.csv)).

{table(["", *header], rows)}

The rows down to `grid, threads` trace the report's way: one ray, one primitive, one cell at a time,
on a grid of M = 2. `packets` are whole renders. Distant has three balls and a plane, so the kernel
builds no grid.

![seconds of each step, ours and the report's](images/report.svg)
"""


def from_csv(rows):
    """Name, our seconds of all steps and the report's own, as they were kept in docs/."""
    theirs = {name: seconds for name, *_, seconds in SCENES}
    return [(name, [float(r["seconds"])
                    for r in rows
                    if r["scene"] == name], theirs[name])
            for name in dict.fromkeys(r["scene"] for r in rows)]


def draw(bench, results):
    figure, panels = plt.subplots(1, 4, figsize=(12, 3.6), layout="constrained", sharey=True)
    for panel, (name, ours, theirs) in zip(panels, results):
        at = range(len(STEPS))
        panel.plot(at, ours, "o-", color=COLOURS[0], label="Grelha, here")
        known = [(i, theirs[c]) for i, (*_, c) in enumerate(STEPS) if c is not None]
        panel.plot(*zip(*known), "s--", color=COLOURS[1], label="the report, i7-8750H")
        panel.set(yscale="log", title=name)
        panel.set_xticks(list(at), [s[0] for s in STEPS], rotation=40, ha="right")
        panel.grid(axis="y", alpha=.4)
    set_axis(panels[0].yaxis, .01, 1e4, {"log": True})
    panels[0].set_ylabel("seconds a picture")
    panels[0].legend(frameon=False)
    bench.save(figure, "report")


if __name__ == "__main__":
    main()
