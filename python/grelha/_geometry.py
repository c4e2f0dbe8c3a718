"""Points on triangles, in double: what the two borrowed interfaces tell of a hit."""
import numpy as np

_YZX, _ZXY = [1, 2, 0], [2, 0, 1]


def array_of(given, name):
    """Any array; tensors give theirs by .numpy(). The masks of masked arrays would be lost."""
    if hasattr(given, "numpy") and not isinstance(given, np.ndarray):
        for step in ("detach", "cpu"):  # of torch from its graph, and from other devices
            given = getattr(given, step, lambda given=given: given)()
        given = given.numpy()
    if isinstance(given, np.ma.MaskedArray):
        raise TypeError(f"{name}: expected numbers, found a masked array; its mask would be lost: "
                        "fill it first")
    try:
        return np.asarray(given)
    except ValueError:  # rows of unequal length
        return np.asarray(None)


def shown(given):
    """What a message says of a wrong argument: a number as it is, of others the type."""
    return repr(given) if isinstance(given, (int, float, np.number)) else type(given).__name__


def flag(given, name):
    """True or False, 1 or 0. Raises TypeError for others: "no" would count as True."""
    if isinstance(given, (bool, np.bool_, int, np.integer)) and given in (0, 1):
        return bool(given)
    raise TypeError(f"{name}: expected True or False, found {shown(given)}")


def whole_number(given, name, least, wanted):
    """A whole number as an int. Raises TypeError or ValueError: expected `wanted`."""
    if isinstance(given, (np.ndarray, bool)) or not hasattr(type(given), "__index__"):
        raise TypeError(f"{name}: expected {wanted}, found {shown(given)}")
    if given.__index__() < least:
        raise ValueError(f"{name}: expected {wanted}, found {shown(given)}")
    return given.__index__()


def numbers(given, name, last):
    """An array of numbers of shape (..., last)."""
    array = array_of(given, name)
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
    """Where rays cross the planes of triangles near t, (n, 3) float64: by t in double."""
    if not len(t):
        return np.zeros((0, 3))
    origins, directions, t = (a.astype(np.float64, copy=False) for a in (origins, directions, t))
    a, to_b, to_c = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = to_b[:, _YZX] * to_c[:, _ZXY] - to_b[:, _ZXY] * to_c[:, _YZX]  # np.cross is slow
    along, to_plane = _dot(normal, directions), _dot(normal, a - origins)
    with np.errstate(all="ignore"):
        exact = to_plane / along
        near = np.abs(exact - t) <= 1e-4 * np.abs(t)
    return origins + np.where(near, exact, t)[:, None] * directions


def barycentric(points, corners):
    """u and v of points on triangles, (n, 2): (1 - u - v) a + u b + v c. At least 0, at most 1.

    Of triangles without area, or with next to none, u and v are those on an edge.
    """
    to_b, to_c = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(to_b, to_c)
    area = _dot(across, across)
    to_point = points - corners[:, 0]
    uv = np.stack([_dot(np.cross(to_point, to_c), across), _dot(np.cross(to_b, to_point), across)],
                  axis=-1)
    uv = np.divide(uv, area[:, None], out=np.zeros_like(uv), where=area[:, None] > 0)
    uv = np.clip(uv, 0, 1)
    uv = uv / np.maximum(uv.sum(axis=-1, keepdims=True), 1)
    error = _length(_off(uv, points, corners))
    size = np.abs(corners).max(axis=(1, 2), initial=0)
    bad = np.flatnonzero(~(error <= 1e-7 * size))
    uv[bad] = _on_edges(points[bad], corners[bad], uv[bad])
    return uv


def _dot(a, b):
    return np.einsum("...j,...j->...", a, b)


def _length(a):
    return np.sqrt(_dot(a, a))


def _off(uv, points, corners):
    """From points to those that u and v give back."""
    u, v = uv[..., :1], uv[..., 1:]
    a, b, c = corners[..., 0, :], corners[..., 1, :], corners[..., 2, :]
    return (1 - u - v) * a + u * b + v * c - points


def _on_edges(points, corners, uv):
    """u and v, of those given and of the nearest points of the edges: whose point is nearest."""
    ends = np.array([[0, 0], [1, 0], [0, 1]], np.float64)
    candidates = [uv]
    for k, n in ((0, 1), (1, 2), (2, 0)):
        along = corners[:, n] - corners[:, k]
        square = _dot(along, along)
        share = np.divide(_dot(points - corners[:, k], along), square, out=np.zeros_like(square),
                          where=square > 0)
        share = np.clip(share, 0, 1)[:, None]
        candidates.append((1 - share) * ends[k] + share * ends[n])
    candidates = np.array(candidates)
    errors = _length(_off(candidates, points, corners))
    return candidates[np.argmin(errors, axis=0), np.arange(len(points))]
