#!/usr/bin/env python3
"""Rays that slip through closed meshes, of Grelha and of Embree, both called from Python.

    ./run perf lost [--rays N] [--keep]

Meshes are scaled to a box of 1, on multiples of 2^-16: closed stays closed, and rays go exactly
through vertices and middles of edges. --keep writes docs/lost.csv, of which perf/figures.py makes
the table of docs/accuracy.md.
"""
import argparse
import csv
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
try:
    import numpy as np
    import grelha
    from bench import DOCS, ROOT, record
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)
import embree_c

SCANS = ("screwdriver", "armadillo", "horse", "dragon", "turbineblade")
STEP, BATCH, POINTS, AWAY = 2.0**-16, 250_000, 40, 8
AIMS = ("vertices", "edges", "random")
HEADER = ["mesh", "triangles", "tracer", "aim", "rays", "lost", "us_a_ray"]


def ball(rings, around):
    """Rings of a ball, and a fan of `around` triangles at each pole."""
    down, along = np.meshgrid(np.linspace(0, np.pi, rings + 1)[1:-1],
                              np.arange(around) * 2 * np.pi / around, indexing="ij")
    p = np.stack([np.sin(down) * np.cos(along), np.sin(down) * np.sin(along), np.cos(down)], -1)
    k, last = np.arange(around), (rings - 2) * around
    i = (np.arange(rings - 2)[:, None] * around + k).ravel()
    j = (np.arange(rings - 2)[:, None] * around + (k + 1) % around).ravel()
    top = last + around
    faces = [np.c_[i, i + around, j], np.c_[j, i + around, j + around],
             np.c_[0 * k + top, k, (k + 1) % around],
             np.c_[0 * k + top + 1, last + (k + 1) % around, last + k]]
    return np.concatenate([p.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]]), np.concatenate(faces)


def meshes():
    """Name, vertices and faces of each."""
    p, f = ball(60, 120)
    yield "ball", p, f
    yield "waves", p * (1 + .3 * np.prod(np.sin(7 * p + (0, 1, 2)), 1))[:, None], f
    yield "needle", p * (.01, .01, 1), f
    yield "drum", *ball(3, 2000)
    paths = {"torus": ROOT / "scenes/data/torus.ply"}
    paths.update((name, ROOT.parent / f"shared/scenes/ply/{name}.ply") for name in SCANS)
    for name, path in paths.items():
        if path.exists():
            mesh = grelha.read(path)
            yield name, mesh.vertices, mesh.faces
        else:
            print(f"{name}: skipped, there is no {path}", file=sys.stderr)


def on_steps(points):
    return (np.round(points / STEP) * STEP).astype(np.float32)


def scaled(vertices, faces):
    """In a box of 1 about the origin, on steps, each place one vertex."""
    low, high = vertices.min(0), vertices.max(0)
    vertices, index = np.unique(on_steps((vertices - (low + high) / 2.) / (high - low).max()),
                                axis=0, return_inverse=True)
    faces = index.ravel()[faces]
    return vertices, faces[(faces != np.roll(faces, 1, axis=1)).all(1)]


def is_closed(faces):
    """Each edge is walked as often one way as the other."""
    a, b = faces.astype(np.int64).ravel(), np.roll(faces, -1, axis=1).astype(np.int64).ravel()
    return np.array_equal(np.sort(a << 32 | b), np.sort(b << 32 | a))


def winding(vertices, faces, point):
    """How often the mesh winds about the point (van Oosterom and Strackee 1983)."""
    a, b, c = (vertices.astype(float)[faces] - point).swapaxes(0, 1)
    x, y, z = (np.linalg.norm(p, axis=1) for p in (a, b, c))
    dots = [(p * q).sum(1) for p, q in ((a, b), (b, c), (c, a))]
    return np.arctan2((a * np.cross(b, c)).sum(1),
                      x * y * z + dots[0] * z + dots[1] * x + dots[2] * y).sum() / (2 * np.pi)


def points_inside(world, vertices, faces, random):
    """On steps, the deepest of many, and inside by their winding numbers."""
    low, high = vertices.min(0), vertices.max(0)
    points = on_steps(random.uniform(low, high, (10_000, 3)))
    depth = -world.signed_distance(points)
    points = points[np.argsort(-depth)[:200]][random.permutation(200)][:POINTS]
    turns = [winding(vertices, faces, p) for p in points]
    return points[np.abs(turns) > .99]


def aims_at(aim, vertices, faces, random, count):
    if aim == "vertices":
        return vertices[random.integers(len(vertices), size=count)]
    if aim == "edges":
        ends = vertices[faces[random.integers(len(faces), size=count)][:, :2]]
        return (ends[:, 0] + ends[:, 1]) / 2
    return on_steps(random.normal(size=(count, 3)))


def rays(aim, inside, vertices, faces, random, count):
    """Half from points inside without an end; half from outside the box to points inside, where t
    is 1. All sums are exact."""
    points = inside[random.integers(len(inside), size=count)]
    aims = aims_at(aim, vertices, faces, random, count)
    out = AWAY * (aims - points)
    far = points + out
    outside = (np.arange(count) % 2 == 0) & (np.abs(far) > .75).any(1)
    origins = np.where(outside[:, None], far, points)
    directions = np.where(outside[:, None], -out, aims - points)
    assert (far.astype(float) - points == out).all() and (directions != 0).any(1).all()
    return origins, directions, np.where(outside, 1, np.inf).astype(np.float32)


def tracers(vertices, faces, library):
    world = grelha.World(vertices, faces)
    yield "Grelha", lambda o, d, t: world.closest(o, d, t_max=t, threads=1).id >= 0
    if library:
        for name, robust in (("Embree robust", True), ("Embree fast", False)):
            yield name, embree_c.Scene(library, vertices, faces, robust).met


def lost_of(vertices, faces, count, library):
    """Lost rays by (tracer, aim), and seconds that all took."""
    random = np.random.default_rng(1)
    inside = points_inside(grelha.World(vertices, faces), vertices, faces, random)
    asked, lost, spent = dict(tracers(vertices, faces, library)), {}, {}
    for aim in AIMS:
        for first in range(0, count, BATCH):
            batch = rays(aim, inside, vertices, faces, random, min(BATCH, count - first))
            for name, met in asked.items():
                start = time.perf_counter()
                found = met(*batch)
                spent[name, aim] = spent.get((name, aim), 0) + time.perf_counter() - start
                lost[name, aim] = lost.get((name, aim), 0) + int((~found).sum())
    return lost, spent


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", help=argparse.SUPPRESS)
    parser.add_argument("--rays", type=int, default=1_000_000, help="of each aim [1000000]")
    parser.add_argument("--keep", action="store_true", help="write into docs/")
    options = parser.parse_args()
    library, rows, start = embree_c.load(), [], time.time()
    for name, *mesh in meshes():
        vertices, faces = scaled(*mesh)
        if not is_closed(faces):
            sys.exit(f"{name} is not closed")
        lost, spent = lost_of(vertices, faces, options.rays, library)
        rows += [[name, len(faces), who, aim, options.rays, count,
                  f"{1e6 * spent[who, aim] / options.rays:.2f}"]
                 for (who, aim), count in lost.items()]
        print(*rows[-len(lost):], sep="\n", flush=True)
    path = (DOCS if options.keep else ROOT / "build") / "lost.csv"
    with open(path, "w", newline="") as f:
        csv.writer(f, lineterminator="\n").writerows([HEADER, *rows])
    if options.keep:
        record("lost")
    print(path, f"{time.time() - start:.0f} s", sep="\n")
    sys.exit(any(lost for _, _, who, _, _, lost, _ in rows if who == "Grelha"))


if __name__ == "__main__":
    main()
