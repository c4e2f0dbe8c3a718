"""Rays through triangles and spheres, from numpy arrays. See help(grelha.World).

World answers closest hits, occlusion, all hits, inside tests and distances. Scene renders pictures.
t counts lengths of the ray's direction; all other lengths are in the units of the vertices.
docs/python.md has examples.
"""
from ._grelha import __version__
from ._results import (ClosestPoints, CrossingLists, Findings, HitLists, Hits, MeshCheck,
                       Surfaces)
from ._scene import Scene, read, write_image
from ._world import World

for _thing in (World, Scene, read, write_image):
    _thing.__module__ = "grelha"

__all__ = ["ClosestPoints", "CrossingLists", "Findings", "HitLists", "Hits", "MeshCheck", "Scene",
           "Surfaces", "World", "__version__", "read", "write_image"]
