"""trimesh's rays and nearest points, answered by Grelha.

    import grelha.trimesh
    grelha.trimesh.install()         # new meshes, copies and primitives ask Grelha from here on

or for one mesh:

    mesh.ray = grelha.trimesh.RayMeshIntersector(mesh)
    mesh.nearest = grelha.trimesh.ProximityQuery(mesh)

The mesh is anything with .vertices (n, 3) and .faces (m, 3). It is read at the first query, and
again after it changed.

What differs from trimesh:

- A ray that starts on a face does not hit it; trimesh's own find it at a distance of 0.
- A ray in the plane of a triangle does not hit it. Programs that measure from the centres of faces
  along other faces, or count hits at distance 0, find fewer. World.start() gives origins beside a
  face.
- An edge or a vertex that a ray passes through is one hit.

Options behind the rays stand in the order of trimesh.ray.ray_pyembree, and in that of ray_triangle
where install() put Grelha in its place. Names are safe.
"""
import importlib
import sys

import numpy as np

from ._geometry import array_of, barycentric, normals, numbers, points_along, shown, whole_number
from ._world import World

__all__ = ["ProximityQuery", "RayMeshIntersector", "closest_point", "install", "signed_distance",
           "uninstall"]

_ON_SURFACE = 1e-8  # trimesh.constants.tol.merge: the sign of nearer points is that of inside


def _rows(given, name):
    array = numbers(given, name, 3)
    if array.ndim != 2:
        raise ValueError(f"{name}: expected shape (n, 3), found {array.shape}")
    return array


def _is_plain(array):
    """True for what World takes as it is: rows of floats in an array of numpy's own type."""
    return (type(array) is np.ndarray and array.ndim == 2 and array.shape[1] == 3
            and array.dtype.char in "fd")


def _same(array, before):
    """True if the bytes are those of before, which is seen a hundred times faster than built."""
    if array.shape != before.shape or array.dtype != before.dtype:
        return False
    words = f"u{array.itemsize}" if array.itemsize in (1, 2, 4, 8) else array.dtype
    return np.array_equal(array.view(words), before.view(words))


def _state(array, copy):
    """What _is_as() compares with: the hash of trimesh's TrackedArray, of others the copy.

    A TrackedArray keeps its hash until it is written to, or sliced.
    """
    return array.__hash__() if hasattr(type(array), "mutable") else copy


def _is_as(array, state, name):
    """True if the array has not changed since _state()."""
    if type(state) is int:
        return hasattr(type(array), "mutable") and array.__hash__() == state
    return _same(array_of(array, name), state)


def _has(mesh, name):
    """True if the mesh seems to have it. Primitives of trimesh would make it when asked."""
    kind = type(mesh)
    return (hasattr(kind, name) or getattr(mesh, "__dict__", {}).get(name) is not None
            or hasattr(kind, "__getattr__"))


class RayMeshIntersector:
    """Rays through one mesh. A mesh that changed is built anew before the next query.

    trimesh's arrays tell whether they were written to. Others are compared with those of before,
    number by number: they may change in place, and the mesh may make them anew each time.
    """

    def __init__(self, mesh=None, geometry=None, **kwargs):
        """mesh (also `geometry`): has .vertices and .faces. Other options change nothing."""
        mesh = geometry if mesh is None else mesh
        if not (_has(mesh, "vertices") and _has(mesh, "faces")):
            raise TypeError("mesh: expected an object with vertices and faces, found "
                            f"{type(mesh).__name__}")
        self.mesh = mesh
        self._world = None

    def intersects_id(self, ray_origins, ray_directions, multiple_hits=True, max_hits=None,
                      return_locations=False, **kwargs):
        """The triangles that rays (n, 3) pass through.

        multiple_hits      False: the first hit of each ray alone
        max_hits           at most so many of each ray, the nearest; None: all
        return_locations   also where

        A ray that passes through an edge or a vertex passes through one triangle there; one that
        touches it, through none or through two. One that starts on a triangle, or runs in its
        plane, does not hit it.

        Returns index_tri (h,) and index_ray (h,), int64, by ray and distance; with return_locations
        also locations (h, 3) float64.
        """
        origins, directions = self._rays(ray_origins, ray_directions)
        tri, ray, t = self._hits(origins, directions, multiple_hits, max_hits)
        if not return_locations:
            return tri, ray
        corners = self._vertices[self._faces[tri]].astype(np.float64, copy=False)
        return tri, ray, points_along(origins[ray], directions[ray], t, corners)

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
        return self._commit().closest(origins, directions).face

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
        """The World of the mesh as it is now."""
        vertices, faces = self.mesh.vertices, self.mesh.faces
        if (self._world is not None and _is_as(vertices, self._states[0], "mesh.vertices")
                and _is_as(faces, self._states[1], "mesh.faces")):
            return self._world
        copies = [np.array(array_of(given, f"mesh.{name}"), subok=False)
                  for given, name in ((vertices, "vertices"), (faces, "faces"))]
        if not copies[1].size:  # trimesh gives empty arrays of other shapes
            copies = [copies[0].reshape(-1, 3), np.zeros((0, 3), np.int64)]
        world = World(*copies)
        self._states = _state(vertices, copies[0]), _state(faces, copies[1])
        self._vertices, self._faces, self._world = copies[0], world.faces, world
        return world

    def _rays(self, ray_origins, ray_directions):
        if (_is_plain(ray_origins) and _is_plain(ray_directions)
                and ray_origins.shape == ray_directions.shape):
            return ray_origins, ray_directions
        origins, directions = _rows(ray_origins, "ray_origins"), _rows(ray_directions,
                                                                       "ray_directions")
        if len(origins) != len(directions):
            raise ValueError(f"ray_directions: expected shape {origins.shape} as of ray_origins, "
                             f"found {directions.shape}")
        return origins, directions

    def _hits(self, origins, directions, multiple_hits, max_hits):
        """Triangles, rays and t."""
        if not isinstance(multiple_hits, (bool, np.bool_)):
            raise TypeError(f"multiple_hits: expected a bool, found {shown(multiple_hits)}")
        if max_hits is not None:
            max_hits = whole_number(max_hits, "max_hits", 0, "a number of hits, or None")
        world = self._commit()
        if not multiple_hits:
            hits = world.closest(origins, directions)
            ray = np.flatnonzero(hits.face >= 0)
            return hits.face[ray], ray, hits.t[ray]
        offsets, t, tri, _ = world.crossings(origins, directions)
        ray = np.arange(len(origins)).repeat(offsets[1:] - offsets[:-1])
        if max_hits is not None:
            keep = np.arange(len(t)) - offsets[ray] < max_hits
            tri, ray, t = tri[keep], ray[keep], t[keep]
        return tri, ray, t


class _InPlaceOfRayTriangle(RayMeshIntersector):
    """With the order of options that trimesh.ray.ray_triangle has."""

    def intersects_id(self, ray_origins, ray_directions, return_locations=False, multiple_hits=True,
                      **kwargs):
        kwargs.update(multiple_hits=multiple_hits, return_locations=return_locations)
        return super().intersects_id(ray_origins, ray_directions, **kwargs)


def _length(rows):
    return np.sqrt(np.einsum("...j,...j->...", rows, rows))


def _closest(ray, points, face):
    """The nearest points of triangles, (n, 3), and their barycentric weights, (n, 3)."""
    corners = ray._vertices[ray._faces[face]].astype(np.float64)
    u, v = barycentric(points, corners).T
    weights = np.stack([1 - u - v, u, v], axis=-1)
    return np.einsum("nk,nkj->nj", weights, corners), weights


class ProximityQuery:
    """Nearest points of one mesh, which may change as that of RayMeshIntersector.

    The World is that of mesh.ray where Grelha is there.
    """

    def __init__(self, mesh):
        """mesh: has .vertices and .faces."""
        self._own = RayMeshIntersector(mesh)
        self._mesh = mesh
        self._of_vertices = self._around = None, None

    def on_surface(self, points):
        """The nearest point of the mesh to each of points (n, 3).

        Returns closest (n, 3) float64, distance (n,) float64 and triangle_id (n,) int64: of the
        triangles at an edge or a vertex the one that faces the point, as in trimesh. Of an empty
        mesh the points, inf and -1; so of points that are not finite.
        """
        points = _rows(points, "points").astype(np.float64)
        ray = self._ray()
        face = ray._commit().closest_points(points).id
        closest, distance = points.copy(), np.full(len(points), np.inf)
        known = np.flatnonzero(face >= 0)
        closest[known], weights = _closest(ray, points[known], face[known])
        distance[known] = _length(points[known] - closest[known])
        at_edge = (weights.min(axis=1) < 1e-9) & (distance[known] > _ON_SURFACE)
        if at_edge.any():
            row = known[at_edge]
            corner = ray._faces[face[row], weights[at_edge].argmax(axis=1)]
            face[row] = self._facing(ray, points[row], closest[row], face[row], corner)
        return closest, distance, face

    closest_point = on_surface

    def signed_distance(self, points):
        """The distance of points (n, 3) to the mesh, (n,) float64: positive inside, as in trimesh.

        Which points are inside contains_points() says; those within 1e-8 of the surface are.
        """
        distance = self.on_surface(points)[1]
        inside = self._ray().contains_points(points) | (distance <= _ON_SURFACE)
        return np.where(inside, distance, -distance)

    def vertex(self, points):
        """The nearest vertex to each of points (n, 3), of a face or of none.

        Returns distance (n,) float64 and vertex_id (n,) int64.
        """
        points = _rows(points, "points").astype(np.float64)
        ray = self._ray()
        ray._commit()
        if self._of_vertices[0] is not ray._vertices:
            of_points = np.arange(len(ray._vertices))[:, None].repeat(3, axis=1)
            self._of_vertices = ray._vertices, World(ray._vertices, of_points)
        found = self._of_vertices[1].closest_points(points)
        distance = np.full(len(points), np.inf)
        known = found.id >= 0
        nearest = ray._vertices[found.id[known]].astype(np.float64)
        distance[known] = _length(points[known] - nearest)
        return distance, found.id

    def _facing(self, ray, points, closest, face, corner):
        """The triangles at closest, of those around a corner of each, that face the points."""
        if self._around[0] is not ray._vertices:
            order = np.argsort(ray._faces, axis=None, kind="stable")
            firsts = np.bincount(ray._faces.ravel() + 1, minlength=len(ray._vertices) + 1).cumsum()
            self._around = ray._vertices, order // 3, firsts
        _, faces, firsts = self._around
        counts = firsts[corner + 1] - firsts[corner]
        row = np.arange(len(points)).repeat(counts)
        of_row = np.arange(len(row)) - (counts.cumsum() - counts)[row]
        other = faces[firsts[corner][row] + of_row]
        away = points[row] - closest[row]
        farther = _length(points[row] - _closest(ray, points[row], other)[0]) - _length(away)
        score = np.einsum("ij,ij->i", normals(ray._vertices[ray._faces[other]]), away)
        score[farther > _ON_SURFACE] = -np.inf
        best = np.lexsort((-other, score, row))[counts.cumsum() - 1]
        return np.where(np.isfinite(score[best]), other[best], face)

    def _ray(self):
        ray = getattr(self._mesh, "ray", None)
        is_of_mesh = isinstance(ray, RayMeshIntersector) and ray.mesh is self._mesh
        return ray if is_of_mesh else self._own


def _nearest(mesh):
    nearest = getattr(mesh, "nearest", None)
    return nearest if isinstance(nearest, ProximityQuery) else ProximityQuery(mesh)


def closest_point(mesh, points):
    """The nearest points of a mesh: see ProximityQuery.on_surface()."""
    return _nearest(mesh).on_surface(points)


def signed_distance(mesh, points):
    """Distances to a mesh, positive inside: see ProximityQuery.signed_distance()."""
    return _nearest(mesh).signed_distance(points)


_PLACES = {("trimesh.ray.ray_triangle", "RayMeshIntersector"): _InPlaceOfRayTriangle,
           ("trimesh.ray.ray_pyembree", "RayMeshIntersector"): RayMeshIntersector,
           ("trimesh.proximity", "ProximityQuery"): ProximityQuery,
           ("trimesh.proximity", "closest_point"): closest_point,
           ("trimesh.proximity", "signed_distance"): signed_distance}
_replaced = {}  # what stood in the places before install()


def install():
    """Puts Grelha in trimesh's place: for new meshes, copies and primitives, until uninstall().

    mesh.ray, mesh.nearest, mesh.contains() and all of trimesh that asks these are Grelha's then,
    and trimesh.proximity's functions too. Meshes that were there before keep their mesh.ray.
    Raises ImportError without trimesh.
    """
    importlib.import_module("trimesh")
    for (module, name), ours in _PLACES.items():
        place = sys.modules.get(module)  # ray_pyembree is there with Embree alone
        if place is not None and (module, name) not in _replaced:
            _replaced[module, name] = getattr(place, name)
            setattr(place, name, ours)


def uninstall():
    """Takes Grelha out again, for new meshes. Those made in between keep it."""
    while _replaced:
        (module, name), theirs = _replaced.popitem()
        setattr(sys.modules[module], name, theirs)
