"""Meshes and reference answers for the tests: slow, plain numpy in float64."""
import numpy as np

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
CUBE_FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                       [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def ball(rings=12):
    """A closed sphere of triangles of radius 1, seen from outside counter-clockwise."""
    around = 2 * rings
    down, along = np.meshgrid(np.linspace(0, np.pi, rings + 1)[1:-1],
                              np.arange(around) * 2 * np.pi / around, indexing="ij")
    vertices = np.stack([np.sin(down) * np.cos(along), np.sin(down) * np.sin(along),
                         np.cos(down)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rings - 2), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    sides = np.concatenate([np.stack([a, a + around, b], -1).reshape(-1, 3),
                            np.stack([b, a + around, b + around], -1).reshape(-1, 3)])
    top, last, j = len(vertices), (rings - 2) * around, np.arange(around)
    caps = np.concatenate([np.stack([j * 0 + top, j, (j + 1) % around], -1),
                           np.stack([j * 0 + top + 1, last + (j + 1) % around, last + j], -1)])
    vertices = np.concatenate([vertices, [[0, 0, 1], [0, 0, -1]]])
    return vertices.astype(np.float32), np.concatenate([sides, caps])


def soup(count, seed):
    """Loose triangles."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform(-1, 1, (count, 1, 3))
    vertices = (middle + rng.normal(size=(count, 3, 3)) * 0.2).reshape(-1, 3).astype(np.float32)
    return vertices, np.arange(3 * count).reshape(-1, 3)


def rays(count, seed, spread=2.0):
    """Rays that start around the origin and pass near it."""
    rng = np.random.default_rng(seed)
    origins = (rng.normal(size=(count, 3)) * spread).astype(np.float32)
    directions = (rng.normal(size=(count, 3)) * 0.5 - origins).astype(np.float32)
    return origins, directions


def every_hit(vertices, faces, origins, directions):
    """t, u, v of each ray and triangle, (rays, triangles), after Möller and Trumbore; inf: none.

    The fourth array is True where rounding may decide: near an edge or seen from its side.
    """
    a, b, c = (vertices[faces[:, k]].astype(np.float64) for k in range(3))
    o, d = origins.astype(np.float64)[:, None], directions.astype(np.float64)[:, None]
    to_b, to_c = b - a, c - a
    p = np.cross(d, to_c)
    det = (to_b * p).sum(-1)
    s = o - a
    q = np.cross(s, to_b)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, t = (s * p).sum(-1) / det, (d * q).sum(-1) / det, (to_c * q).sum(-1) / det
    inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (det != 0)
    near = np.minimum(np.minimum(np.abs(u), np.abs(v)), np.abs(1 - u - v)) < 1e-6
    return np.where(inside, t, np.inf), u, v, near & (t > 0)


def distance_to_triangles(vertices, faces, points):
    """The distance of each point to the nearest triangle, (points,), and that point, (..., 3)."""
    best = np.full(len(points), np.inf)
    where = np.zeros((len(points), 3))
    for corners in vertices[faces].astype(np.float64):
        for found in _candidates(corners, points.astype(np.float64)):
            distance = np.linalg.norm(points - found, axis=-1)
            nearer = distance < best
            best[nearer], where[nearer] = distance[nearer], found[nearer]
    return best, where


def _candidates(corners, points):
    """The feet on the triangle's edges, and on its face where that is inside."""
    for k in range(3):
        p, side = corners[k], corners[(k + 1) % 3] - corners[k]
        along = np.clip((points - p) @ side / (side @ side), 0, 1)
        yield p + along[:, None] * side
    a, to_b, to_c = corners[0], corners[1] - corners[0], corners[2] - corners[0]
    normal = np.cross(to_b, to_c)
    s = points - a
    u = np.cross(s, to_c) @ normal / (normal @ normal)
    v = np.cross(to_b, s) @ normal / (normal @ normal)
    inside = (u >= 0) & (v >= 0) & (u + v <= 1)
    foot = a + u[:, None] * to_b + v[:, None] * to_c
    yield np.where(inside[:, None], foot, np.inf)
