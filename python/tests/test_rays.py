"""Closest hits, occlusion and all hits, against every triangle in float64."""
import unittest
import warnings

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball, every_hit, rays, soup


class Closest(unittest.TestCase):
    def check(self, vertices, faces, origins, directions):
        world = grelha.World(vertices, faces)
        hits = world.closest(origins, directions)
        t, u, v, near = every_hit(vertices, faces, origins, directions)
        sure = ~near.any(axis=1)
        best = t.argmin(axis=1)
        row = np.arange(len(t))
        found = np.isfinite(t[row, best])
        np.testing.assert_array_equal((hits.id >= 0)[sure], found[sure])
        both = sure & found
        self.assertGreater(both.sum(), len(t) // 4)
        np.testing.assert_array_equal(hits.id[both], best[both])
        np.testing.assert_array_equal(hits.face, hits.id)
        np.testing.assert_allclose(hits.t[both], t[row, best][both], rtol=1e-6)
        np.testing.assert_allclose(hits.u[both], u[row, best][both], atol=1e-5)
        np.testing.assert_allclose(hits.v[both], v[row, best][both], atol=1e-5)
        self.assertTrue(np.isinf(hits.t[hits.id < 0]).all())
        np.testing.assert_array_equal(world.occluded(origins, directions), hits.id >= 0)
        return world, t, sure

    def test_ball(self):
        self.check(*ball(), *rays(2000, 1))

    def test_soup(self):
        self.check(*soup(500, 2), *rays(2000, 3))

    def test_all_hits_of_soup(self):
        vertices, faces = soup(300, 4)
        origins, directions = rays(1000, 5)
        world, t, sure = self.check(vertices, faces, origins, directions)
        lists = world.all_hits(origins, directions)
        counts = np.isfinite(t).sum(axis=1)
        np.testing.assert_array_equal(np.diff(lists.offsets)[sure], counts[sure])
        np.testing.assert_array_equal(world.count_hits(origins, directions),
                                      np.diff(lists.offsets))
        for i in np.flatnonzero(sure):
            mine = slice(lists.offsets[i], lists.offsets[i + 1])
            order = np.argsort(t[i])[:counts[i]]
            np.testing.assert_array_equal(lists.id[mine], order)
            np.testing.assert_allclose(lists.t[mine], t[i][order], rtol=1e-6)

    def test_limits_and_skip(self):
        world = grelha.World(CUBE, CUBE_FACES)
        origins, directions = np.full((5, 3), (0.3, 0.6, 4.0)), np.full((5, 3), (0, 0, -1.0))
        low, high = np.array([0, 3.5, 0, 0, 5]), np.array([np.inf, np.inf, 2, 3.5, np.inf])
        hits = world.closest(origins, directions, low, high)
        np.testing.assert_array_equal(hits.t, np.float32([3, 4, np.inf, 3, np.inf]))
        np.testing.assert_array_equal(world.occluded(origins, directions, low, high),
                                      [True, True, False, True, False])
        np.testing.assert_array_equal(world.count_hits(origins, directions, low, high),
                                      [2, 1, 0, 1, 0])
        np.testing.assert_array_equal(world.closest(origins, directions, low).t,
                                      np.float32([3, 4, 3, 3, np.inf]))
        np.testing.assert_array_equal(world.closest(origins, directions, 3.5, high).t,
                                      np.float32([4, 4, np.inf, np.inf, 4]))
        first = int(hits.id[0])
        self.assertEqual(world.closest(origins[0], directions[0], skip=first).t, 4)
        skips = np.array([first, -1, -1, first, -1])
        np.testing.assert_array_equal(world.closest(origins, directions, skip=skips).t,
                                      np.float32([4, 3, 3, 4, 3]))
        np.testing.assert_array_equal(world.occluded(origins, directions, 0, 3.5, skip=first),
                                      [False] * 5)

    def test_answers_of_some_rays(self):
        world = grelha.World(CUBE, CUBE_FACES)
        hits = world.closest(*rays(300, 3))
        met = hits.id >= 0
        some, three = hits[met], hits[[5, 1, 5]]
        self.assertIsInstance(some, grelha.Hits)
        self.assertTrue(np.isfinite(some.t).all() and 0 < len(some.t) < 300)
        np.testing.assert_array_equal(some.u, hits.u[met])
        np.testing.assert_array_equal(three.id, hits.id[[5, 1, 5]])
        self.assertIs(hits[1], hits.id)
        self.assertEqual(len(hits[:2]), 2)
        self.assertEqual(len(world.closest_points(CUBE)[np.arange(3)].points), 3)

    def test_points_of_hits(self):
        world = grelha.World(CUBE, CUBE_FACES)
        origins, directions = rays(300, 3)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            hits = world.closest(origins, directions)
            points = hits.points(origins, directions)
            met = hits.id >= 0
            self.assertEqual((points.dtype, points.shape), (np.float32, (300, 3)))
            np.testing.assert_array_equal(np.isnan(points).any(1), ~met)
            a, b, c = (CUBE[CUBE_FACES[hits.id[met], k]] for k in range(3))
            u, v = hits.u[met, None], hits.v[met, None]
            np.testing.assert_allclose(points[met], (1 - u - v) * a + u * b + v * c, atol=1e-6)
            some = hits[met].points(origins[met], directions[met])
            np.testing.assert_array_equal(some, points[met])
            one = world.closest((0.5, 0.25, 9), (0, 0, -1))
            self.assertEqual(one.points((0.5, 0.25, 9), (0, 0, -1)).tolist(), [0.5, 0.25, 1])
            away = world.closest((0.5, 0.25, 9), (0, 0, 1))
            self.assertTrue(np.isnan(away.points((0.5, 0.25, 9), (0, 0, 1))).all())
            grid = world.closest(origins.reshape(30, 10, 3), directions[0])
            self.assertEqual(grid.points(origins.reshape(30, 10, 3), directions[0]).shape,
                             (30, 10, 3))
        with self.assertRaisesRegex(ValueError, "origins: expected shape"):
            hits[met].points(origins, directions[met])

    def test_surfaces(self):
        vertices, faces = ball(10)
        vertices, origins, directions = map(np.float64, (vertices, *rays(500, 4)))
        for offset in (0, 4e6):
            world = grelha.World(vertices + offset, faces)
            hits = world.closest(origins + offset, directions)
            seen = world.surfaces(origins + offset, directions)
            self.assertIsInstance(seen, grelha.Surfaces)
            np.testing.assert_array_equal(seen.id, hits.id)
            met = hits.id >= 0
            self.assertTrue(0 < met.sum() < 500)
            a, b, c = (vertices[faces[hits.id[met], k]].astype(float) for k in range(3))
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal, axis=1, keepdims=True)
            np.testing.assert_allclose(seen.normals[met], normal, atol=1e-5)
            points = hits.points(origins + offset, directions)
            np.testing.assert_allclose(seen.points[met], points[met], atol=2e-5)
            self.assertTrue(np.isnan(seen.normals[~met]).all())
        late = world.surfaces(origins + offset, directions, t_min=hits.t)
        np.testing.assert_array_equal(
            late.id, world.closest(origins + offset, directions, t_min=hits.t).id)
        world.masks = np.where(np.arange(len(faces)) % 2, 1, 2)
        odd = world.surfaces(origins + offset, directions, mask=1).id
        self.assertTrue(((odd % 2 == 1) | (odd == -1)).all())

    def test_surfaces_of_a_ball(self):
        world = grelha.World.spheres([[1, 2, 3]], 2)
        one = world.surfaces((1, 2, 9), (0, 0, -1))
        self.assertEqual((one.points.tolist(), one.normals.tolist(), one.id.tolist()),
                         ([1, 2, 5], [0, 0, 1], 0))

    def test_closed_mesh_loses_no_ray(self):
        vertices, faces = ball(20)
        corners = vertices[faces]
        aims = np.concatenate([vertices, corners.mean(1), (corners[:, 0] + corners[:, 1]) / 2])
        world = grelha.World(vertices, faces)
        self.assertTrue(world.occluded(np.float32([0.1, 0.2, 0.3]),
                                       aims - np.float32([0.1, 0.2, 0.3])).all())


class Crossings(unittest.TestCase):
    def test_are_the_hits_where_no_edge_is_met(self):
        vertices, faces = soup(300, 4)
        origins, directions = rays(1000, 5)
        world = grelha.World(vertices, faces)
        *_, near = every_hit(vertices, faces, origins, directions)
        sure = ~near.any(axis=1)
        for options in ({}, {"t_min": 0.3, "t_max": 1.5}, {"skip": 7}):
            hits = world.all_hits(origins[sure], directions[sure], **options)
            found = world.crossings(origins[sure], directions[sure], **options)
            for a, b in zip(hits, found):
                np.testing.assert_array_equal(a, b)
            a, b, c = (vertices[faces[found.id, k]].astype(np.float64) for k in range(3))
            ray = np.repeat(np.flatnonzero(sure), np.diff(found.offsets))
            front = (np.cross(b - a, c - a) * directions[ray]).sum(1) < 0
            np.testing.assert_array_equal(found.enters, front)
            np.testing.assert_array_equal(
                world.count_crossings(origins[sure], directions[sure], **options),
                np.diff(found.offsets))

    def test_edges_and_corners_count_once(self):
        vertices, faces = ball(6)
        world = grelha.World(vertices, faces)
        aims = np.concatenate([vertices, (vertices[faces[:, 0]] + vertices[faces[:, 1]]) / 2])
        found = world.crossings(np.zeros(3, np.float32), aims)
        self.assertTrue((np.diff(found.offsets) == 1).all())
        self.assertFalse(found.enters.any())
        through = world.crossings(-3 * aims, aims)
        self.assertEqual(np.diff(through.offsets).tolist(), [2] * len(aims))
        self.assertEqual(through.enters.tolist(), [True, False] * len(aims))
        self.assertEqual([x.dtype for x in found], [np.int64, np.float32, np.int64, bool])

    def test_shapes_and_masks(self):
        world = grelha.World(CUBE, CUBE_FACES)
        self.assertIs(type(world.count_crossings((0.3, 0.6, 4), (0, 0, -1))), int)
        self.assertEqual(world.count_crossings(np.ones((2, 1, 3)), np.ones((5, 3))).shape, (2, 5))
        top = world.crossings((0.3, 0.6, 4), (0, 0, -1)).id[0]
        world.masks = np.where(np.arange(12) == top, 1, 2)
        self.assertEqual(world.crossings((0.3, 0.6, 4), (0, 0, -1), mask=1).id.tolist(), [top])


class Layouts(unittest.TestCase):
    def setUp(self):
        self.world = grelha.World(*ball())
        self.origins, self.directions = rays(6000, 6)
        self.expected = self.world.closest(self.origins, self.directions)

    def same(self, hits, shape=(6000,)):
        for name, dtype in zip(hits._fields, ("f4", "i8", "f4", "f4", "i8")):
            found = getattr(hits, name)
            self.assertEqual((found.shape, found.dtype), (shape, np.dtype(dtype)), name)
            np.testing.assert_array_equal(found.ravel(), getattr(self.expected, name), name)

    def test_layouts_give_the_same_bits(self):
        o, d = self.origins, self.directions
        both = np.concatenate([o, d], axis=1)
        self.same(self.world.closest(o.astype(np.float64), d.astype(np.float64)))
        self.same(self.world.closest(both[:, :3], both[:, 3:]))
        self.same(self.world.closest(np.asfortranarray(o), np.asfortranarray(d)))
        self.same(self.world.closest(o[::-1][::-1], d.astype(">f4")))
        self.same(self.world.closest(o[::-1].copy()[::-1], d))
        self.same(self.world.closest(o.tolist(), d.tolist()))
        odd = np.frombuffer(b"\0" + o.tobytes(), np.uint8)[1:].view(np.float32).reshape(-1, 3)
        self.assertFalse(odd.flags.aligned)
        self.same(self.world.closest(odd, d))

    def test_axes_in_front_stay(self):
        o, d = self.origins.reshape(30, 20, 10, 3), self.directions.reshape(30, 20, 10, 3)
        self.same(self.world.closest(o, d), (30, 20, 10))
        turned = self.world.closest(o.transpose(1, 0, 2, 3), d.transpose(1, 0, 2, 3))
        np.testing.assert_array_equal(turned.t.transpose(1, 0, 2).ravel(), self.expected.t)
        self.assertEqual(self.world.occluded(o, d).shape, (30, 20, 10))
        self.assertEqual(self.world.count_hits(o, d).shape, (30, 20, 10))

    def test_one_origin_for_all(self):
        eye = np.float32([3, 1, 2])
        many = self.world.closest(np.tile(eye, (6000, 1)), self.directions)
        one = self.world.closest(eye, self.directions)
        np.testing.assert_array_equal(one.t, many.t)
        np.testing.assert_array_equal(self.world.closest(eye.astype(np.float64), self.directions).t,
                                      many.t)
        spread = self.world.closest(np.broadcast_to(eye, (6000, 3)), self.directions)
        np.testing.assert_array_equal(spread.t, many.t)
        ahead = self.world.closest(self.origins, np.float32([0, 0, -1]))
        np.testing.assert_array_equal(
            ahead.t, self.world.closest(self.origins, np.tile(np.float32([0, 0, -1]), (6000, 1))).t)

    def test_one_ray_gives_plain_numbers(self):
        hit = self.world.closest((3, 0.1, 0.2), (-1, 0, 0))
        self.assertEqual([type(x) for x in hit], [float, int, float, float, int])
        self.assertIs(type(self.world.occluded((3, 0, 0), (-1, 0, 0))), bool)
        self.assertIs(type(self.world.count_hits((3, 0, 0), (-1, 0, 0))), int)
        miss = self.world.closest((3, 0, 0), (1, 0, 0), t_max=7)
        self.assertEqual(miss, (np.inf, -1, 0, 0, -1))
        lists = self.world.all_hits((3, 0.1, 0.2), (-1, 0, 0))
        self.assertEqual(lists.offsets.tolist(), [0, 2])
        self.assertEqual((lists.t.dtype, lists.id.dtype), (np.float32, np.int64))

    def test_no_rays(self):
        none = np.zeros((0, 3), np.float32)
        self.assertEqual([len(x) for x in self.world.closest(none, none)], [0] * 5)
        self.assertEqual(self.world.all_hits(none, none).offsets.tolist(), [0])
        self.assertEqual(self.world.occluded(none, none).shape, (0,))

    def test_threads_change_no_bit(self):
        for threads in (1, 2, 7):
            self.same(self.world.closest(self.origins, self.directions, threads=threads))

    def test_rays_that_are_none(self):
        odd = np.float32([[np.nan, 0, 0], [np.inf, 0, 0], [0, 0, 0]])
        self.assertFalse(self.world.occluded(np.zeros(3, np.float32), odd).any())
        self.assertFalse(self.world.occluded(np.full((1, 3), 1e300), [[1, 0, 0]]).any())


if __name__ == "__main__":
    unittest.main()
