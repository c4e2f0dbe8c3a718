"""RayMeshIntersector with the methods of trimesh.ray.

    from grelha.trimesh import RayMeshIntersector
    mesh.ray = RayMeshIntersector(mesh)

The mesh is anything with .vertices (n, 3) and .faces (m, 3). Arguments behind the rays are given by
name: the two classes of trimesh have them in different orders.
"""
import numpy as np

from ._geometry import first_of_equal, numbers, points_along
from ._grelha import World

__all__ = ["RayMeshIntersector"]


def _rows(given, name):
    array = numbers(given, name, 3)
    if array.ndim != 2:
        raise ValueError(f"{name}: expected shape (n, 3), found {array.shape}")
    return array


class RayMeshIntersector:
    """Rays through one mesh. A mesh that changes is built anew before the next query."""

    def __init__(self, mesh=None, geometry=None, **kwargs):
        """mesh (also `geometry`): has .vertices and .faces. Other options change nothing."""
        mesh = geometry if mesh is None else mesh
        if not hasattr(mesh, "vertices") or not hasattr(mesh, "faces"):
            raise TypeError("mesh: expected an object with vertices and faces, found "
                            f"{type(mesh).__name__}")
        self.mesh = mesh
        self._state = self._world = None
        self._commit()

    def intersects_id(self, ray_origins, ray_directions, *, return_locations=False,
                      multiple_hits=True, max_hits=None, **kwargs):
        """The triangles that rays (n, 3) hit.

        multiple_hits      False: the first hit of each ray alone
        max_hits           at most so many of each ray, the nearest; None: all
        return_locations   also where; hits of a ray at one place then count once

        Returns index_tri (h,) and index_ray (h,), int64, by ray and distance; with return_locations
        also locations (h, 3) float64.
        """
        tri, ray, locations = self._hits(ray_origins, ray_directions, multiple_hits, max_hits,
                                         unique=return_locations)
        return (tri, ray, locations) if return_locations else (tri, ray)

    def intersects_location(self, ray_origins, ray_directions, **kwargs):
        """Where rays (n, 3) hit: locations (h, 3) float64, index_ray (h,), index_tri (h,), int64.

        Takes the options of intersects_id().
        """
        kwargs["return_locations"] = True
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
        """True for each point (n, 3) inside the closed mesh: (n,) bool. Exact, without rays."""
        return self._commit().contains(_rows(points, "points"))

    def _commit(self):
        state = self._mesh_state()
        if self._world is None or state != self._state:
            vertices = np.asarray(self.mesh.vertices)
            self._world = World(vertices, self.mesh.faces)
            self._state = state
            self._corners = vertices[np.asarray(self.mesh.faces, np.int64)].astype(np.float64)
        return self._world

    def _mesh_state(self):
        """What differs once the mesh has changed: its hash, else where its arrays lie."""
        if type(self.mesh).__hash__ not in (object.__hash__, None):
            return hash(self.mesh)
        vertices, faces = np.asarray(self.mesh.vertices), np.asarray(self.mesh.faces)
        return tuple((a.__array_interface__["data"], a.shape) for a in (vertices, faces))

    def _rays(self, ray_origins, ray_directions):
        origins, directions = _rows(ray_origins, "ray_origins"), _rows(ray_directions,
                                                                       "ray_directions")
        if len(origins) != len(directions):
            raise ValueError(f"ray_directions: expected shape {origins.shape} as of ray_origins, "
                             f"found {directions.shape}")
        return origins, directions

    def _hits(self, ray_origins, ray_directions, multiple_hits, max_hits, unique):
        origins, directions = self._rays(ray_origins, ray_directions)
        world = self._commit()
        if multiple_hits:
            lists = world.all_hits(origins, directions)
            t, tri, begin = lists.t, lists.id, lists.offsets[:-1]
            ray = np.repeat(np.arange(len(origins)), np.diff(lists.offsets))
            keep = first_of_equal(ray, t, np.zeros(len(t))) if unique else np.ones(len(t), bool)
            if max_hits is not None:
                rank = np.cumsum(keep) - 1
                keep &= rank - rank[np.minimum(begin[ray], len(t) - 1)] < max_hits
            t, tri, ray = t[keep], tri[keep], ray[keep]
        else:
            hits = world.closest(origins, directions)
            ray = np.flatnonzero(hits.face >= 0)
            t, tri = hits.t[ray], hits.face[ray]
        places = points_along(origins[ray].astype(np.float64), directions[ray].astype(np.float64),
                              t.astype(np.float64), self._corners[tri])
        return tri, ray, places
