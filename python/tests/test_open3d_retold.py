"""What Open3D's tests of RaycastingScene and its tutorials ask, in own words, of grelha.open3d."""
import importlib
import importlib.util
import pickle
import sys
import unittest
from types import SimpleNamespace
from unittest import mock

import numpy as np

from grelha.open3d import RaycastingScene
from meshes import CUBE, CUBE_FACES, ball

CORNER = np.float32([[0, 0, 0], [1, 0, 0], [1, 1, 0]])
ONE = np.uint32([[0, 1, 2]])
HIT_AND_MISS = np.float32([[0.2, 0.1, 1, 0, 0, -1], [10, 10, 10, 1, 0, 0]])
THROUGH_CUBE = np.float32([[0.5, 0.5, -1, 0, 0, 1], [0.5, 0.5, 0.5, 0, 0, 1],
                           [10, 10, 10, 1, 0, 0]])


class Tensor:
    """As those of Open3D: numbers behind .numpy(), on a device."""

    def __init__(self, numbers):
        self.numbers = np.asarray(numbers)

    def numpy(self):
        return self.numbers


class FarTensor(Tensor):
    """On another device, and in a graph: .numpy() alone is refused."""

    def __init__(self, numbers, is_near=False, is_free=False):
        super().__init__(numbers)
        self.is_near, self.is_free = is_near, is_free

    def detach(self):
        return FarTensor(self.numbers, self.is_near, True)

    def cpu(self):
        return FarTensor(self.numbers, True, self.is_free)

    def numpy(self):
        if not (self.is_near and self.is_free):
            raise TypeError("can't convert")
        return self.numbers


class OwnTensor(Tensor):
    """As Open3D's own, which are made from arrays and refuse to mix with them."""

    @staticmethod
    def from_numpy(array):
        assert type(array) is np.ndarray and array.flags.c_contiguous
        return OwnTensor(array)


def scene_of(*meshes):
    scene = RaycastingScene()
    for mesh in meshes:
        scene.add_triangles(*(Tensor(part) for part in mesh))
    return scene


class Tests(unittest.TestCase):
    """The library's own tests."""

    def test_one_triangle(self):
        scene = RaycastingScene()
        mesh = scene.add_triangles(Tensor(CORNER), Tensor(ONE))
        answer = scene.cast_rays(Tensor(HIT_AND_MISS))
        self.assertTrue(mesh == answer["geometry_ids"][0].cpu())
        self.assertAlmostEqual(answer["t_hit"][0].item(), 1)
        self.assertTrue(RaycastingScene.INVALID_ID == answer["geometry_ids"][1].cpu())
        self.assertTrue(np.isinf(answer["t_hit"][1].item()))

    def test_occlusions(self):
        scene = scene_of((CORNER, ONE))
        answer = scene.test_occlusions(Tensor(HIT_AND_MISS)).cpu()
        self.assertTrue(answer[0] == True)  # noqa: E712 as users write it
        self.assertTrue(answer[1] == False)  # noqa: E712
        self.assertFalse(scene.test_occlusions(Tensor(HIT_AND_MISS), tfar=0.5).cpu().any())
        self.assertFalse(scene.test_occlusions(Tensor(HIT_AND_MISS), tnear=1.5).cpu().any())

    def test_many_at_once(self):
        """Batches are no longer than memory."""
        scene, cube = scene_of((CORNER, ONE)), scene_of((CUBE, CUBE_FACES))
        random = np.random.RandomState(123).rand(300000, 6).astype(np.float32)
        rays = Tensor(random)
        self.assertEqual(scene.cast_rays(rays)["t_hit"].shape, (300000,))
        self.assertEqual(scene.test_occlusions(rays).shape, (300000,))
        counts = cube.count_intersections(rays)
        self.assertEqual(int(counts.sum()), len(cube.list_intersections(rays)["t_hit"]))
        self.assertTrue((counts.numpy() == 1).all())  # all start inside
        points = scene.compute_closest_points(Tensor(random[:, :3]))["points"].numpy()
        self.assertTrue((points[:, 2] == 0).all())

    def test_passages_of_a_box(self):
        scene = scene_of((CUBE, CUBE_FACES.astype(np.uint32)))
        found = scene.count_intersections(Tensor(THROUGH_CUBE)).cpu().numpy()
        np.testing.assert_array_equal(found, [2, 1, 0])
        found = scene.list_intersections(Tensor(THROUGH_CUBE))
        np.testing.assert_allclose(found["t_hit"].cpu().numpy(), [1, 2, 0.5])
        np.testing.assert_array_equal(found["ray_splits"].numpy(), [0, 2, 3, 3])
        np.testing.assert_array_equal(found["ray_ids"].numpy(), [0, 0, 1])

    def test_points(self):
        scene = scene_of((CORNER, ONE))
        answer = scene.compute_closest_points(Tensor(np.float32([[0.2, 0.1, 1], [10, 10, 10]])))
        self.assertTrue((0 == answer["geometry_ids"]).all())
        self.assertTrue((0 == answer["primitive_ids"]).all())
        np.testing.assert_allclose(answer["points"].numpy(), [[0.2, 0.1, 0], [1, 1, 0]], atol=1e-6)

    def test_distances_of_a_box(self):
        scene = scene_of((CUBE, CUBE_FACES))
        points = Tensor(np.float32([[0.5, 0.5, 0.5], [-0.5, -0.5, -0.5], [0, 0, 0]]))
        far = np.sqrt(0.75)
        np.testing.assert_allclose(scene.compute_distance(points).numpy(), [0.5, far, 0], rtol=1e-6)
        np.testing.assert_allclose(np.abs(scene.compute_signed_distance(points).numpy()),
                                   [0.5, far, 0], rtol=1e-6)
        self.assertLess(scene.compute_signed_distance(points)[0].item(), 0)
        np.testing.assert_array_equal(scene.compute_occupancy(points).numpy()[:2], [1, 0])

    def test_shapes(self):
        scene = scene_of((CORNER, ONE))
        last = {"primitive_uvs": [2], "primitive_normals": [3], "points": [3]}
        for shape in ([11], [1, 2, 3], [32, 14]):
            rays, points = np.random.rand(*shape, 6), np.random.rand(*shape, 3)
            for found in (scene.count_intersections(rays), scene.compute_distance(points),
                          scene.compute_signed_distance(points), scene.compute_occupancy(points)):
                self.assertEqual(list(found.shape), shape)
            for answer in (scene.cast_rays(rays), scene.compute_closest_points(points)):
                for name, found in answer.items():
                    self.assertEqual(list(found.shape), shape + last.get(name, []), name)
            passages = int(np.sum(scene.count_intersections(rays).numpy()))
            for name, found in scene.list_intersections(rays).items():
                rows = np.prod(shape) + 1 if name == "ray_splits" else passages
                self.assertEqual(list(found.shape), [rows] + last.get(name, []), name)

    def test_lattice_in_a_ball(self):
        """Rays from points of a lattice meet vertices and edges; inside is inside all the same."""
        vertices, faces = ball(20)
        scene = scene_of((0.8 * vertices, faces))
        axis = np.linspace(-0.88, 0.88, 6)
        points = np.stack(np.meshgrid(axis, axis, axis), axis=-1).astype(np.float32)
        inside = np.linalg.norm(points, axis=-1) < 0.78
        for samples in (1, 3, 11):
            np.testing.assert_array_equal(scene.compute_occupancy(points, nsamples=samples).numpy(),
                                          inside)


class Tutorials(unittest.TestCase):
    """What programs do with the answers; they have not imported open3d."""

    def setUp(self):
        patch = mock.patch.dict(sys.modules, open3d=None)
        patch.start()
        self.addCleanup(patch.stop)

    def test_picture(self):
        scene = scene_of((CUBE, CUBE_FACES), (CUBE + 2, CUBE_FACES))
        rays = scene.create_rays_pinhole(fov_deg=60, center=[0.5, 0.5, 0.5], eye=[-1, -1, -1],
                                         up=[0, 0, 1], width_px=32, height_px=24)
        self.assertIs(type(rays.numpy()), np.ndarray)
        answer = scene.cast_rays(rays)
        for found in answer.values():
            self.assertIs(type(found.numpy()), np.ndarray)
            self.assertIs(type(found[0].numpy()), np.ndarray)
        hit = answer["t_hit"].isfinite()
        self.assertTrue(hit.any() and not hit.numpy().all())
        points = rays[hit][:, :3] + rays[hit][:, 3:] * answer["t_hit"][hit].reshape((-1, 1))
        self.assertLess(np.abs(points.numpy().clip(0, 1) - points.numpy()).max(), 1e-5)
        self.assertEqual(np.abs(answer["primitive_normals"].numpy()).max(), 1)
        self.assertTrue((answer["t_hit"].isinf() == (answer["geometry_ids"]
                                                     == scene.INVALID_ID)).all())

    def test_passages_by_uv(self):
        vertices, faces = ball(12)
        scene = scene_of((vertices, faces))
        rays = scene.create_rays_pinhole(np.float64([[40, 0, 20], [0, 40, 15], [0, 0, 1]]),
                                         Tensor(np.eye(4) + np.eye(4, k=3) * 0), 40, 30)
        rays[..., :3] = [0, 0, -3]
        found = {name: part.numpy() for name, part in scene.list_intersections(rays).items()}
        corners = vertices[faces[found["primitive_ids"]]]
        uv = found["primitive_uvs"]
        points = (np.c_[1 - uv.sum(1), uv][..., None] * corners).sum(1)
        along = rays.reshape((-1, 6)).numpy()[found["ray_ids"]]
        np.testing.assert_allclose(points, along[:, :3] + found["t_hit"][:, None] * along[:, 3:],
                                   atol=1e-5)

    def test_one_point(self):
        scene = scene_of((CUBE, CUBE_FACES))
        point = Tensor(np.float32([[10, 10, 10]]))
        answer = scene.compute_closest_points(point)
        self.assertEqual(answer["points"][0].numpy().tolist(), [1, 1, 1])
        self.assertIn(answer["primitive_ids"][0].item(), range(12))
        self.assertEqual({answer["geometry_ids"][0]: "cube"}[0], "cube")
        self.assertEqual(f"{scene.compute_distance(point)[0]:.3f}", "15.588")

    def test_tensors_of_other_devices(self):
        scene = RaycastingScene()
        scene.add_triangles(FarTensor(CUBE), FarTensor(CUBE_FACES))
        self.assertEqual(scene.count_intersections(FarTensor(THROUGH_CUBE)).tolist(), [2, 1, 0])

    def test_answers_are_arrays(self):
        t = scene_of((CUBE, CUBE_FACES)).cast_rays(THROUGH_CUBE)["t_hit"]
        self.assertEqual((t.clone().cpu() + 1).numpy().tolist(), [2, 1.5, np.inf])
        self.assertEqual(t.to("float64").dtype, np.float64)
        self.assertEqual(t.to(np.float64).dtype, np.float64)
        self.assertEqual(t.to("CPU:0").dtype, np.float32)
        self.assertEqual(t.num_elements(), 3)
        self.assertFalse(t.isnan().any())
        self.assertEqual(pickle.loads(pickle.dumps(t)).numpy().tolist(), t.tolist())
        self.assertEqual(t[1].contiguous().shape, ())
        with self.assertRaises(TypeError):
            hash(t)

    def test_arrays_given_may_change(self):
        """The scene has what was added; as in Open3D a moved mesh is added to a new scene."""
        vertices, faces = CUBE.copy(), CUBE_FACES.copy()
        scene = scene_of((vertices, faces))
        vertices += 5
        faces[:] = 0
        self.assertEqual(scene.cast_rays(THROUGH_CUBE)["t_hit"][0], 1)


class Tensors(unittest.TestCase):
    """Answers to tensors of Open3D are such tensors, of the same numbers."""

    def test_every_answer(self):
        scene = scene_of((CUBE, CUBE_FACES))
        points = np.float32([[0.5, 0.5, 0.25], [9, 9, 9]])
        for method, given in (("cast_rays", THROUGH_CUBE), ("test_occlusions", THROUGH_CUBE),
                              ("count_intersections", THROUGH_CUBE),
                              ("list_intersections", THROUGH_CUBE),
                              ("compute_closest_points", points), ("compute_distance", points),
                              ("compute_signed_distance", points), ("compute_occupancy", points)):
            found, plain = (getattr(scene, method)(a) for a in (OwnTensor(given), given))
            if not isinstance(found, dict):
                found, plain = {method: found}, {method: plain}
            self.assertEqual(set(found), set(plain))
            for name, part in found.items():
                self.assertIs(type(part), OwnTensor, name)
                self.assertEqual(part.numpy().dtype, plain[name].dtype)
                np.testing.assert_array_equal(part.numpy(), plain[name])

    def test_rays_where_open3d_is_imported(self):
        view = 60, [0, 0, 0], [0, 0, -3], [0, 1, 0], 4, 3
        open3d = SimpleNamespace(core=SimpleNamespace(Tensor=OwnTensor))
        for module, kind in ((open3d, OwnTensor), (SimpleNamespace(), np.ndarray)):
            with mock.patch.dict(sys.modules, open3d=module):
                rays = RaycastingScene.create_rays_pinhole(*view)
            self.assertIsInstance(rays, kind)
            self.assertEqual(rays.numpy().shape, (3, 4, 6))

    @unittest.skipUnless(importlib.util.find_spec("open3d"), "open3d is not installed")
    def test_the_tutorial(self):
        open3d = importlib.import_module("open3d")
        scene = RaycastingScene()
        scene.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(
            open3d.geometry.TriangleMesh.create_box()))
        rays = scene.create_rays_pinhole(fov_deg=60, center=[0.5, 0.5, 0.5], eye=[-1, -1, -1],
                                         up=[0, 0, 1], width_px=32, height_px=24)
        ans = scene.cast_rays(rays)
        hit = ans["t_hit"].isfinite()
        points = rays[hit][:, :3] + rays[hit][:, 3:] * ans["t_hit"][hit].reshape((-1, 1))
        cloud = open3d.t.geometry.PointCloud(points)
        found = cloud.to_legacy().points
        self.assertGreater(len(found), 100)
        self.assertLess(np.abs(np.clip(found, 0, 1) - found).max(), 1e-6)
        nothing = scene.list_intersections(rays.reshape((-1, 6))[:0])
        self.assertEqual(list(nothing["t_hit"].shape), [0])


class Crossings(unittest.TestCase):
    def test_far_thin_wall(self):
        """Both sides round to the same t."""
        wall = np.float64(CUBE) * [0.009765625, 2, 2] - [0.0048828125, 1, 1]
        scene = scene_of((wall, CUBE_FACES))
        rays = np.float64([[-1e6, 0.1, 0.3, 1, 0, 0]])
        self.assertEqual(scene.count_intersections(rays).tolist(), [2])
        found = scene.list_intersections(rays)
        self.assertEqual(found["t_hit"].tolist(), [1e6, 1e6])


class Degenerate(unittest.TestCase):
    def test_uv_give_the_point_back(self):
        """Of triangles that are segments, points or slivers."""
        vertices = np.float32([[0, 0, 0], [4, 0, 0], [2, 0, 0], [0, 5, 0], [1, 5, 0], [0, 6, 0],
                               [9, 9, 9], [4, 1e-30, 0], [7, -3, 1], [7, 3, 1], [7, 1, 1 + 1e-6]])
        faces = np.array([[0, 1, 2], [3, 4, 5], [6, 6, 6], [0, 0, 1], [2, 0, 1], [1, 2, 0],
                          [0, 1, 7], [8, 9, 10], [10, 8, 9], [1, 0, 0]])
        points = np.random.default_rng(1).uniform(-2, 10, (200, 3)).astype(np.float32)
        for row in faces:
            answer = scene_of((vertices, [row])).compute_closest_points(points)
            u, v = answer["primitive_uvs"].numpy().astype(np.float64).T[..., None]
            a, b, c = vertices[row].astype(np.float64)
            np.testing.assert_allclose((1 - u - v) * a + u * b + v * c, answer["points"].numpy(),
                                       atol=2e-6)
            self.assertTrue(np.isfinite(answer["primitive_normals"]).all())


if __name__ == "__main__":
    unittest.main()
