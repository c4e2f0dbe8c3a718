#!/usr/bin/env python3
"""Pictures of a mesh from all sides, on one sheet: `turntable.py [MESH] [-o PICTURE]`.

Without a mesh it makes a jug, and paints it. The lights follow the camera.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray

import grelha

Array = NDArray[Any]

COLUMNS, ROWS, SIDE = 4, 2, 240


def turned(radius: Array, height: float, path: Array, around: int = 96) -> tuple[Array, Array]:
    """A tube of some radii along a path in the plane y = 0, (n, 2): x and z."""
    ahead = np.gradient(path, axis=0)
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    turn = np.arange(around) * 2 * np.pi / around
    side = radius[:, None] * np.cos(turn)
    rings = np.stack([path[:, :1] + ahead[:, 1:] * side,
                      radius[:, None] * np.sin(turn),
                      path[:, 1:] - ahead[:, :1] * side + height], -1)
    i, j = np.meshgrid(np.arange(len(path) - 1), np.arange(around), indexing="ij")
    a, b = (i * around + j).ravel(), (i * around + (j + 1) % around).ravel()
    return rings.reshape(-1, 3), np.concatenate([np.c_[a, b, a + around],
                                                 np.c_[b, b + around, a + around]])


def jug() -> tuple[Array, Array, Array]:
    down = np.linspace(0, 1, 120)
    body = np.concatenate([[0], 0.3 + 0.25 * np.sin(2.6 * down + 0.3) * (1 - 0.6 * down)])
    up = np.stack([0 * body, np.concatenate([[-1e-4], 1.2 * down])], -1)
    bend = np.linspace(-1.5, 1.85, 60)  # both ends lie in the body
    handle = np.stack([0.42 + 0.3 * np.cos(bend), 0.36 * np.sin(bend)], -1)
    (v, f), (w, g) = turned(body, 0, up), turned(np.full(60, 0.05), 0.66, handle)
    vertices = np.concatenate([v, w])
    around, z = np.arctan2(vertices[:, 1], vertices[:, 0]), vertices[:, 2]
    wave = np.abs(z - 0.62 - 0.05 * np.sin(6 * around)) < 0.04
    band = (np.abs(z - 0.45) < 0.02) | (np.abs(z - 0.79) < 0.02) | (z > 1.12)
    clay, glaze, blue = np.array([[196, 110, 72], [240, 232, 214], [38, 76, 140]], np.uint8)
    colors = np.where(wave[:, None], glaze, np.where(band[:, None], blue, clay))
    return vertices, np.concatenate([f, g + len(v)]), colors


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("mesh", nargs="?")
parser.add_argument("-o", "--output", default="turntable.png")
options = parser.parse_args()
if options.mesh:
    scene = grelha.read(options.mesh)
else:
    vertices, faces, colors = jug()
    scene = grelha.Scene(vertices, faces, colors=colors)
pictures = [scene.render(SIDE, SIDE, samples=16, orbit=(360 * k / (COLUMNS * ROWS), 0))
            for k in range(COLUMNS * ROWS)]
rows = [np.concatenate(pictures[r * COLUMNS:(r + 1) * COLUMNS], axis=1) for r in range(ROWS)]
grelha.write_image(options.output, np.concatenate(rows), srgb=scene.colors is not None)
print(f"{COLUMNS * ROWS} pictures of {len(scene.faces)} triangles")
