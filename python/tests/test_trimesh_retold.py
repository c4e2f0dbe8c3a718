"""What trimesh's tests of rays ask, in own words, of grelha.trimesh; and meshes that change."""
import collections
import dataclasses
import pickle
import unittest
from types import SimpleNamespace

import numpy as np

from grelha.trimesh import RayMeshIntersector
from meshes import CUBE, CUBE_FACES, ball

BOX = CUBE.astype(np.float64) - 0.5  # around the origin


def mesh_of(vertices, faces):
    return SimpleNamespace(vertices=np.array(vertices, np.float64), faces=np.array(faces))


class Tests(unittest.TestCase):
    def setUp(self):
        self.box = RayMeshIntersector(mesh_of(BOX, CUBE_FACES))
        self.ball = RayMeshIntersector(mesh_of(*ball(20)))

    def test_arrays_come_back_also_of_nothing(self):
        random = np.random.default_rng(1).random((100, 3))
        for ray_directions, hits in (([0, 0, 1], True), ([0, 1, 0], False)):
            origins = random.copy()
            origins[:, 2] = -5
            along = np.tile(ray_directions, (100, 1))
            for found in (self.ball.intersects_id(origins, along),
                          self.ball.intersects_location(origins, along)):
                self.assertTrue(all(isinstance(part, np.ndarray) for part in found))
                self.assertEqual(len(found[0]) > 0, hits)

    def test_contains(self):
        self.assertTrue(self.box.contains_points(BOX / 1.5).all())
        self.assertFalse(self.box.contains_points(BOX * 1.5).any())
        far = np.random.default_rng(2).random((30, 3)) * 100 + 1.5
        self.assertFalse(self.box.contains_points(far).any())
        self.assertTrue(self.box.contains_points([[0, 0, 0]]).all())

    def test_rays_at_vertices(self):
        origins = np.zeros_like(BOX)
        self.assertTrue(self.box.intersects_any(ray_origins=origins, ray_directions=BOX).all())
        _, ray, _ = self.box.intersects_location(ray_origins=origins, ray_directions=BOX)
        np.testing.assert_array_equal(np.bincount(ray, minlength=8), 1)

    def test_points_near_edges(self):
        points = [[0.5, 0, -3], [0.5 - 1e-7, 0, -0.4], [0, -1e-6, 0], [0, 0, -0.49]]
        self.assertEqual(self.box.contains_points(points).tolist(), [False, True, True, True])

    def test_first_and_all(self):
        """A picture of a box from the front: the first hits are of its front alone."""
        x, y = np.meshgrid(np.arange(-128, 128, 2.0), np.arange(-128, 128, 2.0))
        along = np.stack([x, y, np.full_like(x, 1000)], -1).reshape(-1, 3)
        origins = np.tile([0, 0, -7.5], (len(along), 1))
        for first in (self.box.intersects_id(origins, along, multiple_hits=False),
                      self.box.intersects_id(origins, along, False)):
            self.assertEqual(len(np.unique(first[0])), 2)
        both = self.box.intersects_id(ray_origins=origins, ray_directions=along, multiple_hits=True)
        self.assertGreater(len(np.unique(both[0])), 2)
        where, ray, _ = self.box.intersects_location(origins, along, False)
        np.testing.assert_allclose(where[:, 2], -0.5)
        self.assertEqual(len(set(ray)), len(ray))

    def test_box_from_below(self):
        axis = np.linspace(-0.52, 0.52, 50)
        x, y = np.meshgrid(axis, axis)
        origins = np.stack([x, y, np.full_like(x, -100)], -1).reshape(-1, 3)
        where, ray, tri = self.box.intersects_location(origins, np.tile([0, 0, 1.0], (2500, 1)))
        self.assertEqual(len(where), 2 * (np.abs(origins[:, :2]) < 0.5).all(1).sum())
        np.testing.assert_allclose(where[:, :2], origins[ray, :2])
        np.testing.assert_allclose(np.abs(where[:, 2]), 0.5)
        self.assertTrue(((tri >= 0) & (tri < 12)).all())

    def test_no_hit_twice_in_a_huge_box(self):
        huge = RayMeshIntersector(mesh_of(BOX * 10000, CUBE_FACES))
        tri, _ = huge.intersects_id([[0.1, 0.2, 0]], [[0, 0, -1.0]], multiple_hits=True)
        self.assertEqual(len(tri), 1)

    def test_a_ray_that_starts_on_a_face_does_not_hit_it(self):
        tri, _ = self.box.intersects_id([[0.1, 0.2, 0.5]], [[0, 0, -1.0]])
        self.assertEqual(len(tri), 1)

    def test_most_hits(self):
        origins, along = [[0.1, 0.2, -9]] * 3, [[0, 0, 1.0]] * 3
        _, ray, where = self.box.intersects_id(origins, along, True, 1, True)
        self.assertEqual(ray.tolist(), [0, 1, 2])
        np.testing.assert_allclose(where[:, 2], -0.5)

    def test_pickles(self):
        again = pickle.loads(pickle.dumps(self.box))
        self.assertEqual(again.intersects_first([[0.1, 0.2, -9]], [[0, 0, 1.0]]).shape, (1,))


class Crossings(unittest.TestCase):
    def test_far_thin_wall(self):
        wall = BOX * [0.009765625, 2, 2]
        ray = RayMeshIntersector(mesh_of(wall, CUBE_FACES))
        line = [[-1e6, 0.1, 0.3]], [[1.0, 0, 0]]
        where, _, _ = ray.intersects_location(*line)
        np.testing.assert_allclose(where[:, 0], [-0.0048828125, 0.0048828125])
        self.assertEqual(len(ray.intersects_id(*line)[0]), 2)


Named = collections.namedtuple("Named", "vertices faces")


@dataclasses.dataclass(frozen=True)
class Frozen:
    vertices: np.ndarray
    faces: np.ndarray


@dataclasses.dataclass
class Data:
    vertices: np.ndarray
    faces: np.ndarray


class ById:
    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces

    def __hash__(self):
        return id(self)


class Computed:
    """Vertices that are made anew each time."""

    def __init__(self, vertices, faces):
        self.local, self.faces, self.scale = vertices, faces, 1

    @property
    def vertices(self):
        return self.local * self.scale


class Changes(unittest.TestCase):
    LINE = [[0.1, 0.2, -9]], [[0, 0, 1.0]]

    def height(self, ray):
        where = ray.intersects_location(*self.LINE)[0]
        return where[0, 2] if len(where) else None

    def test_kinds_of_meshes(self):
        for kind in (Named, Frozen, Data, ById, Computed):
            with self.subTest(kind.__name__):
                ray = RayMeshIntersector(kind(BOX.copy(), CUBE_FACES.copy()))
                self.assertAlmostEqual(self.height(ray), -0.5)
        lists = SimpleNamespace(vertices=BOX.tolist(), faces=CUBE_FACES.tolist())
        self.assertAlmostEqual(self.height(RayMeshIntersector(lists)), -0.5)
        tuples = SimpleNamespace(vertices=tuple(map(tuple, BOX)), faces=np.uint32(CUBE_FACES))
        self.assertAlmostEqual(self.height(RayMeshIntersector(tuples)), -0.5)

    def test_in_place(self):
        for kind in (Named, Frozen, Data, ById):
            with self.subTest(kind.__name__):
                mesh = kind(BOX.copy(), CUBE_FACES.copy())
                ray = RayMeshIntersector(mesh)
                mesh.vertices[:] *= 2
                self.assertAlmostEqual(self.height(ray), -1)
                mesh.vertices[:, 2] += 0.25
                self.assertAlmostEqual(self.height(ray), -0.75)
                mesh.faces[:] = 0
                self.assertIsNone(self.height(ray))

    def test_other_arrays(self):
        for kind in (Data, ById):
            mesh = kind(BOX, CUBE_FACES)
            ray = RayMeshIntersector(mesh)
            mesh.vertices = BOX * 4
            self.assertAlmostEqual(self.height(ray), -2)
            mesh.faces = CUBE_FACES[:0]
            self.assertIsNone(self.height(ray))

    def test_computed(self):
        mesh = Computed(BOX, CUBE_FACES)
        ray = RayMeshIntersector(mesh)
        mesh.scale = 6
        self.assertAlmostEqual(self.height(ray), -3)

    def test_lists(self):
        mesh = SimpleNamespace(vertices=BOX.tolist(), faces=CUBE_FACES.tolist())
        ray = RayMeshIntersector(mesh)
        for vertex in mesh.vertices:
            vertex[2] *= 2
        self.assertAlmostEqual(self.height(ray), -1)

    def test_every_question_sees_a_change(self):
        mesh = mesh_of(BOX, CUBE_FACES)
        ray = RayMeshIntersector(mesh)
        for ask in (lambda: ray.intersects_any(*self.LINE)[0],
                    lambda: ray.intersects_first(*self.LINE)[0] >= 0,
                    lambda: len(ray.intersects_id(*self.LINE)[0]) > 0,
                    lambda: ray.contains_points([[0, 0, 0]])[0]):
            self.assertTrue(ask())
            mesh.vertices += 100
            self.assertFalse(ask())
            mesh.vertices -= 100

    def test_what_becomes_wrong_raises_until_it_is_right(self):
        mesh = mesh_of(BOX, CUBE_FACES)
        ray = RayMeshIntersector(mesh)
        mesh.vertices[3, 1] = np.nan
        for _ in range(2):
            with self.assertRaisesRegex(ValueError, "vertices"):
                self.height(ray)
        mesh.vertices[:] = BOX
        self.assertAlmostEqual(self.height(ray), -0.5)

    def test_nothing(self):
        ray = RayMeshIntersector(mesh_of(np.zeros((0, 3)), np.zeros((0, 3), int)))
        self.assertEqual(ray.intersects_first(*self.LINE).tolist(), [-1])
        self.assertEqual(ray.intersects_location(*self.LINE)[0].shape, (0, 3))


if __name__ == "__main__":
    unittest.main()
