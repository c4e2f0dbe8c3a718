#!/usr/bin/env python3
"""How much of the sky each point of a scan sees: `ambient_occlusion.py [MESH] [-o PICTURE]`.

Without a mesh it makes a lump with dents, of 57,000 triangles. Each vertex sends rays in all
directions of its outer side. The picture shows the share that goes free.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray

import grelha

Array = NDArray[Any]
from grelha.open3d import RaycastingScene

RAYS, SIDE = 512, 600


def lump(rings: int = 120) -> tuple[Array, Array]:
    """A ball with waves on it."""
    around = 2 * rings
    down, along = np.meshgrid((np.arange(rings) + 0.5) * np.pi / rings,
                              np.arange(around) * 2 * np.pi / around, indexing="ij")
    p = np.stack([np.sin(down) * np.cos(along), np.sin(down) * np.sin(along), np.cos(down)], -1)
    waves = np.sin(7 * p[..., 0]) * np.sin(6 * p[..., 1] + 1) * np.sin(8 * p[..., 2] + 2)
    vertices = (p * (1 + 0.35 * waves[..., None])).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rings - 1), np.arange(around), indexing="ij")
    a, b = (i * around + j).ravel(), (i * around + (j + 1) % around).ravel()
    return vertices, np.concatenate([np.c_[a, a + around, b], np.c_[b, a + around, b + around]])


def vertex_normals(vertices: Array, faces: Array) -> Array:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    across, normals = np.cross(b - a, c - a), np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, faces[:, k], across)
    unit: Array = normals / np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-30)
    return unit


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("mesh", nargs="?")
parser.add_argument("-o", "--output", default="ambient_occlusion.png")
options = parser.parse_args()
scene = grelha.read(options.mesh) if options.mesh else grelha.Scene(*lump())
world, vertices, faces = scene.world, scene.vertices, scene.faces
normals = vertex_normals(vertices, faces)
starts = vertices + normals * 1e-4 * np.ptp(vertices, axis=0).max()
rng, free = np.random.default_rng(1), np.zeros(len(vertices))
for _ in range(RAYS):  # normal plus a point of the unit sphere: more rays where more light counts
    sphere = rng.normal(size=vertices.shape)
    sphere /= np.linalg.norm(sphere, axis=-1, keepdims=True)
    free += ~world.occluded(starts, normals + 0.999 * sphere)

view = scene.camera
up = [-x for x in view["up"]]  # the first row of Open3D's rays is the lowest
pixels = RaycastingScene.create_rays_pinhole(view["angle"], view["at"], view["eye"], up, SIDE, SIDE)
hits = world.closest(pixels[..., :3], pixels[..., 3:])
at = (free / RAYS)[faces[hits.face]]  # of the three corners
share = (1 - hits.u - hits.v) * at[..., 0] + hits.u * at[..., 1] + hits.v * at[..., 2]
grelha.write_image(options.output, np.where(hits.face >= 0, share, 0.05))
print(f"{RAYS * len(vertices)} rays; {free.mean() / RAYS:.3f} of the sky is seen on average")
