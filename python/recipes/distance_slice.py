#!/usr/bin/env python3
"""A slice through a mesh: what is inside, and how far the surface is.

`distance_slice.py [MESH] [-o PICTURE]`. Without a mesh it makes two rings, one through the other.
The slice lies across z, in the middle. Inside is orange, outside blue; stripes are lines of equal
distance. Of a mesh with holes the winding number tells what is inside.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray

import grelha

Array = NDArray[Any]

SIDE, STRIPES = 400, 24


def ring(turned: bool, around: int = 40, tube: int = 12) -> tuple[Array, Array]:
    """A closed torus."""
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(tube) * 2 * np.pi / tube,
                       indexing="ij")
    r = 1 + 0.3 * np.cos(v)
    axes = [r * np.cos(u), r * np.sin(u), 0.3 * np.sin(v)]
    if turned:
        axes = [axes[0] + 1, -axes[2], axes[1]]
    i, j = np.meshgrid(np.arange(around), np.arange(tube), indexing="ij")
    a, b = i * tube + j, i * tube + (j + 1) % tube
    c, d = (i + 1) % around * tube + j, (i + 1) % around * tube + (j + 1) % tube
    faces = np.concatenate([np.stack([a, c, b], -1), np.stack([b, c, d], -1)]).reshape(-1, 3)
    return np.stack(axes, -1).reshape(-1, 3), faces


def rings() -> tuple[Array, Array]:
    (v, f), (w, g) = ring(False), ring(True)
    return np.concatenate([v, w]), np.concatenate([f, g + len(v)])


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("mesh", nargs="?")
parser.add_argument("-o", "--output", default="distance_slice.png")
options = parser.parse_args()
world = grelha.read(options.mesh).world if options.mesh else grelha.World(*rings())
low, high = world.vertices.min(0), world.vertices.max(0)
middle, size = (low + high) / 2, 1.15 * (high - low)[:2].max()
across = (np.arange(SIDE) + 0.5) / SIDE - 0.5
x, y = np.meshgrid(middle[0] + size * across, middle[1] - size * across)
points = np.stack([x, y, np.full_like(x, middle[2])], -1)

mesh = world.check()
rule: Any = "closed" if mesh.closed else "winding"
distance = world.signed_distance(points, inside=rule)  # negative inside
assert ((distance < 0) <= world.contains(points, inside=rule)).all()
stripes = 0.85 + 0.15 * np.cos(2 * np.pi * STRIPES * distance / size)
colour = np.where(distance[..., None] < 0, (1, 0.6, 0.2), (0.4, 0.65, 0.9))
fade = np.exp(-6 * np.abs(distance) / size)
edge = np.clip(np.abs(distance) / size * SIDE / 1.5, 0, 1)
grelha.write_image(options.output, colour * (stripes * (0.45 + 0.55 * fade) * edge)[..., None])
print(f"{mesh.open_edges.count} open edges; "
      f"{(distance < 0).mean():.3f} of the slice is inside; farthest {distance.max():.4f}, "
      f"deepest {-distance.min():.4f}")
