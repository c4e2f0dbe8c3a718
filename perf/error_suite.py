#!/usr/bin/env python3
"""Compares the true error of `--error` renders with the requested one, on generated scenes that are
hard to sample and on ordinary ones.

    ./run perf error_suite [--hostile N] [--first N] [--kinds A,B] [--errors A,B] [--seeds N]
                           [--size N] [--most N] [--folder F] [--long] [--keep] [SCENE...]

Hostile scenes are those of perf/lib/hostile_scenes.py, variant by variant; ordinary ones the files
named, or those of ORDINARY where ../shared/scenes has them. For each E, the true RMSE over E: worst
and median. Errors are in display units (channels cut to 0 to 1), against a mean of two references
whose own error is at most a quarter of the finest E, or of --most samples. It is taken off in
squares; runs whose reference stays coarser than half their E are left out. Then shares of runs:

- kept: true RMSE at most E; beyond: above 1.3 E
- bound: the run's own bound is at least the true RMSE
- missed: tiny objects, in %, with less than a tenth of the light that the reference shows; by E
- light: the pictures' mean over the reference's, on average
- time: CPU seconds over those of the best fixed number of samples for the same true RMSE, geometric
  mean; and worst

Scenes, references and a CSV of all runs stay in the build folder, or in F. --keep writes the table
of docs/sampling.md as well, --long asks for all twenty variants, five seeds and an E of .001.
"""
import argparse
import csv
import dataclasses
import math
import pathlib
import shlex
import statistics
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DOCS, ROOT, commit, cpu_name, put_section, record, table
from error_charts import draw_error_charts
from hostile_scenes import COUNTED, KINDS, VARIANTS, scene
from image_error import Workshop, read_pfm, rmse, time_to_reach

LEAST, LEAST_COUNTED = 2 * 1024, 2 * 4096  # samples of a reference, in two halves
SHOWN = .02                    # a tiny thing counts that adds as much; a finer E asks for it
FIXED = [2 ** k for k in range(9)]
ORDINARY = [
    "spd/balls.nff", "spd/gears.nff", "spd/jacks3.nff", "spd/lattice4.nff", "spd/mount4.nff",
    "spd/rings.nff", "spd/sombrero.nff", "spd/teapot.nff", "spd/tetra-5.nff",
    "course-nff/dof_test.nff", "course-nff/balls_low.nff", "ply/bunny.ply", "ply/dragon.ply",
    "spd-generated/shells_5.nff", "spd-generated/tree_3.nff"]
COLUMNS = [
    "kind", "variant", "error", "seed", "true", "reference_error", "claimed", "bound", "samples",
    "things", "missed", "mean", "seconds", "time", "command"]


def reference(shop, path, options, least, finest, most):
    """Of as many samples as its own error asks for: a quarter of the finest E, if that can be."""
    samples = least
    while True:
        picture, own = shop.reference(path, options, samples)
        if own <= finest / 4 or samples >= most:
            write_pfm(picture, shop.folder / f"{path.stem}-reference.pfm")
            return picture, own
        samples = min(4 * samples, most)


def write_pfm(picture, path):
    height, width, _ = picture.shape
    path.write_bytes(b"PF\n%d %d\n-1\n" % (width, height) + picture[::-1].astype("<f4").tobytes())


def display(picture):
    return np.clip(picture, 0, 1).mean(axis=2)


def things(excess):
    """Numbers of the pixels that tiny things brighten, from 1; neighbours belong together."""
    on = excess > SHOWN / 2
    labels = np.where(on, 1 + np.arange(on.size).reshape(on.shape), 0)
    while True:
        padded, before = np.pad(labels, 1), labels
        around = [padded[1 + y:padded.shape[0] - 1 + y, 1 + x:padded.shape[1] - 1 + x]
                  for y in (-1, 0, 1) for x in (-1, 0, 1)]
        labels = np.where(on, np.max(around, axis=0), 0)
        if (labels == before).all():
            return np.unique(labels, return_inverse=True)[1].reshape(on.shape)


class Tiny:
    """The countable things of a scene: where they are, and how much the reference shows of each."""

    def __init__(self, picture, bare):
        self.bare = display(bare)
        excess = display(picture) - self.bare
        self.labels = things(excess)
        self.shows = self.sums(excess)
        self.counted = self.shows >= SHOWN

    def sums(self, excess):
        return np.bincount(self.labels.ravel(), excess.ravel())[1:]

    def missed(self, picture):
        got = self.sums(display(picture) - self.bare)
        return int((got < self.shows / 10)[self.counted].sum())


def fixed_curve(shop, path, options, picture, own):
    """Points of plain samples, for time_to_reach."""
    curve = []
    for n in FIXED:
        stats = shop.render(path, [*options, "--samples", n, "--seed", 1],
                            shop.folder / "point.pfm")
        curve.append({"rmse": without(rmse(read_pfm(shop.folder / "point.pfm"), picture), own),
                      "seconds": stats["seconds"]["render_cpu"]})
    return curve


def without(measured, own):
    """The RMSE to the truth, of that to a reference which has an error of its own."""
    return max(measured ** 2 - own ** 2, 1e-18) ** .5


@dataclasses.dataclass
class Subject:
    """A scene of the suite."""
    kind: str
    variant: str
    path: pathlib.Path
    options: list
    bare: pathlib.Path = None  # without its tiny things, where these are counted


def generated(folder, kind, variant):
    text, options = scene(kind, variant)
    path, bare = folder / f"{kind}-{variant}.nff", None
    path.write_text(text)
    if kind in COUNTED:
        bare = folder / f"{kind}-{variant}-bare.nff"
        bare.write_text(scene(kind, variant, bare=True)[0])
    return Subject(kind, variant, path, [*options, "-j", "1"], bare)


def runs_of(shop, of, asked):
    """A dict of COLUMNS for each E and seed of one scene."""
    path, options = of.path, of.options
    least = LEAST_COUNTED if of.bare else LEAST
    picture, own = reference(shop, path, options, least, min(asked.errors), asked.most)
    tiny, point = None, shop.folder / "point.pfm"
    if of.bare:
        tiny = Tiny(picture, reference(shop, of.bare, options, LEAST, SHOWN / 4, asked.most)[0])
    curve = fixed_curve(shop, path, options, picture, own)
    for error in asked.errors:
        for seed in range(1, asked.seeds + 1):
            words = [*options, "--error", error, "--seed", seed]
            stats = shop.render(path, words, point)
            image, told = read_pfm(point), stats["error"]
            true, seconds = without(rmse(image, picture), own), stats["seconds"]["render_cpu"]
            reached = time_to_reach(curve, true)
            yield {
                "kind": of.kind, "variant": of.variant, "error": error, "seed": seed, "true": true,
                "reference_error": own, "claimed": told["rmse"], "bound": told["rmse_bound"],
                "samples": told["samples"] / image[..., 0].size,
                "things": int(tiny.counted.sum()) if tiny else 0,
                "missed": tiny.missed(image) if tiny else 0,
                "mean": display(image).mean() / max(display(picture).mean(), 1e-9),
                "seconds": seconds, "time": seconds / reached if reached else "",
                "command": shlex.join([
                    "./run", "render", str(path), "-o", "p.pfm", *shop.size, *map(str, words)])}


def share(hits):
    hits = list(hits)
    return sum(hits) / len(hits) if hits else float("nan")


def told_share(value):
    return "" if value != value else f"{100 * value:.1f} %"


def share_missed(runs):
    count = sum(r["things"] for r in runs)
    return sum(r["missed"] for r in runs) / count if count else float("nan")


class Summary:
    """Figures of a set of runs."""

    def __init__(self, runs):
        self.whole = runs
        self.runs = [r for r in runs if r["reference_error"] <= r["error"] / 2]
        self.kept = share(r["true"] <= r["error"] for r in self.runs)
        self.beyond = share(r["true"] > 1.3 * r["error"] for r in self.runs)
        self.bound = share(r["bound"] >= r["true"] for r in self.runs)
        self.missed = share_missed([r for r in runs if r["error"] < SHOWN])
        self.mean = statistics.fmean(r["mean"] for r in self.runs) if self.runs else float("nan")
        times = [r["time"] for r in self.runs if r["time"]]
        self.time = math.exp(statistics.fmean(map(math.log, times))) if times else None
        self.slowest = max(times, default=None)

    def ratios(self, error):
        own = [r["true"] / error for r in self.runs if r["error"] == error]
        return f"{max(own):.2f}, {statistics.median(own):.2f}" if own else ""

    def missed_at(self, errors):
        shares = [share_missed([r for r in self.whole if r["error"] == e]) for e in errors]
        return ", ".join(f"{100 * s:.1f}" for s in shares if s == s)

    def cells(self, errors):
        return [f"{len(self.runs)} of {len(self.whole)}", *(self.ratios(e) for e in errors),
                told_share(self.kept), told_share(self.bound), self.missed_at(errors),
                f"{self.mean:.4f}", f"{self.time:.2f}, {self.slowest:.2f}" if self.time else ""]


def verdict(hostile, ordinary):
    wanted = {}
    if hostile.runs:
        wanted |= {
            "hostile: true RMSE at most E in 95 % of runs": hostile.kept >= .95,
            "never above 1.3 E": hostile.beyond == 0,
            "bound at least the truth in 93 %": hostile.bound >= .93,
            "light within 1 %": abs(hostile.mean - 1) <= .01,
            "time at most .7": hostile.time <= .7}
    if ordinary.runs:
        wanted |= {
            "ordinary: true RMSE at most E in all runs": ordinary.kept == 1,
            "time at most 1": ordinary.time <= 1,
            "worst 2": ordinary.slowest <= 2}
    print("\n" + "; ".join(f"{what}: {'met' if met else '**not met**'}"
                           for what, met in wanted.items()))
    return all(wanted.values())


def tell_worst(runs, folder, count=10):
    print("\nWorst runs, as true RMSE over E:\n")
    for r in sorted(runs, key=lambda r: -r["true"] / r["error"])[:count]:
        print(f"    {r['true'] / r['error']:.2f}  {r['command']}")
    print(f"\nand for each: ./run compare p.pfm {folder}/KIND-VARIANT-reference.pfm --display")


def write_csv(runs, path):
    with open(path, "w", newline="") as f:
        table = csv.DictWriter(f, COLUMNS, extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        for r in runs:
            table.writerow({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in r.items()})


def requested():
    def names(text):
        wrong = set(text.split(",")) - set(KINDS)
        if wrong:
            raise argparse.ArgumentTypeError(f"no kind: {', '.join(sorted(wrong))}; there are "
                                             f"{', '.join(KINDS)}")
        return text.split(",")

    def numbers(text):
        return [float(word) for word in text.split(",")]

    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="[build/release/grelha]")
    parser.add_argument("--kinds", type=names, default=list(KINDS), help="[all]")
    parser.add_argument("--hostile", type=int, default=20, help="scenes of these kinds [20]")
    parser.add_argument("--first", type=int, default=0,
                        help="variant of each kind to begin with; constants were chosen by 0 and 1")
    parser.add_argument("--errors", type=numbers, default=[.03, .01, .003], help="[.03,.01,.003]")
    parser.add_argument("--seeds", type=int, default=2, help="runs of each scene and E [2]")
    parser.add_argument("--size", type=int, default=64, help="side of the pictures [64]")
    parser.add_argument("--most", type=int, default=2 * 4096,
                        help="samples of a reference [8192]")
    parser.add_argument("--long", action="store_true", help="the whole of it: hours")
    parser.add_argument("--folder", default="error_suite",
                        help="where scenes and references stay [error_suite beside the program]")
    parser.add_argument("--keep", action="store_true",
                        help="write the table and the CSV of docs/ as well")
    parser.add_argument("scenes", nargs="*", type=pathlib.Path, metavar="SCENE",
                        help="scene files and meshes besides")
    asked = parser.parse_args()
    if asked.long:
        asked.hostile, asked.seeds, asked.most = len(asked.kinds) * VARIANTS, 5, 2 * 65536
        asked.errors = [.03, .01, .003, .001]
    return asked


def ordinary_scenes(asked):
    """The files named, or those that are there."""
    if asked.scenes:
        return asked.scenes
    there = [ROOT.parent / "shared" / "scenes" / name for name in ORDINARY]
    there = [path for path in there if path.exists()]
    if not there:
        print("ordinary scenes: skipped, ../shared/scenes is not there; name some", file=sys.stderr)
    return there


def subjects_by_row(shop, asked):
    """Yields each row of the table with the scenes that it summarises."""
    of_kind = {kind: [] for kind in asked.kinds}
    for k in range(min(asked.hostile, len(asked.kinds) * (VARIANTS - asked.first))):
        kind = asked.kinds[k % len(asked.kinds)]
        of_kind[kind].append(generated(shop.folder, kind, asked.first + k // len(asked.kinds)))
    yield from of_kind.items()
    yield "ordinary", [Subject("ordinary", path.name, path, ["-j", "1"])
                       for path in ordinary_scenes(asked)]


def main():
    asked = requested()
    shop = Workshop(asked.program, asked.folder, asked.size)
    head = ["kind", "runs", *(f"true / E at {e:g}: worst, median" for e in asked.errors), "kept",
            "bound", "missed, %", "light", "time: mean, worst"]
    rows, runs = [], []
    for kind, subjects in subjects_by_row(shop, asked):
        own = [run for subject in subjects for run in runs_of(shop, subject, asked)]
        if not own:
            continue
        runs += own
        rows.append([kind, *Summary(own).cells(asked.errors)])
        print("; ".join(map(str, rows[-1])), flush=True)
        write_csv(runs, shop.folder / "error-suite.csv")
    hostile = Summary([r for r in runs if r["kind"] != "ordinary"])
    ordinary = Summary([r for r in runs if r["kind"] == "ordinary"])
    if hostile.runs:
        rows.insert(-1 if ordinary.runs else len(rows),
                    ["all hostile", *hostile.cells(asked.errors)])
    text = (f"{table(head, rows)}\n\n{cpu_name()}, one thread, {asked.size} x {asked.size}, "
            f"commit {commit()}. `./run perf error_suite`; [all runs](error-suite.csv).")
    print("\n" + text)
    tell_worst([*hostile.runs, *ordinary.runs], shop.folder)
    if asked.keep:
        for r in runs:
            r["command"] = r["command"].replace(f"{shop.folder}/", "").replace(
                f"{ROOT.parent}/", "../")
        write_csv(runs, DOCS / "error-suite.csv")
        record("error-suite")
        draw_error_charts(hostile.runs + ordinary.runs, DOCS / "images/error-suite.svg")
        put_section(DOCS / "sampling.md", "perf/error_suite.py", text)
    sys.exit(not verdict(hostile, ordinary))


if __name__ == "__main__":
    main()
