#!/usr/bin/env python3
"""Error against time: what a second of each way of sampling buys, as a chart, a table and ratios.

    ./run perf error_time [--quick] [--draw] [--repeats K] [--size N] [--scene NAME]...

Error is the RMSE in display units (channels cut to 0 to 1) against a reference of another seed and
100 times the samples of the finest setting, made of two halves whose difference tells its own
error. Time is the best of K renders, all settings taking turns; without reading, building the grid
and writing. References stay in the build folder; the program is taken to draw the same picture as
when they were made, so delete error_time/ there when it no longer does.
"""
import argparse
import csv
import math
import pathlib
import sys

from matplotlib.ticker import NullFormatter

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DRAW_HELP, ROOT, plt, read_csv, record
from image_error import Refused, Workshop, read_pfm, rmse, time_to_reach

FINEST = 256                   # samples of the finest fixed setting
REFERENCE = 100 * FINEST       # in two halves
REFERENCE_ROW = "reference"    # its method in the CSV
SEED = 1

# name, title, generator and its size or file, options
SCENES = [
    ("star", "edges: star", ("star", 36), []),
    ("boat", "area light: boat", ("boat", 10), ["--shadows", "random:2"]),
    ("awning", "area light in four dimensions: awning", ("awning", 64), []),
    ("distant", "lens: distant", ("distant", 8), ["--lens", "40"]),
    ("balls", "lens, area lights, gloss: balls", "scenes/data/balls.nff",
     ["--shadows", "random:.5", "--lens", "12", "--glossy", ".08", "--depth", "3"]),
]

SAMPLES = [1, 4, 16, 64, FINEST]
# `jitter` pairs pixel and light, lens or lobe by shuffled jitter, `unshuffled` in one order; of the
# pixel alone they are the same.
METHODS = {
    "random": [(str(n), ["--sampler", "random", "--samples", str(n)]) for n in SAMPLES],
    "jitter": [(str(n), ["--sampler", "jitter", "--samples", str(n)]) for n in SAMPLES],
    "unshuffled": [(str(n), ["--sampler", "unshuffled", "--samples", str(n)]) for n in SAMPLES],
    "adaptive": [(f"0.1,{d}", ["--aa", f"adaptive:0.1,{d}"]) for d in range(1, 6)],
    "sobol": [(str(n), ["--sampler", "sobol", "--samples", str(n)]) for n in SAMPLES],
    "error": [(str(e), ["--error", str(e)])
              for e in (.08, .04, .02, .01, .005, .0025, .00125, .000625)],
}
# Colours after Okabe and Ito, told apart by the colour-blind too; marker and dash say the same
# again.
LOOKS = {
    "random": ("#999999", "o", ":"), "jitter": ("#E69F00", "s", "--"),
    "unshuffled": ("#D55E00", "v", "--"), "adaptive": ("#CC79A7", "^", "-."),
    "sobol": ("#0072B2", "D", "-"), "error": ("#000000", "*", "-")}
LABELS = {
    "random": "random", "jitter": "jitter, shuffled", "unshuffled": "jitter, unshuffled",
    "adaptive": "adaptive:0.1,D", "sobol": "sobol", "error": "--error E"}


def measure(shop, scene, options, methods, reference, repeats):
    """Points by method, in the order of its settings: time, rays and error of each."""
    picture = shop.folder / "point.pfm"
    points, refused = {}, set()
    for turn in range(repeats):
        for method, settings in methods.items():
            for setting, words in settings:
                if method in refused:
                    continue
                try:
                    stats = shop.render(scene, [*options, *words, "--seed", str(SEED)], picture)
                except Refused as why:
                    print(f"  {method} left out: {why}", flush=True)
                    refused.add(method)
                    continue
                pixels = math.prod(stats["size"])
                point = points.setdefault((method, setting), {"seconds": math.inf})
                point["seconds"] = min(point["seconds"], stats["seconds"]["render"])
                if turn == 0:
                    point["rays"] = sum(stats["rays"].values())
                    point["samples"] = stats["rays"]["primary"] / pixels
                    point["rmse"] = rmse(read_pfm(picture), reference)
    return points


def of(points, method):
    return [p for (m, _), p in points.items() if m == method]


def tell_ratios(points, fixed_finest):
    def error_of(method):
        return points.get((method, fixed_finest), {}).get("rmse")

    for against in ("jitter", "random"):
        if error_of("sobol") and error_of(against):
            print(f"  RMSE at {fixed_finest} samples, {against} / sobol: "
                  f"{error_of(against) / error_of('sobol'):.2f}")
    best = min(
        (p["rmse"], m, s) for (m, s), p in points.items() if m in ("random", "jitter", "sobol"))
    for target in dict.fromkeys([("sobol", str(int(fixed_finest) // 4)), best[1:]]):
        aim = points[target]
        for method in ("error", "adaptive"):
            curve = of(points, method)
            if not curve:
                continue
            reached = time_to_reach(curve, aim["rmse"])
            told = (
                f"{reached / aim['seconds']:.2f} of its time" if reached else
                f"beyond its settings, RMSE {min(p['rmse'] for p in curve):.2g} to "
                f"{max(p['rmse'] for p in curve):.2g}")
            print(
                f"  {LABELS[method]} to the RMSE of {' '.join(target)}, {aim['rmse']:.2g}: {told}")
    for (method, setting), p in points.items():
        if method == "error":
            print(f"  asked for {setting}: RMSE {p['rmse']:.2g} with {p['samples']:.1f} samples a "
                  "pixel")


def draw(results, size, path):
    fig, panels = plt.subplots(3, 2, figsize=(11, 13), layout="constrained")
    for panel, (title, points, floor) in zip(panels.flat, results):
        for method in METHODS:
            curve = of(points, method)
            if curve:
                color, marker, dash = LOOKS[method]
                panel.plot([p["seconds"] for p in curve], [p["rmse"] for p in curve], dash,
                           color=color, marker=marker, markersize=9 if marker == "*" else 6,
                           label=LABELS[method])
        panel.set(xscale="log", yscale="log", title=title, xlabel="render time, s",
                  ylabel="RMSE (white is 1; lower is better)")
        for axis in (panel.xaxis, panel.yaxis):  # 0.01, not 10^-2; the powers of ten alone
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
        panel.grid(which="major", alpha=.4)
        panel.axhline(floor, color="#009E73", linewidth=1, linestyle=(0, (1, 3)),
                      label="the reference's own error")
    for panel in list(panels.flat)[len(results):]:
        panel.axis("off")
    handles = dict(zip(*reversed(panels[0][0].get_legend_handles_labels())))
    panels[-1][-1].legend(handles.values(),
                          handles.keys(),
                          fontsize=11,
                          loc="center",
                          frameon=False)
    fig.suptitle(
        f"{size}x{size}: random, both jitters and sobol with 1, 4, 16, 64, 256 samples a pixel; "
        "adaptive with D from 1 to 5; --error from .08 to .000625",
        fontsize=10)
    fig.savefig(path, dpi=90)


def from_csv(rows):
    """Title, points and the reference's own error of each scene, as they were kept in docs/."""
    for name, title, *_ in SCENES:
        own = [r for r in rows if r["scene"] == name]
        floor = next(float(r["rmse"]) for r in own if r["method"] == REFERENCE_ROW)
        points = {(r["method"], r["setting"]):
                  {"seconds": float(r["seconds"]), "rmse": float(r["rmse"])}
                  for r in own
                  if r["method"] in METHODS}
        yield title, points, floor


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="[build/release/grelha]")
    parser.add_argument("--size", type=int, default=192, help="side of the pictures [192]")
    parser.add_argument("--repeats", type=int, default=5,
                        help="renders of each setting, the best counts [5]")
    parser.add_argument("--scene", action="append", choices=[s[0] for s in SCENES],
                        help="this one alone [all five]")
    parser.add_argument("--quick", action="store_true",
                        help="a smoke run: tiny pictures, few samples, nothing kept in docs/")
    parser.add_argument("--draw", action="store_true", help=DRAW_HELP)
    asked = parser.parse_args()
    if asked.draw:
        draw(list(from_csv(read_csv("error-time"))), asked.size,
             ROOT / "docs/images/error-time.png")
        return
    size, repeats, methods = asked.size, asked.repeats, METHODS
    finest, reference_samples = str(FINEST), REFERENCE
    if asked.quick:
        size, repeats, finest, reference_samples = 32, 1, str(SAMPLES[2]), 100 * SAMPLES[2]
        methods = {m: settings[:3] for m, settings in METHODS.items()}
    shop = Workshop(asked.program, "error_time", size)
    out = shop.folder if asked.quick or asked.scene else ROOT / "docs"
    images = out if out == shop.folder else out / "images"

    results, rows = [], []
    for name, title, source, options in SCENES:
        if asked.scene and name not in asked.scene:
            continue
        print(title, flush=True)
        scene = shop.scene(source)
        reference, floor = shop.reference(scene, options, reference_samples)
        print(f"  reference: {reference_samples} samples a pixel, its own RMSE about {floor:.1g}",
              flush=True)
        points = measure(shop, scene, options, methods, reference, repeats)
        tell_ratios(points, finest)
        results.append((title, points, floor))
        rows += [[name, method, setting, f"{p['samples']:.4g}", p["rays"], f"{p['seconds']:.4g}",
                  f"{p['rmse']:.4g}"]
                 for (method, setting), p in points.items()]
        rows.append(
            [name, REFERENCE_ROW, reference_samples, reference_samples, "", "", f"{floor:.2g}"])

    with open(out / "error-time.csv", "w", newline="") as f:
        table = csv.writer(f, lineterminator="\n")
        table.writerow([
            "scene", "method", "setting", "samples_per_pixel", "rays", "seconds", "rmse"])
        table.writerows(rows)
    if out == ROOT / "docs":
        record("error-time")
    draw(results, size, images / "error-time.png")
    print(f"{out / 'error-time.csv'}, {images / 'error-time.png'}")


if __name__ == "__main__":
    main()
