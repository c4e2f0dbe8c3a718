"""Worlds: doubles and their offset, spheres, points, updates."""
import unittest

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball, distance_to_triangles, rays, soup

FAR = np.array([4_512_345.25, -731_000.5, 1_204.125])


class Doubles(unittest.TestCase):
    def test_far_mesh_answers_as_near(self):
        vertices, faces = ball()
        origins, directions = rays(3000, 1)
        near = grelha.World(vertices, faces)
        # float64 near the origin: the same floats, no offset
        self.assertEqual(grelha.World(vertices.astype(np.float64), faces).offset.tolist(), [0] * 3)
        far = grelha.World(vertices + FAR, faces)
        self.assertTrue((np.abs(far.offset - FAR) < 2).all())
        expected, found = near.closest(origins, directions), far.closest(origins + FAR, directions)
        same = expected.id == found.id
        self.assertGreater(same.mean(), 0.999)
        np.testing.assert_allclose(found.t[same], expected.t[same], rtol=1e-5, atol=2e-6)
        points = (vertices * 1.25)[:500].astype(np.float64)
        at = far.closest_points(points + FAR)
        self.assertEqual(at.points.dtype, np.float64)
        np.testing.assert_allclose(at.points - FAR, near.closest_points(points).points, atol=1e-6)
        self.assertEqual(far.contains([FAR, FAR + 2]).tolist(), [True, False])
        self.assertAlmostEqual(far.signed_distance(FAR + [0, 0, 3]), 2, 5)

    def test_rays_keep_their_digits_where_floats_hold_the_mesh(self):
        shift = np.array([5_000_000.5, 0.125, -3_000_000.25])  # all corners are floats
        hit = grelha.World(CUBE + shift, CUBE_FACES).closest(shift + [0.3, 0.6, 4], (0, 0, -1))
        near = grelha.World(CUBE, CUBE_FACES).closest((0.3, 0.6, 4), (0, 0, -1))
        self.assertEqual((hit.t, hit.id), (near.t, near.id))
        self.assertAlmostEqual(hit.u, near.u, 6)

    def test_float32_rays_of_far_world(self):
        far = grelha.World(CUBE + FAR, CUBE_FACES)
        hit = far.closest((FAR + [0.5, 0.5, 100]).astype(np.float32), (0, 0, -1))
        self.assertAlmostEqual(hit.t, 99, 3)

    def test_offset_lies_on_a_grid_of_a_power_of_two(self):
        world = grelha.World(CUBE * 0.3 + FAR, CUBE_FACES)
        for x in world.offset:
            self.assertEqual(x, np.round(x * 2) / 2)
        np.testing.assert_allclose(world.vertices, CUBE * 0.3 + FAR, atol=1e-7)
        self.assertEqual(world.vertices.dtype, np.float64)

    def test_float32_stays(self):
        world = grelha.World(CUBE, CUBE_FACES)
        self.assertEqual(world.vertices.dtype, np.float32)
        np.testing.assert_array_equal(world.vertices, CUBE)
        np.testing.assert_array_equal(world.faces, CUBE_FACES)
        self.assertEqual(world.closest_points(CUBE + 1).points.dtype, np.float32)


class Meshes(unittest.TestCase):
    def test_layouts(self):
        expected = grelha.World(CUBE, CUBE_FACES).closest(*rays(1000, 2)).t
        wide = np.concatenate([CUBE, CUBE], axis=1)
        for vertices in (CUBE.astype(np.float64), np.asfortranarray(CUBE), wide[:, 3:],
                         CUBE.astype(np.int16), CUBE.astype(np.float16), CUBE.tolist()):
            for dtype in (np.int64, np.int32, np.uint32, np.uint8):
                world = grelha.World(vertices, np.asfortranarray(CUBE_FACES.astype(dtype)))
                np.testing.assert_array_equal(world.closest(*rays(1000, 2)).t, expected)

    def test_arrays_may_go(self):
        vertices = CUBE.copy()
        world = grelha.World(vertices, CUBE_FACES.copy())
        vertices[:] = 99
        del vertices
        self.assertEqual(world.closest((0.5, 0.25, 9), (0, 0, -1)).t, 8)

    def test_empty(self):
        for world in (grelha.World(np.zeros((0, 3)), np.zeros((0, 3), int)),
                      grelha.World(CUBE, np.zeros((0, 3), int)),
                      grelha.World.spheres(np.zeros((0, 3)), 1)):
            self.assertEqual(world.closest((0, 0, 0), (0, 0, 1)).id, -1)
            self.assertFalse(world.contains((0, 0, 0)))
            self.assertEqual(world.signed_distance((0, 0, 0)), np.inf)
            self.assertEqual(world.closest_points((1, 2, 3)).id, -1)

    def test_unused_vertices_may_be_anything(self):
        vertices = np.concatenate([CUBE, [[np.nan, np.inf, 1e30]]]).astype(np.float32)
        self.assertEqual(grelha.World(vertices, CUBE_FACES).closest((0.5, 0.2, 9), (0, 0, -1)).t, 8)

    def test_update(self):
        world = grelha.World(CUBE, CUBE_FACES)
        world.update(CUBE * 2)
        self.assertEqual(world.closest((0.5, 0.25, 9), (0, 0, -1)).t, 7)
        world.update(CUBE + FAR)
        self.assertEqual(world.closest(FAR + (0.5, 0.25, 9), (0, 0, -1)).t, 8)
        with self.assertRaisesRegex(ValueError, r"vertices: .*\(8, 3\), found \(7, 3\)"):
            world.update(CUBE[:7])
        self.assertEqual(world.closest(FAR + (0.5, 0.25, 9), (0, 0, -1)).t, 8)

    def test_spheres(self):
        centers = np.array([[0, 0, 0], [5, 0, 0]], np.float32)
        world = grelha.World.spheres(centers, [1, 2])
        hits = world.closest(np.float32([[0, 0, 9], [5, 0, 9], [9, 9, 9]]), np.float32([0, 0, -1]))
        self.assertEqual(hits.t.tolist(), [8, 7, np.inf])
        self.assertEqual(hits.id.tolist(), [0, 1, -1])
        self.assertEqual(hits.face.tolist(), [-1, -1, -1])
        self.assertEqual(world.count_hits((0, 0, 9), (0, 0, -1)), 2)
        self.assertEqual(grelha.World.spheres(centers, 1).closest((5, 0, 9), (0, 0, -1)).t, 8)

    def test_inside_of_spheres(self):
        world = grelha.World.spheres([[0, 0, 0], [0.5, 0, 0]], 1)
        points = [[0, 0, 0.5], [0.2, 0, 0], [-0.9, 0, 0], [0, 0, 3]]
        self.assertEqual(world.contains(points).tolist(), [True, True, True, False])
        self.assertEqual((world.signed_distance(points) < 0).tolist(), [True, True, True, False])

    def test_update_of_spheres(self):
        centers = np.array([[0, 0, 0], [5, 0, 0]], np.float32)
        world = grelha.World.spheres(centers, [1, 2])
        world.update(centers + [0, 0, 1])
        down = np.float32([[0, 0, 9], [5, 0, 9]]), np.float32([0, 0, -1])
        self.assertEqual(world.closest(*down).t.tolist(), [7, 6])
        world.update(centers, 3)
        self.assertEqual(world.closest(*down).t.tolist(), [6, 6])
        world.update(centers, [3, 4])
        self.assertEqual(world.closest(*down).t.tolist(), [6, 5])
        for bad in ((centers[:1],), (centers, [1, 2, 3]), (centers, -1)):
            with self.assertRaises(ValueError):
                world.update(*bad)
        self.assertEqual(world.closest(*down).t.tolist(), [6, 5])
        with self.assertRaisesRegex(ValueError, "radii"):
            grelha.World(CUBE, CUBE_FACES).update(CUBE, 1)


class Points(unittest.TestCase):
    def test_closest_points_of_soup(self):
        vertices, faces = soup(60, 3)
        points = np.random.default_rng(4).uniform(-2, 2, (300, 3)).astype(np.float32)
        distance, where = distance_to_triangles(vertices, faces, points)
        found = grelha.World(vertices, faces).closest_points(points)
        np.testing.assert_allclose(found.distance, distance, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(found.points, where, atol=1e-4)
        self.assertEqual([x.dtype for x in found], [np.float32, np.float32, np.int64])

    def test_radius(self):
        world = grelha.World(CUBE, CUBE_FACES)
        found = world.closest_points(np.float32([[0.5, 0.5, 2], [0.5, 0.5, 4]]), radius=1)
        self.assertEqual(found.distance.tolist(), [1, np.inf])
        self.assertEqual(found.id[1], -1)
        self.assertEqual(found.points[1].tolist(), [0.5, 0.5, 4])
        one = world.closest_points((0.5, 0.5, 2))
        self.assertEqual((one.points.shape, type(one.distance), type(one.id)), ((3,), float, int))

    def test_inside_of_ball(self):
        vertices, faces = ball(16)
        points = np.random.default_rng(5).uniform(-1.2, 1.2, (2000, 3)).astype(np.float32)
        world = grelha.World(vertices, faces)
        inside = world.contains(points)
        self.assertEqual((inside.dtype, inside.shape), (np.dtype(bool), (2000,)))
        radius = np.linalg.norm(points, axis=1)
        self.assertTrue(inside[radius < 0.97].all())
        self.assertFalse(inside[radius > 1].any())
        distance = world.signed_distance(points)
        self.assertEqual(distance.dtype, np.float32)
        np.testing.assert_array_equal(distance < 0, inside)
        np.testing.assert_array_equal(np.abs(distance), world.closest_points(points).distance)
        np.testing.assert_allclose(distance, radius - 1, atol=0.03)
        grid = points.reshape(20, 100, 3)
        np.testing.assert_array_equal(world.contains(grid).ravel(), inside)
        np.testing.assert_array_equal(world.contains(grid.astype(np.float64)).ravel(), inside)


if __name__ == "__main__":
    unittest.main()
