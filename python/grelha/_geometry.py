"""Points on triangles, in double: what the two borrowed interfaces tell of a hit."""
import numpy as np


def numbers(given, name, last):
    """An array of numbers of shape (..., last); tensors give theirs by .numpy()."""
    if hasattr(given, "numpy"):
        given = given.numpy()
    try:
        array = np.asarray(given)
    except ValueError:  # rows of unequal length
        array = np.asarray(None)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: expected numbers of shape (..., {last}), "
                        f"found {type(given).__name__}")
    if array.ndim < 1 or array.shape[-1] != last:
        raise ValueError(f"{name}: expected shape (..., {last}), found {array.shape}")
    return array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)


def normals(corners):
    """Unit normals of triangles (n, 3, 3), (n, 3); 0 where a triangle has no area."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    return np.divide(across, length, out=np.zeros_like(across), where=length > 0)


def points_along(origins, directions, t, corners):
    """Where rays cross the planes of triangles near t, (n, 3): by t in double."""
    normal = normals(corners)
    along = np.einsum("ij,ij->i", normal, directions)
    to_plane = np.einsum("ij,ij->i", normal, corners[:, 0] - origins)
    with np.errstate(divide="ignore", invalid="ignore"):
        exact = to_plane / along
        near = np.abs(exact - t) <= 1e-4 * np.abs(t)
    return origins + np.where(near, exact, t)[:, None] * directions


def barycentric(points, corners):
    """u and v of points on triangles, (n, 2): (1 - u - v) a + u b + v c. At least 0, at most 1."""
    to_b, to_c = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(to_b, to_c)
    area = np.einsum("ij,ij->i", across, across)
    to_point = points - corners[:, 0]
    u = np.einsum("ij,ij->i", np.cross(to_point, to_c), across)
    v = np.einsum("ij,ij->i", np.cross(to_b, to_point), across)
    uv = np.stack([u, v], axis=-1)
    uv = np.divide(uv, area[:, None], out=np.zeros_like(uv), where=area[:, None] > 0)
    uv = np.clip(uv, 0, 1)
    return uv / np.maximum(uv.sum(axis=-1, keepdims=True), 1)


def first_of_equal(ray, t, part):
    """True for each hit that is not at the same t of the same ray and part as the one before it."""
    new = np.ones(len(t), bool)
    new[1:] = (ray[1:] != ray[:-1]) | (t[1:] != t[:-1]) | (part[1:] != part[:-1])
    return new
