"""RayMeshIntersector with the methods of trimesh.ray.

    from grelha.trimesh import RayMeshIntersector
    mesh.ray = RayMeshIntersector(mesh)

The mesh is anything with .vertices (n, 3) and .faces (m, 3). Options behind the rays stand in the
order of trimesh.ray.ray_pyembree; ray_triangle has another, for which names are safe. A ray that
starts on a face does not hit it; trimesh's own find it at a distance of 0.
"""
import numpy as np

from ._geometry import array_of, numbers, points_along, shown, whole_number
from ._world import World

__all__ = ["RayMeshIntersector"]


def _rows(given, name):
    array = numbers(given, name, 3)
    if array.ndim != 2:
        raise ValueError(f"{name}: expected shape (n, 3), found {array.shape}")
    return array


def _same(array, before):
    """True if the bytes are those of before, which is seen a hundred times faster than built."""
    if array.shape != before.shape or array.dtype != before.dtype:
        return False
    words = f"u{array.itemsize}" if array.itemsize in (1, 2, 4, 8) else array.dtype
    return np.array_equal(array.view(words), before.view(words))


class RayMeshIntersector:
    """Rays through one mesh. A mesh that changes is built anew before the next query.

    Vertices and faces are compared with those of before, number by number. They may change in
    place, and the mesh may make them anew each time.
    """

    def __init__(self, mesh=None, geometry=None, **kwargs):
        """mesh (also `geometry`): has .vertices and .faces. Other options change nothing."""
        mesh = geometry if mesh is None else mesh
        if not hasattr(mesh, "vertices") or not hasattr(mesh, "faces"):
            raise TypeError("mesh: expected an object with vertices and faces, found "
                            f"{type(mesh).__name__}")
        self.mesh = mesh
        self._world = None
        self._commit()

    def intersects_id(self, ray_origins, ray_directions, multiple_hits=True, max_hits=None,
                      return_locations=False, **kwargs):
        """The triangles that rays (n, 3) pass through.

        multiple_hits      False: the first hit of each ray alone
        max_hits           at most so many of each ray, the nearest; None: all
        return_locations   also where

        A ray that passes through an edge or a vertex passes through one triangle there; one that
        touches it, through none or through two.

        Returns index_tri (h,) and index_ray (h,), int64, by ray and distance; with return_locations
        also locations (h, 3) float64.
        """
        tri, ray, locations = self._hits(ray_origins, ray_directions, multiple_hits, max_hits)
        return (tri, ray, locations) if return_locations else (tri, ray)

    def intersects_location(self, ray_origins, ray_directions, multiple_hits=True, **kwargs):
        """Where rays (n, 3) hit: locations (h, 3) float64, index_ray (h,), index_tri (h,), int64.

        Takes the options of intersects_id().
        """
        kwargs.update(multiple_hits=multiple_hits, return_locations=True)
        tri, ray, locations = self.intersects_id(ray_origins, ray_directions, **kwargs)
        return locations, ray, tri

    def intersects_first(self, ray_origins, ray_directions, **kwargs):
        """The first triangle of each ray (n, 3): (n,) int64, -1 without a hit."""
        origins, directions = self._rays(ray_origins, ray_directions)
        return self._commit().closest(origins, directions).face.copy()

    def intersects_any(self, ray_origins, ray_directions, **kwargs):
        """True for each ray (n, 3) that hits any triangle: (n,) bool."""
        origins, directions = self._rays(ray_origins, ray_directions)
        return self._commit().occluded(origins, directions)

    def contains_points(self, points):
        """True for each point (n, 3) inside the closed mesh: (n,) bool. Exact.

        Of an open mesh, as in trimesh, the parity of crossings along one ray.
        """
        return self._commit().contains(_rows(points, "points"), inside="odd")

    def _commit(self):
        vertices, faces = self.mesh.vertices, self.mesh.faces
        arrays = array_of(vertices, "mesh.vertices"), array_of(faces, "mesh.faces")
        if self._world is None or not all(map(_same, arrays, self._built)):
            world = World(*arrays)
            self._built = tuple(array.copy() for array in arrays)
            self._corners = self._built[0][world.faces].astype(np.float64)
            self._world = world
        return self._world

    def _rays(self, ray_origins, ray_directions):
        origins, directions = _rows(ray_origins, "ray_origins"), _rows(ray_directions,
                                                                       "ray_directions")
        if len(origins) != len(directions):
            raise ValueError(f"ray_directions: expected shape {origins.shape} as of ray_origins, "
                             f"found {directions.shape}")
        return origins, directions

    def _hits(self, ray_origins, ray_directions, multiple_hits, max_hits):
        origins, directions = self._rays(ray_origins, ray_directions)
        if not isinstance(multiple_hits, (bool, np.bool_)):
            raise TypeError(f"multiple_hits: expected a bool, found {shown(multiple_hits)}")
        if max_hits is not None:
            max_hits = whole_number(max_hits, "max_hits", 0, "a number of hits, or None")
        world = self._commit()
        if multiple_hits:
            offsets, t, tri, _ = world.crossings(origins, directions)
            ray = np.repeat(np.arange(len(origins)), np.diff(offsets))
            if max_hits is not None:
                keep = np.arange(len(t)) - offsets[ray] < max_hits
                t, tri, ray = t[keep], tri[keep], ray[keep]
        else:
            hits = world.closest(origins, directions)
            ray = np.flatnonzero(hits.face >= 0)
            t, tri = hits.t[ray], hits.face[ray]
        places = points_along(origins[ray].astype(np.float64), directions[ray].astype(np.float64),
                              t.astype(np.float64), self._corners[tri])
        return tri, ray, places
