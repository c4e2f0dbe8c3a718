#!/usr/bin/env python3
"""Pictures of a mesh from all sides, on one sheet: `turntable.py [MESH] [-o PICTURE]`.

Without a mesh it makes a jug. The mesh turns, camera and lights stay.
"""
import argparse

import numpy as np

import grelha

COLUMNS, ROWS, SIDE = 4, 2, 240


def turned(radius, height, path, around=96):
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


def jug():
    down = np.linspace(0, 1, 120)
    body = np.concatenate([[0], 0.3 + 0.25 * np.sin(2.6 * down + 0.3) * (1 - 0.6 * down)])
    up = np.stack([0 * body, np.concatenate([[-1e-4], 1.2 * down])], -1)
    bend = np.linspace(-1.5, 1.85, 60)  # both ends lie in the body
    handle = np.stack([0.42 + 0.3 * np.cos(bend), 0.36 * np.sin(bend)], -1)
    (v, f), (w, g) = turned(body, 0, up), turned(np.full(60, 0.05), 0.66, handle)
    return np.concatenate([v, w]), np.concatenate([f, g + len(v)])


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("mesh", nargs="?")
parser.add_argument("-o", "--output", default="turntable.png")
options = parser.parse_args()
scene = grelha.read(options.mesh) if options.mesh else grelha.Scene(*jug())
vertices, faces, view = scene.vertices, scene.faces, scene.camera
middle, up = np.array(view["at"]), np.array(view["up"]) / np.linalg.norm(view["up"])
pictures = []
for angle in np.arange(COLUMNS * ROWS) * 2 * np.pi / (COLUMNS * ROWS):
    arm = vertices - middle  # Rodrigues' formula
    moved = (arm * np.cos(angle) + np.cross(up, arm) * np.sin(angle)
             + np.outer(arm @ up, up) * (1 - np.cos(angle)))
    pictures.append(grelha.Scene(moved + middle, faces).render(
        SIDE, SIDE, samples=16, eye=view["eye"], at=view["at"], up=view["up"],
        angle=1.15 * view["angle"]))
rows = [np.concatenate(pictures[r * COLUMNS:(r + 1) * COLUMNS], axis=1) for r in range(ROWS)]
grelha.write_image(options.output, np.concatenate(rows))
print(f"{COLUMNS * ROWS} pictures of {len(faces)} triangles")
