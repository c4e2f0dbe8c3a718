#!/usr/bin/env python3
"""Ranks share a render by MPI: what of their time is of use, and how fast pieces are handed out.

    ./run perf ranks [--rounds N]

Ranks of one thread each on this machine, in shared memory and over TCP, against one process of one
thread; then pictures one pixel wide, all handing out. Takes the program of the preset mpi.
"""
import json
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import Bench, arguments, cores, cpu_name, table

WAYS = {
    "shared memory": [],
    "TCP": ["--mca", "btl", "tcp,self", "--mca", "osc", "pt2pt", "--mca", "pml", "ob1"]}
PIECE_ROWS, PIECE_SAMPLES = 8, 64
THIN = 65536  # rows of the picture that is nothing but handing out


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


def main():
    bench = Bench("ranks", arguments(__doc__, rounds=5).parse_args())
    shares, rates = efficiency(bench), handing_out(bench)
    scenes = list(dict.fromkeys(name for name, *_ in shares))
    rows = [[f"{n} {way}" if way.startswith("threads") else f"{n} rank{'s' * (n > 1)}, {way}",
             *[f"{shares[s, n, way]:.2f}" for s in scenes]]
            for n, way in dict.fromkeys((n, way) for _, n, way in shares)]
    print(f"""\
Efficiency, t(one thread) / (n t(n)), {bench.rounds} rounds taking turns, medians; {cores()}
processors, {cpu_name()}:

{table(["", *scenes], rows)}

Pieces of eight rays handed out a second, nothing else to do (a picture of 1 x {THIN}):

{table(["ranks", *WAYS], [[n, *[f"{rates[w, n]:,.0f}" for w in WAYS]] for n in (2, 3, 4)])}
""")


if __name__ == "__main__":
    main()
