#!/usr/bin/env python3
"""What calls from Python cost, beside the same calls in C++.

    ./run perf python_time [--rays N] [--rounds N] [--keep]

Camera rays at meshes, and rays in random order; nearest hits with t, id, u and v. The languages
take turns, in processes of their own. --keep writes docs/python-time.csv, of which perf/figures.py
makes the figures of docs/python.md.
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
try:
    import numpy as np
    import grelha
    from bench import DOCS, ROOT, cores, record
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

MESHES = (ROOT / "scenes/data/torus.ply", ROOT.parent / "shared/scenes/ply/bunny.ply",
          ROOT.parent / "shared/scenes/ply/armadillo.ply")
CALLS = 2000
HEADER = ["rays", "threads", "python_ms", "cpp_ms", "ratio", "one_python_us", "one_cpp_us"]
TURN = 3  # calls at a time: the first of a process finds no memory ready


def camera_rays(vertices, count):
    """From the side, at the middle, in the order of a picture."""
    low, high = vertices.min(0), vertices.max(0)
    size, side = (high - low).max(), int(count**.5)
    eye = (low + high) / 2 + np.array([.4, .3, 2], np.float32) * size
    x, y = np.meshgrid(np.linspace(-.6, .6, side), np.linspace(.6, -.6, side))
    at = (low + high) / 2 + np.stack([x, y, 0 * x], -1).reshape(-1, 3) * size
    return np.broadcast_to(eye, at.shape).astype(np.float32), (at - eye).astype(np.float32)


def least(rounds, call):
    best = np.inf
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return best


def by_python(world, origins, directions, threads):
    many = least(TURN, lambda: world.closest(origins, directions, threads=threads))
    step = len(origins) // CALLS
    pairs = list(zip(origins[::step], directions[::step]))

    def calls():
        for origin, direction in pairs:
            world.closest(origin, direction)
    return many, least(TURN, calls) / len(pairs)


def row(name, world, rays, asked, folder, threads):
    """Times of both languages: many rays, and one."""
    for part, values in zip(("origins", "directions"), rays):
        values.tofile(folder / part)
    best = np.full((2, 2), np.inf)
    for _ in range(asked.rounds):
        best[0] = np.minimum(best[0], by_python(world, *rays, threads))
        done = subprocess.run([asked.program, folder, str(TURN), str(threads)], check=True,
                              stdout=subprocess.PIPE, text=True)
        best[1] = np.minimum(best[1], [float(word) for word in done.stdout.split()[:2]])
    (many, one), (many_cpp, one_cpp) = best
    return [name, threads, f"{1e3 * many:.1f}", f"{1e3 * many_cpp:.1f}", f"{many / many_cpp:.2f}",
            f"{1e6 * one:.1f}", f"{1e6 * one_cpp:.2f}"]


def rows(asked):
    random = np.random.default_rng(1)
    for path in MESHES:
        if not path.exists():
            print(f"skipped: there is no {path}", file=sys.stderr)
            continue
        mesh = grelha.read(path)
        vertices = mesh.vertices.astype(np.float32)
        world = grelha.World(vertices, mesh.faces)
        rays = camera_rays(vertices, asked.rays)
        order = random.permutation(len(rays[0]))
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            vertices.tofile(folder / "vertices")
            mesh.faces.astype(np.uint32).tofile(folder / "faces")
            for kind, these in (("camera", rays), ("shuffled", [a[order] for a in rays])):
                for threads in sorted({1, cores()}):
                    yield row(f"{path.stem}, {kind}", world, these, asked, folder, threads)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", help="same_call [build/python/same_call]",
                        default=ROOT / "build/python/same_call")
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=9, help="the least time counts [9]")
    parser.add_argument("--keep", action="store_true", help="write into docs/")
    asked = parser.parse_args()
    path = (DOCS if asked.keep else ROOT / "build") / "python-time.csv"
    with open(path, "w", newline="") as f:
        lines = csv.writer(f, lineterminator="\n")
        lines.writerow(HEADER)
        for line in rows(asked):
            print(*line, flush=True)
            lines.writerow(line)
    if asked.keep:
        record("python-time")
    print(path)


if __name__ == "__main__":
    main()
