"""The interfaces of Open3D and trimesh, call by call, by their documentation."""
import unittest

import numpy as np

import grelha
from grelha.open3d import RaycastingScene
from grelha.trimesh import RayMeshIntersector
from meshes import CUBE, CUBE_FACES, ball, every_hit, rays

F4, U4, I4, I8, F8 = (np.dtype(t) for t in ("f4", "u4", "i4", "i8", "f8"))
NO_ID = RaycastingScene.INVALID_ID


class Tensor:
    """As Open3D's: an array behind .numpy()."""

    def __init__(self, array):
        self.array = array

    def numpy(self):
        return self.array


class Open3D(unittest.TestCase):
    def setUp(self):
        self.scene = RaycastingScene()
        self.vertices, self.faces = ball(10)
        self.assertEqual(self.scene.add_triangles(CUBE, CUBE_FACES.astype(np.uint32)), 0)
        self.assertEqual(self.scene.add_triangles(self.vertices + np.float32([5, 0, 0]),
                                                  self.faces), 1)
        origins, directions = rays(1200, 1)
        self.rays = np.concatenate([origins, directions], axis=1)
        self.rays[600:, 0] += 5
        self.all = np.concatenate([CUBE, self.vertices + np.float32([5, 0, 0])])
        self.all_faces = np.concatenate([CUBE_FACES, self.faces + len(CUBE)])

    def described(self, answer, shape, **kinds):
        self.assertEqual(set(answer), set(kinds))
        for name, (dtype, more) in kinds.items():
            self.assertEqual((answer[name].dtype, answer[name].shape), (dtype, shape + more), name)

    def test_cast_rays(self):
        for shape in ((1200,), (30, 40), (2, 3, 200)):
            answer = self.scene.cast_rays(self.rays.reshape(*shape, 6))
            self.described(answer, shape, t_hit=(F4, ()), geometry_ids=(U4, ()),
                           primitive_ids=(U4, ()), primitive_uvs=(F4, (2,)),
                           primitive_normals=(F4, (3,)))
        answer = self.scene.cast_rays(self.rays)
        world = grelha.World(self.all, self.all_faces)
        hits = world.closest(self.rays[:, :3], self.rays[:, 3:])
        np.testing.assert_array_equal(answer["t_hit"], hits.t)
        hit = hits.face >= 0
        mesh, face = answer["geometry_ids"], answer["primitive_ids"]
        self.assertEqual(set(mesh), {0, 1, NO_ID})
        np.testing.assert_array_equal(mesh == NO_ID, ~hit)
        np.testing.assert_array_equal(face == NO_ID, ~hit)
        np.testing.assert_array_equal((face + np.where(mesh == 1, len(CUBE_FACES), 0))[hit],
                                      hits.face[hit])
        a, b, c = (self.all[self.all_faces[hits.face[hit], k]].astype(float) for k in range(3))
        uv = answer["primitive_uvs"][hit]
        where = (1 - uv.sum(1))[:, None] * a + uv[:, :1] * b + uv[:, 1:] * c
        ends = self.rays[hit, :3] + hits.t[hit, None] * self.rays[hit, 3:]
        np.testing.assert_allclose(where, ends, atol=2e-5)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        np.testing.assert_allclose(answer["primitive_normals"][hit], normal, atol=1e-6)
        self.assertFalse(answer["primitive_normals"][~hit].any())
        self.assertFalse(answer["primitive_uvs"][~hit].any())
        self.assertTrue(np.isinf(answer["t_hit"][~hit]).all())

    def test_documented_example(self):
        cube = RaycastingScene()
        self.assertEqual(cube.add_triangles(CUBE, CUBE_FACES), 0)
        answer = cube.cast_rays([[0.5, 0.5, 10, 0, 0, -1], [-1, -1, -1, 0, 0, -1]])
        self.assertEqual(answer["t_hit"].tolist(), [9, np.inf])
        self.assertEqual(answer["geometry_ids"].tolist(), [0, NO_ID])
        self.assertEqual(answer["primitive_normals"].tolist(), [[0, 0, 1], [0, 0, 0]])

    def test_occlusions(self):
        t = self.scene.cast_rays(self.rays)["t_hit"]
        found = self.scene.test_occlusions(self.rays.reshape(30, 40, 6))
        self.assertEqual((found.dtype, found.shape), (np.dtype(bool), (30, 40)))
        np.testing.assert_array_equal(found.ravel(), np.isfinite(t))
        np.testing.assert_array_equal(self.scene.test_occlusions(self.rays, 0, 0.5), t < 0.5)
        late = self.scene.test_occlusions(self.rays, tnear=1.5)
        np.testing.assert_array_equal(late, self.scene.test_occlusions(
            np.concatenate([self.rays[:, :3] + 1.5 * self.rays[:, 3:], self.rays[:, 3:]], 1)))

    def test_counts_and_lists(self):
        counts = self.scene.count_intersections(self.rays.reshape(30, 40, 6))
        self.assertEqual((counts.dtype, counts.shape), (I4, (30, 40)))
        t, _, _, near = every_hit(self.all, self.all_faces, self.rays[:, :3], self.rays[:, 3:])
        sure = ~near.any(axis=1)
        np.testing.assert_array_equal(counts.ravel()[sure], np.isfinite(t).sum(axis=1)[sure])
        lists = self.scene.list_intersections(self.rays.reshape(30, 40, 6))
        n = counts.sum()
        self.assertEqual(lists["ray_splits"].shape, (1201,))
        self.assertEqual(lists["ray_splits"].dtype, U4)
        del lists["ray_splits"]
        self.described(lists, (n,), ray_ids=(U4, ()), t_hit=(F4, ()), geometry_ids=(U4, ()),
                       primitive_ids=(U4, ()), primitive_uvs=(F4, (2,)))
        splits = self.scene.list_intersections(self.rays)["ray_splits"]
        np.testing.assert_array_equal(np.diff(splits.astype(int)), counts.ravel())
        np.testing.assert_array_equal(np.repeat(np.arange(1200), counts.ravel()), lists["ray_ids"])
        face = lists["primitive_ids"] + np.where(lists["geometry_ids"] == 1, len(CUBE_FACES), 0)
        a, b, c = (self.all[self.all_faces[face, k]].astype(float) for k in range(3))
        u, v = lists["primitive_uvs"].T[..., None]
        ray = self.rays[lists["ray_ids"]]
        np.testing.assert_allclose((1 - u - v) * a + u * b + v * c,
                                   ray[:, :3] + lists["t_hit"][:, None] * ray[:, 3:], atol=2e-5)

    def test_edges_count_once(self):
        diagonal = [[0.5, 0.5, 10, 0, 0, -1], [0.25, 0.25, 10, 0, 0, -1], [0.1, 0.2, 9, 0, 0, -1]]
        self.assertEqual(self.scene.count_intersections(diagonal).tolist(), [2, 2, 2])

    def test_points(self):
        points = np.random.default_rng(2).uniform(-2, 7, (4, 50, 3)).astype(np.float32)
        answer = self.scene.compute_closest_points(points)
        self.described(answer, (4, 50), points=(F4, (3,)), geometry_ids=(U4, ()),
                       primitive_ids=(U4, ()), primitive_uvs=(F4, (2,)),
                       primitive_normals=(F4, (3,)))
        face = answer["primitive_ids"] + np.where(answer["geometry_ids"] == 1, len(CUBE_FACES), 0)
        a, b, c = (self.all[self.all_faces[face, k]].astype(float) for k in range(3))
        u, v = answer["primitive_uvs"][..., :1], answer["primitive_uvs"][..., 1:]
        np.testing.assert_allclose((1 - u - v) * a + u * b + v * c, answer["points"], atol=1e-5)
        for name in ("compute_distance", "compute_signed_distance", "compute_occupancy"):
            found = getattr(self.scene, name)(points)
            self.assertEqual((found.dtype, found.shape), (F4, (4, 50)), name)
        distance = self.scene.compute_distance(points)
        np.testing.assert_allclose(distance, np.linalg.norm(points - answer["points"], axis=-1),
                                   rtol=1e-5)
        inside = self.scene.compute_occupancy(points, nsamples=3)
        self.assertEqual(set(inside.ravel()), {0, 1})
        in_cube = ((points > 0) & (points < 1)).all(-1)
        np.testing.assert_array_equal(inside[in_cube], 1)
        np.testing.assert_array_equal(self.scene.compute_signed_distance(points),
                                      np.where(inside == 1, -distance, distance))

    def test_pinholes(self):
        eye, center, up = np.array([1.0, -3, 2]), np.array([0.5, 0, 0.25]), np.array([0, 0, 1.0])
        found = RaycastingScene.create_rays_pinhole(
            fov_deg=60, center=center, eye=eye, up=up, width_px=40, height_px=30)
        self.assertEqual((found.dtype, found.shape), (F4, (30, 40, 6)))
        np.testing.assert_array_equal(found[..., :3], np.broadcast_to(np.float32(eye), (30, 40, 3)))
        ahead = (center - eye) / np.linalg.norm(center - eye)
        middle = found[14:16, 19:21, 3:].mean((0, 1))
        np.testing.assert_allclose(middle / np.linalg.norm(middle), ahead, atol=1e-6)
        sides = found[:, :, 3:]
        edge = 1.5 * sides[15, [0, -1]] - 0.5 * sides[15, [1, -2]]  # the picture's sides
        edge = edge - (edge @ up)[:, None] * up * 0
        x = edge / (edge @ ahead)[:, None] - ahead
        self.assertAlmostEqual(np.linalg.norm(x[0] - x[1]), 2 * np.tan(np.radians(30)) * 41 / 40, 1)
        self.assertGreater(sides[-1, 20] @ up, sides[0, 20] @ up)  # as in Open3D
        matrix, outside = np.array([[40, 0, 20], [0, 50, 15], [0, 0, 1.0]]), np.eye(4)
        outside[:3, 3] = 1, 2, 3
        found = RaycastingScene.create_rays_pinhole(matrix, outside, 40, 30)
        self.assertEqual(found[0, 0, :3].tolist(), [-1, -2, -3])
        np.testing.assert_allclose(found[7, 9, 3:], [(9.5 - 20) / 40, (7.5 - 15) / 50, 1],
                                   atol=1e-6)

    def test_tensors_and_meshes(self):
        class Mesh:
            vertex = {"positions": Tensor(CUBE)}
            triangle = {"indices": Tensor(CUBE_FACES)}

        scene = RaycastingScene(nthreads=1)
        self.assertEqual(scene.add_triangles(Mesh()), 0)
        self.assertEqual(scene.cast_rays(Tensor(np.float32([[0.5, 0.2, 9, 0, 0, -1]])))["t_hit"], 8)
        legacy = type("Legacy", (), {"vertices": CUBE + 3, "triangles": CUBE_FACES})
        self.assertEqual(scene.add_triangles(legacy()), 1)
        self.assertEqual(scene.cast_rays([[3.5, 3.2, 9, 0, 0, -1]])["geometry_ids"].tolist(), [1])

    def test_empty_scene(self):
        scene = RaycastingScene()
        self.assertEqual(scene.cast_rays(self.rays)["geometry_ids"].tolist(), [NO_ID] * 1200)
        self.assertEqual(scene.list_intersections(self.rays)["t_hit"].shape, (0,))
        self.assertEqual(scene.compute_distance([[0, 0, 0]]).tolist(), [np.inf])
        self.assertEqual(scene.compute_closest_points([[1, 2, 3]])["geometry_ids"].tolist(),
                         [NO_ID])


class Mesh:
    def __init__(self, vertices, faces):
        self.vertices, self.faces = np.array(vertices, np.float64), np.array(faces)


class Trimesh(unittest.TestCase):
    def setUp(self):
        self.mesh = Mesh(*ball(10))
        self.ray = RayMeshIntersector(self.mesh)
        origins, directions = rays(1000, 5)
        self.origins, self.directions = origins.astype(np.float64), directions.astype(np.float64)
        self.t, _, _, near = every_hit(self.mesh.vertices, self.mesh.faces, origins, directions)
        self.sure = ~near.any(axis=1)

    def test_intersects_id(self):
        tri, ray = self.ray.intersects_id(self.origins, self.directions)
        self.assertEqual((tri.dtype, ray.dtype, tri.shape), (I8, I8, ray.shape))
        expected = np.argwhere(np.isfinite(self.t))
        self.assertEqual(set(zip(ray[self.sure[ray]], tri[self.sure[ray]])),
                         {(r, f) for r, f in expected if self.sure[r]})
        tri, ray, where = self.ray.intersects_id(self.origins, self.directions,
                                                 return_locations=True, multiple_hits=False)
        self.assertEqual((where.dtype, where.shape), (F8, (len(ray), 3)))
        self.assertEqual(len(set(ray)), len(ray))
        np.testing.assert_array_equal(tri[self.sure[ray]], self.t.argmin(1)[ray[self.sure[ray]]])
        once = self.ray.intersects_id(self.origins, self.directions, max_hits=1)
        np.testing.assert_array_equal(once[0], tri)
        np.testing.assert_array_equal(once[1], ray)

    def test_intersects_location(self):
        where, ray, tri = self.ray.intersects_location(self.origins, self.directions)
        self.assertEqual((where.dtype, ray.dtype, tri.dtype), (F8, I8, I8))
        sure = self.sure[ray]
        t = self.t[ray[sure], tri[sure]]
        np.testing.assert_allclose(where[sure], self.origins[ray[sure]]
                                   + t[:, None] * self.directions[ray[sure]], atol=1e-9)
        first = self.ray.intersects_location(self.origins, self.directions, multiple_hits=False)
        self.assertEqual(len(first[1]), len(set(ray)))

    def test_edges_are_one_location(self):
        ray = RayMeshIntersector(Mesh(CUBE, CUBE_FACES))
        where, index, _ = ray.intersects_location([[0.5, 0.5, 9]] * 2, [[0, 0, -4]] * 2)
        self.assertEqual(where.tolist(), [[0.5, 0.5, 1], [0.5, 0.5, 0]] * 2)
        self.assertEqual(index.tolist(), [0, 0, 1, 1])
        self.assertEqual(len(ray.intersects_id([[0.5, 0.5, 9]], [[0, 0, -4]])[0]), 2)
        second = ray.intersects_id([[0.5, 0.5, 9]] * 2, [[0, 0, -4]] * 2, max_hits=1,
                                   return_locations=True)
        self.assertEqual(second[1].tolist(), [0, 1])

    def test_first_any_contains(self):
        first = self.ray.intersects_first(self.origins, self.directions)
        self.assertEqual((first.dtype, first.shape), (I8, (1000,)))
        hit = np.isfinite(self.t).any(axis=1)
        np.testing.assert_array_equal(first[self.sure],
                                      np.where(hit, self.t.argmin(1), -1)[self.sure])
        found = self.ray.intersects_any(self.origins, self.directions)
        self.assertEqual((found.dtype, found.shape), (np.dtype(bool), (1000,)))
        np.testing.assert_array_equal(found, first >= 0)
        inside = self.ray.contains_points(self.origins * 0.5)
        radius = np.linalg.norm(self.origins * 0.5, axis=1)
        self.assertEqual(inside.dtype, np.dtype(bool))
        self.assertTrue(inside[radius < 0.94].all() and not inside[radius > 1].any())

    def test_nothing_hit(self):
        away = np.tile([0, 0, 1.0], (3, 1))
        where, ray, tri = self.ray.intersects_location(away * 9, away)
        self.assertEqual((where.shape, ray.shape, tri.shape), ((0, 3), (0,), (0,)))
        self.assertEqual(self.ray.intersects_first(away * 9, away).tolist(), [-1] * 3)

    def test_changed_mesh(self):
        down = [[0, 0, 9.0]], [[0.01, 0.02, -1.0]]
        before = self.ray.intersects_location(*down)[0]
        self.mesh.vertices = self.mesh.vertices * 2
        after = self.ray.intersects_location(*down)[0]
        self.assertAlmostEqual(before[0, 2], 1, 1)
        self.assertAlmostEqual(after[0, 2], 2, 1)

    def test_far_mesh(self):
        far = np.array([4e6, 5e6, -3e6]) + 0.1
        ray = RayMeshIntersector(Mesh(self.mesh.vertices + far, self.mesh.faces))
        where, _, _ = ray.intersects_location(self.origins + far, self.directions)
        self.assertTrue((np.linalg.norm(where - far, axis=1) <= 1 + 1e-7).all())


if __name__ == "__main__":
    unittest.main()
