"""What World's methods give back."""
from typing import Any, NamedTuple

import numpy as np

from ._geometry import numbers


def _part(self, index):
    """A member by its number, as of any tuple, or by an array the answers of these rays."""
    if not isinstance(index, (np.ndarray, list, tuple)):
        return tuple.__getitem__(self, index)
    return type(self)(*(np.asarray(member)[index] for member in self))


class Hits(NamedTuple):
    """Nearest hits: arrays with one element for each ray, or plain numbers for one ray.

    hits[mask] or hits[indices], of arrays, are those of some rays.
    """
    t: Any  # float32; inf without a hit
    id: Any  # int64; -1 without a hit
    u: Any  # float32
    v: Any  # float32
    face: Any  # int64; -1 without a triangle

    __getitem__ = _part

    def points(self, origins, directions):
        """Where these hits are: origins + t directions, computed in double, NaN without a hit.

        origins, directions   as closest() was given them, (..., 3); of hits[mask] those of the mask

        Returns (..., 3), float64 if one of them is, else float32.
        """
        t = np.asarray(self.t)
        ray = [numbers(given, name, 3) for given, name in ((origins, "origins"),
                                                           (directions, "directions"))]
        shape = (*t.shape, 3)
        for array, name in zip(ray, ("origins", "directions")):
            try:
                np.broadcast_to(array, shape)
            except ValueError:
                raise ValueError(f"{name}: expected shape {shape} as of the hits, "
                                 f"found {array.shape}") from None
        t = np.where(np.isfinite(t), t, np.nan)[..., None].astype(np.float64)
        return (ray[0] + t * ray[1]).astype(np.result_type(*ray))


class HitLists(NamedTuple):
    """All hits: those of ray i are t[offsets[i]:offsets[i + 1]], and the same of id."""
    offsets: Any  # int64 (rays + 1,)
    t: Any  # float32 (hits,)
    id: Any  # int64 (hits,)


class CrossingLists(NamedTuple):
    """All crossings: those of ray i are t[offsets[i]:offsets[i + 1]], and the same of the rest."""
    offsets: Any  # int64 (rays + 1,)
    t: Any  # float32 (crossings,)
    id: Any  # int64 (crossings,)
    enters: Any  # bool (crossings,)


class ClosestPoints(NamedTuple):
    """Closest points: arrays with one element for each point, or plain numbers for one point."""
    points: Any  # float64 or float32 (..., 3)
    distance: Any  # float32; inf where there is none
    id: Any  # int64; -1 where there is none

    __getitem__ = _part


class Findings(NamedTuple):
    """How many of some kind there are, and the first eight, those of the lowest faces."""
    count: int  # type: ignore[assignment]  # hides that of tuple
    first: Any  # int64 (k,): faces; of edges (k, 3): a face, and the vertices it goes from and to


class MeshCheck(NamedTuple):
    """What a mesh is. Vertices at one place are one vertex, whatever their indices."""
    triangles: int  # finite ones
    vertices: int  # places of corners
    edges: int
    open_edges: Findings  # of an odd number of triangles
    inconsistent_edges: Findings  # of an even number of triangles, of which not half go each way
    nonmanifold_edges: Findings  # of more than two triangles
    duplicate_triangles: Findings  # with the corners of one before, in any order
    degenerate_triangles: Findings  # without area, exactly
    nonfinite_triangles: Findings  # with a NaN or an infinity: left out, as by queries

    @property
    def closed(self):
        """True if no edge is open."""
        return self.open_edges.count == 0

    @property
    def oriented(self):
        """True if neighbours agree on which side is the front: no edge is inconsistent."""
        return self.inconsistent_edges.count == 0

    @property
    def manifold(self):
        """True if no edge has more than two triangles. Meshes may still touch in a vertex."""
        return self.nonmanifold_edges.count == 0

    edge_manifold = manifold


class Surfaces(NamedTuple):
    """What rays hit: arrays with one element for each ray, of shape (3,) and () for one ray."""
    points: Any  # float64 or float32 (..., 3)
    normals: Any  # float32 (..., 3)
    colors: Any  # float32 (..., 3)
    id: Any  # int64; -1 without a hit

    __getitem__ = _part
