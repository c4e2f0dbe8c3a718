#!/usr/bin/env python3
"""How thick the wall of a closed part is: `wall_thickness.py [MESH] [-o PICTURE]`.

Without a mesh it makes a bottle with a thin side. Each face sends a ray inwards. The picture is red
where the wall is thinner than the limit.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray

import grelha

Array = NDArray[Any]
from grelha.open3d import RaycastingScene

SIDE = 600


def bottle(around: int = 240, along: int = 160) -> tuple[Array, Array]:
    """Outside and inside, turned round the z axis; the inside is off the axis."""
    down = np.linspace(0, 1, along)
    outer = 0.42 + 0.10 * np.sin(5 * down + 1) - 0.26 * down**4 * (5 - 4 * down)
    inner = np.interp(0.08 + 1.32 * down, 1.4 * down, outer) - 0.07
    radius = np.concatenate([[0], outer, inner[::-1], [0]])
    height = np.concatenate([[0], 1.4 * down, 0.08 + 1.32 * down[::-1], [0.08]])
    off = np.concatenate([[0], 0 * down, 0.045 * np.sin(np.pi * down[::-1]), [0]])
    turn = np.arange(around) * 2 * np.pi / around
    rings = np.stack([radius[:, None] * np.cos(turn), radius[:, None] * np.sin(turn) + off[:, None],
                      np.repeat(height[:, None], around, 1)], -1)
    i, j = np.meshgrid(np.arange(len(radius) - 1), np.arange(around), indexing="ij")
    a, b = (i * around + j).ravel(), (i * around + (j + 1) % around).ravel()
    faces = np.concatenate([np.c_[a, b, a + around], np.c_[b, b + around, a + around]])
    return rings.reshape(-1, 3), faces


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("mesh", nargs="?")
parser.add_argument("-o", "--output", default="wall_thickness.png")
parser.add_argument("--limit", type=float, help="default: half of the mean thickness")
options = parser.parse_args()
scene = grelha.read(options.mesh) if options.mesh else grelha.Scene(*bottle())
world, faces = scene.world, scene.faces
corners = scene.vertices[faces]
normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-30)
# from just below the middle of the face: no distance to tune
thick = world.closest(world.start(np.arange(len(faces)), 1 / 3, 1 / 3, -normals), -normals).t
known = np.isfinite(thick)
limit = options.limit or 0.5 * np.median(thick[known])

view = scene.camera
up = [-x for x in view["up"]]  # the first row of Open3D's rays is the lowest
pixels = RaycastingScene.create_rays_pinhole(view["angle"], view["at"], view["eye"], up, SIDE, SIDE)
face = world.closest(pixels[..., :3], pixels[..., 3:]).face
share = np.clip(thick[face] / (3 * limit), 0, 1)[..., None]
colour = np.where(share < 1 / 3, (0.9, 0.15, 0.1), (1, 0.9, 0.4) - share * (0.9, 0.5, -0.2))
light = np.abs((normals[face] * pixels[..., 3:]).sum(-1) / np.linalg.norm(pixels[..., 3:], axis=-1))
grelha.write_image(options.output,
                   np.where((face >= 0)[..., None], colour * (0.4 + 0.6 * light[..., None]), 1))
thin = known & (thick < limit)
print(f"thinnest {thick[known].min():.4f}; {thin.sum()} of {len(faces)} faces below {limit:.4f}")
