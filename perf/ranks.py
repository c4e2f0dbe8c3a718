#!/usr/bin/env python3
"""Ranks share a render by MPI: what of their time is of use, and how fast pieces are handed out.

    ./run perf ranks [--rounds N] [--keep] [--draw]

Ranks of one thread each on this machine, in shared memory and over TCP, against one process of one
thread; then pictures one pixel wide, all handing out; then a model of many threads, with what was
measured of a piece. Takes the program of the preset mpi.
"""
import heapq
import os
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import (COLOURS, DOCS, Bench, arguments, cores, cpu_name, plt, put_section, read_csv,
                   table)
from chart import set_axis

import json
import subprocess

WAYS = {
    "shared memory": [],
    "TCP": ["--mca", "btl", "tcp,self", "--mca", "osc", "pt2pt", "--mca", "pml", "ob1"]}
PIECE_ROWS, PIECE_SAMPLES = 8, 64
THIN = 65536  # rows of the picture that is nothing but handing out
# of the model: a thread traces so many, a link of 10 Gbit/s
WIDTH, HEIGHT, RAYS_A_SECOND, BYTES_A_SECOND = 1920, 1080, 1e6, 1.25e9
THREADS = [2 ** k for k in range(16)]
SAMPLES = (64, 1024, 4096, 65536)


def render(bench, ranks, way, scene, *options):
    """Seconds the first rank took to render; ranks = 0: one process, no MPI."""
    stats = bench.folder / "stats.json"
    job = [bench.program, "render", scene, "-o", bench.folder / "picture.png", "--quiet",
           "--stats", stats, *map(str, options)]
    if ranks:
        job = ["mpirun", "--oversubscribe", "--bind-to", "none", *WAYS[way], "-n", str(ranks), *job]
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    subprocess.run(job, check=True, env=environment)
    return json.loads(stats.read_text())["seconds"]["render"]


def efficiency(bench):
    """Of each scene and way: the median over rounds of t(one process) / (n t(n ranks)); ways take
    turns."""
    scenes = {
        "balls 4, lens": (bench.scene("balls", 4), "--lens", "12"),
        "mount 7": (bench.scene("mount", 7),)}
    found = {}
    for name, (scene, *options) in scenes.items():
        work = (scene, "--threads", 1, "--size", "320x240", "--samples", 128, *options)
        counts = sorted({1, cores()})
        shares = {}
        for _ in range(bench.rounds):
            alone = render(bench, 0, None, *work)
            threads = render(bench, 0, None, scene, "--threads", cores(), *work[3:])
            key = cores(), "threads of one process"
            shares.setdefault(key, []).append(alone / (cores() * threads))
            for way in WAYS:
                for n in counts:
                    share = alone / (n * render(bench, n, way, *work))
                    shares.setdefault((n, way), []).append(share)
        for key, all_shares in shares.items():
            found[name, *key] = sorted(all_shares)[len(all_shares) // 2]
            print(name, *key, f"{found[name, *key]:.3f}", flush=True)
    return found


def handing_out(bench):
    """Pieces a second, the best round, of 8 rays each."""
    found = {}
    scene = bench.scene("balls", 1)
    for _ in range(bench.rounds):
        for way in WAYS:
            for n in (2, 3, 4):
                seconds = render(bench, n, way, scene, "--threads", 1, "--size", f"1x{THIN}")
                rate = THIN / PIECE_ROWS / seconds
                found[way, n] = max(found.get((way, n), 0), rate)
    for key, rate in found.items():
        print(*key, f"{rate:.0f} pieces/s", flush=True)
    return found


def simulate(threads, samples, rate):
    """Seconds a picture takes threads that ask one counter (`rate` numbers a second) and send sums
    through one link; pieces differ in cost by half to one and a half, as rows do."""
    rng = random.Random(threads)
    pieces = -(-HEIGHT // PIECE_ROWS) * -(-samples // PIECE_SAMPLES)
    piece = WIDTH * PIECE_ROWS * min(samples, PIECE_SAMPLES) / RAYS_A_SECOND
    message = WIDTH * PIECE_ROWS * 24 / BYTES_A_SECOND
    free = [0.] * min(threads, pieces)  # when each thread asks next; a heap
    counter = link = 0.
    for _ in range(pieces):
        counter = max(counter, heapq.heappop(free)) + 1 / rate
        end = counter + piece * rng.uniform(.5, 1.5)
        link = max(link, end) + message
        heapq.heappush(free, end)
    return max(link, *free)


def model(rate):
    """{samples: [rows of all samples a second by threads]}"""
    return {s: [HEIGHT / simulate(t, s, rate) for t in THREADS] for s in SAMPLES}


def from_csv(pieces, rows):
    """Rates and model, as they were kept in docs/."""
    modelled = {}
    for row in rows:
        modelled.setdefault(int(row["samples"]), []).append(float(row["rows_a_second"]))
    return {(p["way"], int(p["ranks"])): float(p["pieces_a_second"]) for p in pieces}, modelled


def draw(bench, rates, modelled):
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for (samples, rows), colour, marker in zip(modelled.items(), COLOURS, "osD^"):
        look = {"color": colour, "marker": marker, "markersize": 4,
                "label": f"{samples} samples a pixel"}
        panels[0].plot(THREADS, [r * samples / PIECE_SAMPLES for r in rows], **look)
        panels[1].plot(THREADS, [r / rows[0] / t for r, t in zip(rows, THREADS)], **look)
    ideal = [modelled[SAMPLES[0]][0] * t for t in THREADS]
    panels[0].plot(THREADS, ideal, "--", color="#555555", linewidth=1,
                   label="as many times as threads")
    panels[0].axhline(BYTES_A_SECOND / (WIDTH * 24), color="#999999", linewidth=1, linestyle=":")
    panels[0].text(1, 1.1 * BYTES_A_SECOND / (WIDTH * 24), "a link of 10 Gbit/s is full",
                   fontsize=8, color="#555555")
    panels[0].axhline(PIECE_ROWS * rates["TCP", 4], color="#999999", linewidth=1, linestyle=":")
    panels[0].text(1, 1.1 * PIECE_ROWS * rates["TCP", 4],
                   "as fast as pieces were handed out over TCP", fontsize=8, color="#555555")
    panels[0].set(title=f"model of a picture of {WIDTH} x {HEIGHT}", xscale="log", yscale="log",
                  xlabel="threads of all ranks",
                  ylabel=f"rows of {PIECE_SAMPLES} samples a pixel, a second")
    panels[1].set(title="what of the threads' time is of use", xscale="log", ylim=(0, 1.05),
                  xlabel="threads of all ranks",
                  ylabel="efficiency: times as fast as one thread / threads")
    for panel in panels:
        panel.grid(alpha=.4)
        set_axis(panel.xaxis, THREADS[0], THREADS[-1], {"log": True})
    set_axis(panels[0].yaxis, 1, 1e6, {"log": True})
    panels[0].legend(frameon=False, fontsize=8, loc="lower right")
    bench.save(figure, "ranks")


def main():
    asked = arguments(__doc__, rounds=5).parse_args()
    bench = Bench("ranks", asked)
    if asked.draw:
        draw(bench, *from_csv(read_csv("ranks-pieces"), read_csv("ranks")))
        return
    shares, rates = efficiency(bench), handing_out(bench)
    modelled = model(rates["TCP", 4])
    draw(bench, rates, modelled)
    scenes = list(dict.fromkeys(name for name, *_ in shares))
    rows = [[f"{n} {way}" if way.startswith("threads") else f"{n} rank{'s' * (n > 1)}, {way}",
             *[f"{shares[s, n, way]:.2f}" for s in scenes]]
            for n, way in dict.fromkeys((n, way) for _, n, way in shares)]
    half = {s: next((t for t, r in zip(THREADS, rows_) if r / rows_[0] / t < .8), None)
            for s, rows_ in modelled.items()}
    falls = ", ".join(f"{t:,} threads with {s} samples" if t else
                      f"more than {THREADS[-1]:,} threads with {s}" for s, t in half.items())
    text = f"""\
Efficiency, t(one thread) / (n t(n)), 320 x 240, 128 samples a pixel, {bench.rounds} rounds taking
turns, medians; {cores()} processors, a virtual {cpu_name()}:

{table(["", *scenes], rows)}

Pieces of eight rays handed out a second, nothing else to do (a picture of 1 x {THIN}), the best of
{bench.rounds}:

{table(["ranks", *WAYS], [[n, *[f"{rates[w, n]:,.0f}" for w in WAYS]] for n in (2, 3, 4)])}

![rows a second and efficiency against threads](images/ranks.svg)

The model takes the slowest rate of these for the counter, {RAYS_A_SECOND:,.0f} camera rays a second
and thread, and one link of 10 Gbit/s into the first rank. Efficiency falls below .8 at {falls}.
"""
    print(text)
    bench.write_csv("ranks", ["samples", "threads", "rows_a_second"],
                    [[s, t, f"{r:.5g}"]
                     for s, rows_ in modelled.items() for t, r in zip(THREADS, rows_)])
    bench.write_csv("ranks-pieces", ["way", "ranks", "pieces_a_second"],
                    [[w, n, f"{rate:.0f}"] for (w, n), rate in rates.items()])
    if bench.docs == DOCS:
        put_section(DOCS / "farm.md", "perf/ranks.py", text)


if __name__ == "__main__":
    main()
