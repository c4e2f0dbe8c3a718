#!/usr/bin/env python3
"""Hours of sun on each piece of a terrain, in one day: `sun_hours.py [MESH] [-o PICTURE]`.

Without a mesh it makes hills of 2 km. z is up, y north. Blue has no sun, yellow the most.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray

import grelha

Array = NDArray[Any]

LATITUDE, DECLINATION = np.radians(46), np.radians(-10)  # the Alps in February


def hills(n: int = 300, size: float = 2000.0) -> tuple[Array, Array]:
    """A grid of heights: waves of many lengths, the longer the higher."""
    rng = np.random.default_rng(3)
    x, y = np.meshgrid(np.linspace(0, size, n), np.linspace(0, size, n))
    z = np.zeros_like(x)
    for length in size / np.geomspace(1, 16, 40):
        along = rng.normal(size=2)
        wave = (x * along[0] + y * along[1]) / np.hypot(*along) * 2 * np.pi / length
        z += 0.03 * length * np.sin(wave + rng.uniform(0, 7))
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = (s.ravel() for s in (i[:-1, :-1], i[:-1, 1:], i[1:, :-1], i[1:, 1:]))
    return np.stack([x, y, z], -1).reshape(-1, 3), np.concatenate([np.c_[a, b, d], np.c_[a, d, c]])


def sun_at(hour: float) -> Array:
    """The direction to the sun: east, north, up."""
    turn, sin, cos = np.radians(15 * (hour - 12)), np.sin(LATITUDE), np.cos(LATITUDE)
    south, high = np.cos(DECLINATION) * np.cos(turn), np.sin(DECLINATION)
    east = -np.cos(DECLINATION) * np.sin(turn)
    return np.array([east, cos * high - sin * south, sin * high + cos * south])


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("mesh", nargs="?")
parser.add_argument("-o", "--output", default="sun_hours.png")
options = parser.parse_args()
scene = grelha.read(options.mesh) if options.mesh else grelha.Scene(*hills())
world, vertices, faces = scene.world, scene.vertices, scene.faces
corners = vertices[faces]
normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
hours = np.zeros(len(faces))
for hour in np.arange(5, 19, 0.5):
    sun = sun_at(hour)
    if sun[2] > 0:  # a face does not shade itself: it is skipped
        lit = ~world.occluded(corners.mean(1), sun, skip=np.arange(len(faces)))
        hours += 0.5 * (lit & (normals @ sun > 0))
low, high, across = vertices.min(0), vertices.max(0), (np.arange(600) + 0.5) / 600
x, y = np.meshgrid(low[0] + across * (high - low)[0], high[1] - across * (high - low)[1])
hits = world.closest(np.stack([x, y, np.full_like(x, high[2] + 1)], -1), (0, 0, -1))
share = hours[hits.face] / hours.max()
light = 0.75 + 0.25 * (normals @ (-0.6, 0.6, 0.5) / np.linalg.norm(normals, axis=-1))[hits.face]
stops = (0.02, 0.7, 1), (0.03, 0.13, 0.85), (0.2, 0.05, 0.35)  # of red, green, blue
colour = [np.interp(share, (0, 0.5, 1), stop) for stop in stops]
grelha.write_image(options.output, np.stack(light * colour, -1))
print(f"{hours.min():.2f} to {hours.max():.2f} hours of sun, {hours.mean():.2f} on average")
