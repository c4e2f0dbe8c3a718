"""RaycastingScene with the names of open3d.t.geometry.RaycastingScene, on numpy arrays.

    from grelha.open3d import RaycastingScene

Arguments may be arrays, lists, or tensors with .numpy(). Answers to Open3D's tensors are such
tensors. Others are numpy arrays that are read like tensors too: they and their elements have
.numpy(), .cpu(), .isfinite() and so on. Rays and points may be float64. Answers do not depend on
the number of threads. Inside and outside are exact: `nsamples` is read and not needed. A ray that
starts on a triangle, or runs in its plane, does not hit it.
"""
import sys

import numpy as np

from ._answers import answer
from ._geometry import (array_of, barycentric, normals, numbers, points_along, shown,
                        whole_number)
from ._world import World

__all__ = ["RaycastingScene"]


def _with_two_axes(given, name, last):
    array = numbers(given, name, last)
    if array.ndim < 2:
        raise ValueError(f"{name}: expected shape (..., {last}) of two or more axes, "
                         f"found {array.shape}")
    return array


def _check_samples(nsamples):
    wanted = "an odd number above 0"
    if whole_number(nsamples, "nsamples", 1, wanted) % 2 == 0:
        raise ValueError(f"nsamples: expected {wanted}, found {shown(nsamples)}")


def _mesh_arrays(mesh):
    """Vertices and triangles of a mesh of Open3D, of either kind."""
    try:
        if hasattr(mesh, "vertex"):
            return mesh.vertex["positions"], mesh.triangle["indices"]
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    except (AttributeError, KeyError, TypeError):
        raise TypeError("mesh: expected vertices and triangles, or a triangle mesh of Open3D, "
                        f"found {type(mesh).__name__}") from None


def _maker(kind):
    """What makes answers from arrays: tensors where kind is Open3D's type of them."""
    return getattr(kind, "from_numpy", answer)


def _answers(arrays, given):
    make = _maker(type(given))
    return {name: make(np.ascontiguousarray(array)) for name, array in arrays.items()}


def _answer(array, given):
    return _answers({"it": array}, given)["it"]


class RaycastingScene:
    """Triangle meshes for rays and closest points. Meshes are numbered as they are added."""

    INVALID_ID = 0xFFFFFFFF  # of rays without a hit

    def __init__(self, nthreads=0, device=None):
        """nthreads: to build with, 0 for all. device: None or a CPU."""
        if device is not None and "CPU" not in str(device).upper():
            raise ValueError(f"device: expected a CPU, found {device}")
        self._threads = nthreads
        self._meshes = []
        self._world = None

    def add_triangles(self, vertex_positions, triangle_indices=None):
        """Adds vertices (n, 3) and triangles (m, 3), or a mesh of Open3D. Returns its ID."""
        if triangle_indices is None:
            vertex_positions, triangle_indices = _mesh_arrays(vertex_positions)
        vertices = numbers(vertex_positions, "vertex_positions", 3)
        if vertices.ndim != 2:
            raise ValueError(f"vertex_positions: expected shape (n, 3), found {vertices.shape}")
        triangles = array_of(triangle_indices, "triangle_indices")
        if triangles.size and triangles.dtype.kind not in "iu":
            raise TypeError("triangle_indices: expected whole numbers, found "
                            f"{triangles.dtype}")
        if triangles.ndim != 2 or triangles.shape[1] != 3:
            raise ValueError(f"triangle_indices: expected shape (m, 3), found {triangles.shape}")
        triangles = triangles.astype(np.int64)
        if triangles.size and (triangles.min() < 0 or triangles.max() >= len(vertices)):
            raise ValueError(f"triangle_indices: expected indices of {len(vertices)} vertices, "
                             f"found {triangles.min()} to {triangles.max()}")
        self._meshes.append((vertices.copy(), triangles))
        self._world = None
        return len(self._meshes) - 1

    def cast_rays(self, rays, nthreads=0):
        """The first hit of each ray, (..., 6): origin and direction.

        Returns a dict: t_hit (...) float32, inf without a hit; geometry_ids and primitive_ids (...)
        uint32, INVALID_ID without one; primitive_uvs (..., 2) and primitive_normals (..., 3)
        float32, 0 without one.
        """
        array = _with_two_axes(rays, "rays", 6)
        world = self._commit()
        hits = world.closest(array[..., :3], array[..., 3:], threads=nthreads)
        return _answers({"t_hit": hits.t,
                         "primitive_uvs": np.stack([hits.u, hits.v], axis=-1),
                         **self._described(hits.face)}, rays)

    def test_occlusions(self, rays, tnear=0.0, tfar=np.inf, nthreads=0):
        """True for each ray (..., 6) that hits anything between tnear and tfar: bool (...)."""
        array = _with_two_axes(rays, "rays", 6)
        return _answer(self._commit().occluded(array[..., :3], array[..., 3:], tnear, tfar,
                                               threads=nthreads), rays)

    def count_intersections(self, rays, nthreads=0):
        """How often each ray (..., 6) passes through the surfaces: int32 (...).

        Odd from inside a closed mesh and even from outside, also where the ray meets an edge or a
        vertex. A ray that touches one there counts 0 or 2.
        """
        array = _with_two_axes(rays, "rays", 6)
        counts = self._commit().count_crossings(array[..., :3], array[..., 3:], threads=nthreads)
        return _answer(counts.astype(np.int32), rays)

    def list_intersections(self, rays, nthreads=0):
        """Where each ray (..., 6) passes through the surfaces; see count_intersections().

        Returns a dict: ray_splits (rays + 1,) uint32, where those of each ray begin; ray_ids,
        geometry_ids and primitive_ids uint32, t_hit float32, all (passages,); primitive_uvs
        (passages, 2) float32. They are in the order of the ray.
        """
        array = _with_two_axes(rays, "rays", 6)
        offsets, t, face, _ = self._commit().crossings(array[..., :3], array[..., 3:],
                                                       threads=nthreads)
        ray = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
        rows = array.reshape(-1, 6).astype(np.float64)
        corners = self._corners[face]
        points = points_along(rows[ray, :3], rows[ray, 3:], t, corners)
        described = self._described(face)
        return _answers({"ray_splits": offsets.astype(np.uint32),
                         "ray_ids": ray.astype(np.uint32),
                         "t_hit": t,
                         "geometry_ids": described["geometry_ids"],
                         "primitive_ids": described["primitive_ids"],
                         "primitive_uvs": barycentric(points, corners).astype(np.float32)}, rays)

    def compute_closest_points(self, query_points, nthreads=0):
        """The closest point of the surfaces to each point (..., 3).

        Returns a dict: points (..., 3) float32; geometry_ids and primitive_ids (...) uint32;
        primitive_uvs (..., 2) and primitive_normals (..., 3) float32.
        """
        points = _with_two_axes(query_points, "query_points", 3)
        found = self._commit().closest_points(points, threads=nthreads)
        face = found.id.ravel()
        uvs = np.zeros((face.size, 2))
        hit = face >= 0
        uvs[hit] = barycentric(found.points.reshape(-1, 3)[hit], self._corners[face[hit]])
        return _answers({"points": found.points.astype(np.float32),
                         "primitive_uvs": uvs.astype(np.float32).reshape(*points.shape[:-1], 2),
                         **self._described(found.id)}, query_points)

    def compute_distance(self, query_points, nthreads=0):
        """The distance of each point (..., 3) to the surfaces: float32 (...)."""
        points = _with_two_axes(query_points, "query_points", 3)
        found = self._commit().closest_points(points, threads=nthreads)
        return _answer(found.distance, query_points)

    def compute_signed_distance(self, query_points, nthreads=0, nsamples=1):
        """The same, negative inside closed meshes; of open ones by the crossings of one ray."""
        _check_samples(nsamples)
        points = _with_two_axes(query_points, "query_points", 3)
        found = self._commit().signed_distance(points, inside="odd", threads=nthreads)
        return _answer(found, query_points)

    def compute_occupancy(self, query_points, nthreads=0, nsamples=1):
        """1 for each point (..., 3) that has a negative distance, else 0: float32 (...)."""
        _check_samples(nsamples)
        points = _with_two_axes(query_points, "query_points", 3)
        inside = self._commit().contains(points, inside="odd", threads=nthreads)
        return _answer(inside.astype(np.float32), query_points)

    @staticmethod
    def create_rays_pinhole(*args, **kwargs):
        """Rays of a pinhole camera, (height_px, width_px, 6) float32, through the pixels' centres.

        create_rays_pinhole(intrinsic_matrix, extrinsic_matrix, width_px, height_px): (3, 3) and,
        from the world to the camera, (4, 4).
        create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px): fov_deg is horizontal.
        As in Open3D, rows run along `up`: the first row is the lowest. A tensor where the program
        has imported open3d.
        """
        by_matrix = ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px")
        by_view = ("fov_deg", "center", "eye", "up", "width_px", "height_px")
        for names, make in ((by_matrix, _rays_by_matrix), (by_view, _rays_by_view)):
            given = {**dict(zip(names, args)), **kwargs}
            if len(args) + len(kwargs) == len(names) and set(given) == set(names):
                core = getattr(sys.modules.get("open3d"), "core", None)
                return _maker(getattr(core, "Tensor", None))(make(**given))
        raise TypeError(f"create_rays_pinhole: expected {', '.join(by_matrix)} or "
                        f"{', '.join(by_view)}, found {len(args)} arguments and "
                        f"{', '.join(kwargs) or 'no'} names")

    def _commit(self):
        if self._world is None:
            world = World.of(self._meshes, threads=self._threads)
            self._corners = world.vertices[world.faces].astype(np.float64)
            self._normals = normals(self._corners).astype(np.float32)
            self._world = world
        return self._world

    def _described(self, face):
        """Mesh, triangle and normal of faces of the World, -1 for none."""
        mesh, triangle = self._world.mesh_of(face)
        hit = face >= 0
        normal = np.zeros((*face.shape, 3), np.float32)
        normal[hit] = self._normals[face[hit]]
        return {"geometry_ids": np.where(hit, mesh, self.INVALID_ID).astype(np.uint32),
                "primitive_ids": np.where(hit, triangle, self.INVALID_ID).astype(np.uint32),
                "primitive_normals": normal}


def _matrix(given, name, shape):
    array = array_of(given, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: expected numbers of shape {shape}, found {type(given).__name__}")
    if array.shape != shape:
        raise ValueError(f"{name}: expected shape {shape}, found {array.shape}")
    return array.astype(np.float64)


def _rays_by_matrix(intrinsic_matrix, extrinsic_matrix, width_px, height_px):
    inside = _matrix(intrinsic_matrix, "intrinsic_matrix", (3, 3))
    outside = _matrix(extrinsic_matrix, "extrinsic_matrix", (4, 4))
    for name, side in (("width_px", width_px), ("height_px", height_px)):
        whole_number(side, name, 1, "a number of pixels above 0")
    turn = outside[:3, :3].T
    try:
        to_world = turn @ np.linalg.inv(inside)
    except np.linalg.LinAlgError:
        raise ValueError("intrinsic_matrix: expected one that has an inverse") from None
    x, y = np.meshgrid(np.arange(width_px) + 0.5, np.arange(height_px) + 0.5)
    rays = np.empty((height_px, width_px, 6), np.float32)
    rays[..., :3] = -turn @ outside[:3, 3]
    rays[..., 3:] = np.stack([x, y, np.ones_like(x)], axis=-1) @ to_world.T
    return rays


def _rays_by_view(fov_deg, center, eye, up, width_px, height_px):
    wanted = "an angle between 0 and 180 degrees"
    if not isinstance(fov_deg, (int, float, np.number)):
        raise TypeError(f"fov_deg: expected {wanted}, found {shown(fov_deg)}")
    if not 0 < fov_deg < 180:
        raise ValueError(f"fov_deg: expected {wanted}, found {shown(fov_deg)}")
    for name, side in (("width_px", width_px), ("height_px", height_px)):
        whole_number(side, name, 1, "a number of pixels above 0")
    center, eye, up = (_matrix(v, name, (3,))
                       for v, name in ((center, "center"), (eye, "eye"), (up, "up")))
    ahead = center - eye
    across = np.cross(up, ahead)
    if not np.linalg.norm(across) > 0:
        raise ValueError("center, eye, up: expected eye apart from center, up not along the view")
    ahead, across = ahead / np.linalg.norm(ahead), across / np.linalg.norm(across)
    focal = 0.5 * width_px / np.tan(np.radians(0.5 * fov_deg))
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = [across, np.cross(ahead, across), ahead]
    extrinsic[:3, 3] = -extrinsic[:3, :3] @ eye
    intrinsic = [[focal, 0, 0.5 * width_px], [0, focal, 0.5 * height_px], [0, 0, 1]]
    return _rays_by_matrix(intrinsic, extrinsic, width_px, height_px)
