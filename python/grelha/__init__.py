"""Rays through triangles and spheres, from numpy arrays. See help(grelha.World)."""
from ._grelha import Scene, World, __version__, read, write_image
from ._results import ClosestPoints, HitLists, Hits

for _class in (World, Scene):
    _class.__module__ = "grelha"

__all__ = ["ClosestPoints", "HitLists", "Hits", "Scene", "World", "__version__", "read",
           "write_image"]
