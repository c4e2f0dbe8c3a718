#!/usr/bin/env python3
"""Whole pictures, from scene file to picture file: where the time goes, and POV-Ray's beside ours.

    ./run perf frame [--rounds N] [--only profile|povray] [--keep] [--draw]

Times are CPU seconds where one thread renders and seconds by the clock where all do; the least of
several runs taking turns, fewer of long ones. POV-Ray draws the same scenes, converted by
lib/nff_to_pov.py; how alike its pictures are is measured. frame.cpp measures what a picture's rays
cost alone.
"""
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import time
from datetime import date

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DOCS, ROOT, Bench, arguments, cores, cpu_name, plt, read_csv, table, times
from nff_to_pov import convert

SIDE, DEPTH = 512, 5
LONG = 8  # seconds of rendering a thing is given; at least one run, at most as many as rounds
SCENES = [("balls 4", ("balls", 4), 1, (12, 2.4)), ("mount 8", ("mount", 8), 20, (12, 2)),
          ("Distant", ("distant", 3), 1, (20, 2.4))]
SPREAD = ("least", "median", "most")  # of all runs, from file to file
PHASES = ("camera", "primary", "bounce", "surface", "light", "shadow", "children", "sums")
PLAIN = ["--samples", "1", "--lens", "0"]


def cases(side, lens):
    """title, ours, POV-Ray's options, what its scene needs"""
    aperture, focus = lens
    return [("plain", PLAIN, [], {}),
            ("anti-aliased, method 1", ["--lens", "0", "--aa", "adaptive:0.2,2"],
             ["+A0.3", "+R3", "+AM1"], {}),
            ("anti-aliased, method 2", ["--lens", "0", "--aa", "adaptive:0.3,3"],
             ["+A0.3", "+R3", "+AM2"], {}),
            ("area light 4 x 4", [*PLAIN, "--shadows", f"area:{side},4"], [], {"area": (side, 4)}),
            ("lens, 32 samples", ["--samples", "32", "--lens", f"{aperture},{focus},32"], [],
             {"lens": (aperture, focus, 32)})]


class Povray:
    def __init__(self, folder):
        self.folder, self.program = folder, shutil.which("povray")

    def render(self, text, options, threads):
        (self.folder / "scene.pov").write_text(text)
        start = time.monotonic()
        done = subprocess.run(
            [self.program, "+Iscene.pov", "+Opov.png", f"+W{SIDE}", f"+H{SIDE}", f"+WT{threads}",
             "-D", "-V", "+FN8", "+BM2", "File_Gamma=1.0", *options],
            cwd=self.folder, env={**os.environ, "HOME": str(self.folder)}, stderr=subprocess.PIPE,
            text=True)
        whole, told = time.monotonic() - start, done.stderr
        trace = re.search(
            r"Trace Time:.*\(([\d.]+) seconds\)\s+using \d+ thread\(s\) with ([\d.]+) CPU-seconds",
            told)
        if done.returncode or not trace:
            sys.exit(told)
        parse = re.search(r"Parse Time:.*\(([\d.]+) seconds\)", told)
        shadows = re.search(r"Shadow Ray Tests: +(\d+)", told) or [0, 0]
        rays = int(re.search(r"Rays: +(\d+)", told)[1]) + int(shadows[1])
        samples = re.search(r"Smpls/Pxl: ([\d.]+)", told)
        return {
            "clock": float(trace[1]), "cpu": float(trace[2]), "whole": whole,
            "parse": float(parse[1]), "rays": rays, "samples": float(samples[1])}


def least(old, new):
    return {k: min(old[k], v) if old else v for k, v in new.items()}


def grelha(bench, scene, options, threads):
    start = time.monotonic()
    stats = bench.render(scene, "--size", f"{SIDE}x{SIDE}", "--depth", DEPTH, "--threads", threads,
                         *options, picture=bench.folder / "ours.png")
    whole, s = time.monotonic() - start, stats["seconds"]
    return {
        "clock": s["render"], "cpu": s["render_cpu"], "whole": whole, "load": s["load"],
        "build": s["build"], "write": s["write"], "rays": sum(stats["rays"].values()),
        "samples": stats["rays"]["primary"] / SIDE**2, **stats["phases"]}


def alike(bench, other="pov.png"):
    ours, theirs = (plt.imread(bench.folder / f)[..., :3].astype(float)
                    for f in ("ours.png", other))
    return float(np.sqrt(np.mean((ours - theirs) ** 2)))


def compare(bench, povray, name, title, scene, ours, options, extra):
    """Both programs taking turns, one thread and all of them."""
    text = convert(scene.read_text(), DEPTH, **extra)
    spent, rounds, got = 0, 0, {}
    while rounds < bench.rounds and (rounds == 0 or spent * (rounds + 1) / rounds < LONG):
        for threads in (1, cores()):
            for who, run in (("ours", lambda: grelha(bench, scene, ours, threads)),
                             ("pov", lambda: povray.render(text, options, threads))):
                got[who, threads] = least(got.get((who, threads)), run())
                spent += got[who, threads]["clock"]
        rounds += 1
    got["rmse"], got["rounds"] = alike(bench), rounds
    shutil.copy(bench.folder / "ours.png", bench.folder / f"{name}, {title}, ours.png")
    shutil.copy(bench.folder / "pov.png", bench.folder / f"{name}, {title}, pov.png")
    return got


def file_to_file(run):
    return run["load"] + run["build"] + run["clock"] + run["write"]


def profile(bench, scenes):
    """Measures the time of plain pictures by phase: of the fastest of several whole runs on one
    thread, with the spread of the others."""
    runs = {name: [] for name, *_ in scenes}
    for _ in range(4 * bench.rounds):
        for name, scene, *_ in scenes:
            run = grelha(bench, scene, PLAIN, 1)
            run["other"] = run["clock"] - sum(run[p] for p in PHASES)
            runs[name].append(run)
    got = {name: min(of, key=file_to_file)
           for name, of in runs.items()}  # all phases of one and the same run
    for name, run in got.items():
        run["least"], run["median"], run["most"] = (at([file_to_file(r)
                                                        for r in runs[name]])
                                                    for at in (min, statistics.median, max))
    return got


def main():
    parser = arguments(__doc__, rounds=5)
    parser.add_argument("--only", choices=("profile", "povray"),
                        help="this part alone")
    asked = parser.parse_args()
    bench = Bench("frame", asked)
    if asked.draw:
        draw(bench, from_csv(read_csv("frame-profile")))
        return
    scenes = [(name, bench.scene(*generator), side, lens) for name, generator, side, lens in SCENES]
    if asked.only in (None, "profile"):
        make_profile(bench, scenes)
    povray = Povray(bench.folder)
    if asked.only == "profile" or not povray.program:
        print("no comparison: POV-Ray "
              + ("was not asked" if povray.program else "is not installed"))
        return
    results = []
    for name, scene, side, lens in scenes:
        for title, ours, options, extra in cases(side, lens):
            got = compare(bench, povray, name, title, scene, ours, options, extra)
            results.append((name, title, got))
            o, p = got["ours", 1], got["pov", 1]
            print(
                f"{name}, {title}: ours {o['cpu']:.3f} s, POV-Ray {p['cpu']:.3f} s, RMSE "
                f"{got['rmse']:.3f}, {got['rounds']} rounds",
                flush=True)
    bench.section(tell_povray(bench, results), "povray")


def make_profile(bench, scenes):
    profiled = [*scenes[:1], ("mount 7", bench.scene("mount", 7)), *scenes[1:]]
    phases = profile(bench, profiled)
    alone = {}
    for name, scene, *_ in profiled:
        alone[name] = bench.tool(scene, 8 * bench.rounds)
    draw(bench, phases)
    columns = ("load", "build", *PHASES, "other", "write", "clock", *SPREAD, "whole", "rays")
    bench.write_csv(
        "frame-profile",
        ["scene", *columns, "trace_alone_cpu", "render_cpu", "render", "render_two_threads"],
        [[name, *[f"{p[c]:.5g}" if c != "rays" else p[c] for c in columns], alone[name]["trace"],
          alone[name]["render cpu"], alone[name]["render"], alone[name]["render two threads"]]
         for name, p in phases.items()])
    bench.section(tell_profile(phases, alone), "profile")


def tell_profile(phases, alone):
    rows = [["render, ms", *(f"{p['clock'] * 1e3:.1f}" for p in phases.values())],
            ["the whole program, ms", *(f"{p['whole'] * 1e3:.1f}" for p in phases.values())],
            ["load and write / render", *(f"{(p['load'] + p['write']) / p['clock']:.2f}"
                                          for p in phases.values())],
            ["render / its rays alone", *(f"{alone[n]['render cpu'] / alone[n]['trace']:.2f}"
                                          for n in phases)],
            ["one thread / two", *(f"{alone[n]['render'] / alone[n]['render two threads']:.2f}"
                                   for n in phases)]]
    return f"""![where the time of a picture goes](images/frame.svg)

Plain pictures of {SIDE} x {SIDE}, paths of at most {DEPTH} rays, one thread
([numbers](frame-profile.csv)). `Its rays alone` were recorded from the render and traced again.

{table(["", *phases], rows)}
"""


def tell_povray(bench, results):
    rows, csv_rows = {}, []
    all_threads = cores()
    for name, title, got in results:
        o1, p1 = got["ours", 1], got["pov", 1]
        rows.setdefault(title, [title]).append(times(p1["cpu"] / o1["cpu"]))
        # POV-Ray counts what it adds to the first ray, and nothing where it adds by other means
        theirs = 32 if title.startswith("lens") else 1 + p1["samples"]
        asked = {(w, n) for w in ("ours", "pov") for n in (1, all_threads)}
        for who, threads in got.keys() & asked:
            r = got[who, threads]
            csv_rows.append([
                name, title, "Grelha" if who == "ours" else "POV-Ray", threads, r["clock"],
                r["cpu"], f"{r['whole']:.4g}", r["rays"],
                f"{o1['samples'] if who == 'ours' else theirs:.3g}", f"{got['rmse']:.4f}",
                got["rounds"]])
    bench.write_csv(
        "frame-povray",
        ["scene", "case", "program", "threads", "render_seconds", "render_cpu_seconds",
         "whole_seconds", "rays", "samples_per_pixel", "rmse", "rounds"],
        sorted(csv_rows, key=lambda r: ([n for n, *_ in SCENES].index(r[0]), r[1:4])))
    return povray_section(list(dict.fromkeys(name for name, *_ in results)), rows.values())


def povray_section(names, rows):
    return f"""POV-Ray's CPU seconds of rendering over Grelha's, one thread
([numbers](frame-povray.csv)):

{table(["", *names], rows)}

POV-Ray is Debian's, with its BSP tree (`+BM2`). Anti-aliased: `+A0.3 +R3` by methods 1 and 2 beside
`--aa adaptive:0.2,2` and `0.3,3`, which spend about as many samples.
"""


def from_csv(rows):
    return {
        r["scene"]: {key: float(value)
                     for key, value in r.items()
                     if key != "scene"}
        for r in rows
    }


def draw(bench, phases):
    figure, axis = plt.subplots(figsize=(9, 3.6), layout="constrained")
    keys = [("load", "load"), ("build", "build"), ("camera", "camera rays"),
            ("primary", "trace camera rays"), ("bounce", "trace bounces"),
            ("shadow", "trace shadow rays"), ("surface", "surfaces"), ("light", "local light"),
            ("children", "make bounces"), ("sums", "sums to pixels"), ("other", "memory, threads"),
            ("write", "write PNG")]
    shades = [
        "#999999", "#555555", "#F0E442", "#0072B2", "#2E9BD6", "#8CCBEE", "#D55E00", "#E69F00",
        "#F5C77E", "#B2DF8A", "#DDDDDD", "#CC79A7"
    ]
    names = list(phases)[::-1]
    left = [0.] * len(names)
    for (key, label), shade in zip(keys, shades):
        wide = [phases[n][key] * 1e3 for n in names]
        axis.barh(names, wide, left=left, color=shade, label=label, height=.65)
        left = [a + b for a, b in zip(left, wide)]
    if all(key in phases[n] for n in names for key in SPREAD):  # CSVs of before have none
        least, median, most = ([phases[n][key] * 1e3 for n in names] for key in SPREAD)
        axis.errorbar(left,
                      names,
                      xerr=[[0] * len(names), [m - a for m, a in zip(most, least)]],
                      fmt="none",
                      ecolor="black",
                      capsize=4,
                      label="from the fastest run\nto the slowest")
        axis.plot(median, names, "|", color="black", markersize=9, label="the median run")
    axis.set(xlabel=f"milliseconds, a picture of {SIDE} x {SIDE}, one thread", ylabel="scene",
             title="Where the time of a picture goes, from file to file")
    axis.legend(frameon=False, fontsize=8, ncols=1, bbox_to_anchor=(1.01, 1), loc="upper left")
    bench.save(figure, "frame")


if __name__ == "__main__":
    main()
