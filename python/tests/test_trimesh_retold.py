"""What trimesh's tests of rays ask, in own words, of grelha.trimesh; and meshes that change."""
import collections
import copy
import dataclasses
import pickle
import sys
import time
import unittest
import warnings
from types import ModuleType, SimpleNamespace
from unittest import mock

import numpy as np

import grelha.trimesh
from grelha.trimesh import ProximityQuery, RayMeshIntersector
from meshes import CUBE, CUBE_FACES, ball, distance_to_triangles

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


class Tracked(np.ndarray):
    """As trimesh.caching.TrackedArray: a hash that is kept until the array is written to."""

    hashed = 0  # how often

    def __array_finalize__(self, base):
        self.kept = None
        if isinstance(base, Tracked):
            base.kept = None

    @property
    def mutable(self):
        return self.flags["WRITEABLE"]

    def __setitem__(self, *given):
        self.kept = None
        super().__setitem__(*given)

    def __imul__(self, other):
        self.kept = None
        return super().__imul__(other)

    def __hash__(self):
        if self.kept is None:
            Tracked.hashed += 1
            self.kept = hash(self.tobytes())
        return self.kept


class Trimesh:
    """As trimesh.Trimesh: its ray is made before a primitive has vertices, and by copies."""

    def __init__(self, vertices=None, faces=None):
        self.data = {}
        if vertices is not None:
            self.vertices, self.faces = vertices, faces
        modules = sys.modules
        self.ray = modules["trimesh.ray.ray_triangle"].RayMeshIntersector(self)
        self.nearest = modules["trimesh.proximity"].ProximityQuery(self)

    @property
    def vertices(self):
        return self.data.get("vertices", np.empty((0, 3)))

    @vertices.setter
    def vertices(self, values):
        self.data["vertices"] = np.array(values, np.float64).view(Tracked)

    @property
    def faces(self):
        return self.data.get("faces", np.empty((0, 3)))

    @faces.setter
    def faces(self, values):
        self.data["faces"] = np.array(values, np.int64).view(Tracked)

    def copy(self):
        copied = Trimesh()
        copied.data = copy.deepcopy(self.data)
        return copied


class Box(Trimesh):
    """As trimesh.primitives.Box."""

    def __init__(self, extents):
        super().__init__()
        self.extents = extents

    @property
    def vertices(self):
        return BOX * self.extents

    @property
    def faces(self):
        return CUBE_FACES


class Theirs:
    def __init__(self, mesh):
        self.mesh = mesh


class Installed(unittest.TestCase):
    """install() in a stand-in for trimesh."""

    LINE = np.array([[0.1, 0.2, -9]]), np.array([[0, 0, 1.0]])

    def setUp(self):
        names = "trimesh", "trimesh.ray", "trimesh.ray.ray_triangle", "trimesh.proximity"
        modules = {name: ModuleType(name) for name in names}
        modules["trimesh.ray.ray_triangle"].RayMeshIntersector = Theirs
        for name in ("ProximityQuery", "closest_point", "signed_distance"):
            setattr(modules["trimesh.proximity"], name, Theirs)
        patch = mock.patch.dict(sys.modules, modules)
        patch.start()
        self.addCleanup(patch.stop)
        self.addCleanup(grelha.trimesh.uninstall)
        grelha.trimesh.install()

    def test_meshes_copies_and_primitives(self):
        for mesh in (Trimesh(BOX, CUBE_FACES), Trimesh(BOX, CUBE_FACES).copy(), Box([1, 1, 1])):
            self.assertIsInstance(mesh.ray, RayMeshIntersector)
            self.assertEqual(mesh.ray.intersects_location(*self.LINE)[0][:, 2].tolist(),
                             [-0.5, 0.5])
            self.assertEqual(mesh.nearest.signed_distance([[0, 0, 0.25]]).tolist(), [0.25])
        self.assertEqual(Trimesh().ray.intersects_first(*self.LINE).tolist(), [-1])

    def test_options_by_place_are_those_of_ray_triangle(self):
        tri, ray, where = Trimesh(BOX, CUBE_FACES).ray.intersects_id(*self.LINE, True, False)
        self.assertEqual((len(tri), len(ray), where.tolist()), (1, 1, [[0.1, 0.2, -0.5]]))

    def test_taken_out_again(self):
        grelha.trimesh.install()
        grelha.trimesh.uninstall()
        mesh = Trimesh(BOX, CUBE_FACES)
        self.assertEqual({type(mesh.ray), type(mesh.nearest)}, {Theirs})
        self.assertIs(sys.modules["trimesh.proximity"].closest_point, Theirs)
        grelha.trimesh.uninstall()

    def test_written_to(self):
        mesh = Trimesh(BOX, CUBE_FACES)
        self.assertEqual(mesh.ray.intersects_location(*self.LINE)[0][0, 2], -0.5)
        mesh.vertices *= 2
        self.assertEqual(mesh.ray.intersects_location(*self.LINE)[0][0, 2], -1)
        mesh.vertices[:, 2] = BOX[:, 2] * 8
        hash(mesh.vertices)  # by someone else: clean, and yet another
        self.assertEqual(mesh.ray.intersects_location(*self.LINE)[0][0, 2], -4)
        mesh.faces[:] = 0
        self.assertEqual(mesh.ray.intersects_first(*self.LINE).tolist(), [-1])
        mesh.data = Trimesh(BOX * 6, CUBE_FACES).data
        self.assertEqual(mesh.nearest.vertex([[9, 9, 9]])[1].tolist(), [7])
        self.assertEqual(mesh.nearest.on_surface([[0, 0, 9]])[1].tolist(), [6])

    def test_one_ray_costs_no_look_at_the_mesh(self):
        vertices, faces = ball(133)
        mesh = Trimesh(vertices, faces)
        mesh.ray.intersects_any(*self.LINE)
        before = Tracked.hashed
        for ask in (mesh.ray.intersects_any, mesh.ray.intersects_first,
                    mesh.ray.intersects_location):
            start = time.process_time()
            with mock.patch.object(grelha.trimesh, "_same", side_effect=AssertionError):
                for _ in range(2000):
                    ask(*self.LINE)
            spent = (time.process_time() - start) / 2000 * 1e6
            print(f"{ask.__name__}: {spent:.1f} us a ray, {len(faces)} faces")
        self.assertEqual(Tracked.hashed, before)

    def test_module_functions(self):
        mesh = Trimesh(BOX, CUBE_FACES)
        points = [[0, 0, 2.0], [0.1, 0, 0.2]]
        places = sys.modules["trimesh.proximity"]
        np.testing.assert_allclose(places.closest_point(mesh, points)[0],
                                   [[0, 0, 0.5], [0.1, 0, 0.5]])
        np.testing.assert_allclose(places.signed_distance(mesh, points), [-1.5, 0.3])


class Nearest(unittest.TestCase):
    def test_of_points_everywhere(self):
        vertices, faces = ball(9)
        far = np.array([4e5, -1e5, 3e5]) + 0.3
        points = np.random.default_rng(1).uniform(-1.5, 1.5, (500, 3))
        for offset in (0, far):
            mesh = mesh_of(vertices + offset, faces)
            query = ProximityQuery(mesh)
            distance, where = distance_to_triangles(mesh.vertices, faces, points + offset)
            found = query.on_surface(points + offset)
            self.assertEqual([a.dtype.str for a in found], ["<f8", "<f8", "<i8"])
            np.testing.assert_allclose(found[1], distance, atol=1e-7 if np.any(offset) else 1e-9)
            np.testing.assert_allclose(found[0], where, atol=1e-7)
            inside = np.linalg.norm(points, axis=1) < 1 - 0.05
            signed = query.signed_distance(points + offset)
            self.assertTrue((signed[inside] > 0).all())
            np.testing.assert_array_equal(np.abs(signed), found[1])
            to_vertices = np.linalg.norm((points + offset)[:, None] - mesh.vertices, axis=-1)
            nearest, index = query.vertex(points + offset)
            np.testing.assert_array_equal(index, to_vertices.argmin(1))
            np.testing.assert_allclose(nearest, to_vertices.min(1), rtol=1e-12)

    def test_triangles_at_an_edge_face_the_point(self):
        """So the triangle's normal tells the sign, as programs for trimesh compute it."""
        vertices, faces = ball(5)
        vertices *= np.float32([1, 1, 0.05])  # a disc with sharp edges
        mesh = mesh_of(vertices, faces)
        middles = (vertices[faces[:, 0]] + vertices[faces[:, 1]]) / 2
        points = np.concatenate([vertices, middles]) * np.float64([1.5, 1.3, 4])
        query = ProximityQuery(mesh)
        closest, distance, face = query.on_surface(points)
        away = points - closest
        a, b, c = mesh.vertices[mesh.faces].swapaxes(0, 1)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        self.assertTrue(((normal[face] * away).sum(1) > 0).all())
        touch = np.abs(mesh.vertices[mesh.faces][None] - closest[:, None, None]).max(-1) < 1e-12
        at, around = np.nonzero(touch.any(-1))  # vertices: no other triangle faces the point more
        score = (normal[around] * away[at]).sum(1)
        self.assertGreater(len(at), 100)
        self.assertTrue((score <= (normal[face[at]] * away[at]).sum(1) + 1e-12).all())
        thin = ProximityQuery(mesh_of([[-9, 0, 0], [9, 0, 0], [0.1, 1e-3, -1e-3], [0, -9, -9]],
                                      [[0, 1, 2], [1, 0, 3]]))  # an apex beside the long edge
        self.assertEqual(thin.on_surface([[0.1, -1e-3, 2], [0.1, -1, 1.5]])[2].tolist(), [1, 1])

    def test_signs_on_the_surface(self):
        query = ProximityQuery(mesh_of(BOX, CUBE_FACES))
        self.assertEqual(np.signbit(query.signed_distance(BOX)).tolist(), [False] * 8)

    def test_nothing_and_nowhere(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            query = ProximityQuery(mesh_of(np.zeros((0, 3)), np.zeros((0, 3), int)))
            closest, distance, face = query.on_surface([[1, 2, 3]])
            self.assertEqual((distance.tolist(), face.tolist()), ([np.inf], [-1]))
            self.assertEqual(query.vertex([[1, 2, 3]])[1].tolist(), [-1])
            query = ProximityQuery(mesh_of(BOX, CUBE_FACES))
            closest, distance, face = query.on_surface([[np.nan, 0, 0], [0, 0, 1]])
            self.assertEqual((face[0], distance[1]), (-1, 0.5))
            self.assertEqual(distance[0], np.inf)


if __name__ == "__main__":
    unittest.main()
