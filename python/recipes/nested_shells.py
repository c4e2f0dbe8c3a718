#!/usr/bin/env python3
"""Particles that leave nested closed shells, and how many get lost: `nested_shells.py`.

Particles fly from inside the innermost of eight shells outwards, from wall to wall: a million in
any direction, one at each vertex and at edges. The picture is a slice of where they crossed walls.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray

import grelha

Array = NDArray[Any]

SHELLS, PARTICLES, SIDE = 8, 1_000_000, 600


def shell(radius: float, seed: int, rings: int = 40) -> tuple[Array, Array]:
    """A closed ball with waves, seen whole from the origin."""
    around = 2 * rings
    down, along = np.meshgrid(np.linspace(0, np.pi, rings + 1)[1:-1],
                              np.arange(around) * 2 * np.pi / around, indexing="ij")
    p = np.stack([np.sin(down) * np.cos(along), np.sin(down) * np.sin(along), np.cos(down)], -1)
    p = np.concatenate([p.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    waves = np.sin(p @ np.random.default_rng(seed).normal(size=(3, 4)) * 4).mean(1)
    i, j = np.meshgrid(np.arange(rings - 2), np.arange(around), indexing="ij")
    a, b, k = i * around + j, i * around + (j + 1) % around, np.arange(around)
    last, top = (rings - 2) * around, len(p) - 2
    faces = [np.stack(s, -1).reshape(-1, 3) for s in (
        (a, a + around, b), (b, a + around, b + around), (0 * k + top, k, (k + 1) % around),
        (0 * k + top + 1, last + (k + 1) % around, last + k))]
    return p * (radius * (1 + 0.04 * waves))[:, None], np.concatenate(faces)


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("-o", "--output", default="nested_shells.png")
meshes = [shell(1 + 0.25 * k, k) for k in range(SHELLS)]
vertices = np.concatenate([v for v, _ in meshes]).astype(np.float32)
faces = np.concatenate([f + k * len(meshes[0][0]) for k, (_, f) in enumerate(meshes)])
shell_of = np.repeat(np.arange(SHELLS), len(meshes[0][1]))
world = grelha.World(vertices, faces)

rng, edges = np.random.default_rng(9), vertices[faces[:, :2]].mean(1)
aims = [rng.normal(size=(PARTICLES, 3)), vertices, edges]
start = np.array([0.01, 0.02, 0.03], np.float32)
directions = np.concatenate(aims).astype(np.float32)
directions[PARTICLES:] -= start
t, crossed = np.zeros(len(directions), np.float32), np.zeros((SHELLS, len(directions)), bool)
picture = np.zeros((SIDE, SIDE, 3))
for k in range(SHELLS):  # on from the float after t: t is rounded, and a wall counts once
    hits = world.closest(start, directions, t_min=np.nextafter(t, np.float32(np.inf)))
    crossed[k], t = (hits.face >= 0) & (shell_of[hits.face] == k), hits.t
    x, y, z = (start + t[:, None] * directions).T
    thin = np.stack([x, y])[:, np.abs(z) < 0.06]
    x, y = thin + rng.normal(scale=0.015, size=thin.shape)  # lines of some pixels
    colour = 0.6 + 0.4 * np.cos(2 * np.pi * (k / SHELLS + np.arange(3) / 3))
    picture += np.histogram2d(y, x, SIDE, [[-3.1, 3.1]] * 2)[0][..., None] * colour
stray = world.occluded(start, directions, np.nextafter(t, np.float32(np.inf))).sum()
grelha.write_image(parser.parse_args().output, 1 - np.exp(-0.35 * picture))
print(f"{len(directions)} particles through {SHELLS} shells of {len(faces)} triangles: "
      f"{(~crossed.all(axis=0)).sum()} lost, {stray} crossings too many")
