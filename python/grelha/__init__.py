"""Rays through triangles and spheres, from numpy arrays. See help(grelha.World).

World answers closest hits, occlusion, all hits, inside tests and distances. Scene renders pictures.
t counts lengths of the ray's direction; all other lengths are in the units of the vertices.
docs/python.md has examples.
"""
from . import _grelha
from ._grelha import __version__
from ._results import (ClosestPoints, CrossingLists, Findings, HitLists, Hits, MeshCheck,
                       Surfaces)
from ._world import World

__all__ = ["ClosestPoints", "CrossingLists", "Findings", "HitLists", "Hits", "MeshCheck",
           "Surfaces", "World", "__version__"]
World.__module__ = "grelha"
_OF_PICTURES = ("Scene", "read", "write_image")

if hasattr(_grelha, "SceneCore"):
    from ._scene import Scene, read, write_image

    __all__ += _OF_PICTURES
    for _name in _OF_PICTURES:
        globals()[_name].__module__ = "grelha"
else:
    def __getattr__(name):
        lacks = (": it was built without OpenEXR or another library of pictures (docs/python.md)"
                 if name in _OF_PICTURES else "")
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{lacks}")
