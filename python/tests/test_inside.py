"""Insides, and what a mesh is."""
import pathlib
import unittest

import numpy as np

import grelha
import meshes

TORUS = pathlib.Path(__file__).parents[2] / "scenes" / "data" / "torus.ply"


class Check(unittest.TestCase):
    def test_cube(self):
        check = grelha.World(meshes.CUBE, meshes.CUBE_FACES).check()
        self.assertTrue(check.closed and check.oriented and check.manifold and check.edge_manifold)
        self.assertEqual(check[:3], (12, 8, 18))
        self.assertEqual([found.count for found in check[3:]], [0] * 6)
        self.assertEqual(check.open_edges.first.shape, (0, 3))
        self.assertEqual(check.degenerate_triangles.first.shape, (0,))

    def test_vertices_at_one_place(self):
        loose = meshes.CUBE[meshes.CUBE_FACES].reshape(-1, 3)
        check = grelha.World(loose, np.arange(36).reshape(-1, 3)).check()
        self.assertTrue(check.closed)
        self.assertEqual(check.vertices, 8)

    def test_defects(self):
        faces = np.concatenate([meshes.CUBE_FACES[1:], meshes.CUBE_FACES[5:6], [[0, 1, 1]]])
        faces[8] = faces[8, ::-1]
        check = grelha.World(meshes.CUBE, faces).check()
        self.assertFalse(check.closed or check.oriented or check.manifold or check.edge_manifold)
        # [0, 1, 3] is gone, [0, 5, 1] is there twice
        edges = {tuple(sorted(edge)) for edge in check.open_edges.first[:, 1:].tolist()}
        self.assertEqual(edges, {(1, 3), (0, 3), (0, 5), (1, 5)})
        self.assertEqual(check.duplicate_triangles.first.tolist(), [11])
        self.assertEqual(check.degenerate_triangles.first.tolist(), [12])
        for face, start, end in check.inconsistent_edges.first:
            corners = faces[face].tolist()
            self.assertEqual(corners[(corners.index(start) + 1) % 3], end)

    def test_scene_with_spheres(self):
        scene = grelha.read(str(TORUS))
        self.assertTrue(scene.world.check().closed)
        self.assertEqual(grelha.World.spheres([[0, 0, 0]], 1).check().triangles, 0)


def without(vertices, faces, beyond):
    """The mesh without the faces beyond a height."""
    return faces[vertices[faces][..., 2].max(-1) < beyond]


class Rules(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.vertices, cls.faces = meshes.ball()
        cls.points = np.random.default_rng(1).uniform(-1.3, 1.3, (3000, 3)).astype(np.float32)

    def test_open(self):
        open_faces = without(self.vertices, self.faces, 0.8)
        world = grelha.World(self.vertices, open_faces)
        for ask in (world.contains, world.signed_distance):
            for rule in ({}, {"inside": "closed"}, {"inside": "nonzero"}):
                with self.assertRaisesRegex(ValueError, "inside: expected a closed mesh, found "
                                            "[0-9]+ open edges, the first from vertex "
                                            ".*\"winding\""):
                    ask(self.points, **rule)
        inside = world.contains(self.points, inside="winding")
        number = world.winding_number(self.points, 1e-6)
        np.testing.assert_array_equal(inside, np.abs(number) > 0.5)
        np.testing.assert_allclose(number, winding(self.vertices, open_faces, self.points),
                                   atol=2e-6)
        distance = world.signed_distance(self.points, inside="winding")
        np.testing.assert_array_equal(distance < 0, inside)
        self.assertEqual(world.contains(self.points[0], inside="winding"), inside[0])
        self.assertIsInstance(world.winding_number(self.points[0]), float)
        self.assertEqual(world.winding_number(self.points.reshape(3, -1, 3)).shape, (3, 1000))
        # the parity along one ray, as count_crossings() has it
        ray = world.count_crossings(self.points, (0.4375, 0.8125, 0.3125))
        np.testing.assert_array_equal(world.contains(self.points, inside="odd"), ray % 2 == 1)

    def test_closed(self):
        world = grelha.World(self.vertices, self.faces)
        inside = world.contains(self.points)
        for rule in ("odd", "nonzero", "winding"):
            np.testing.assert_array_equal(world.contains(self.points, inside=rule), inside)
        np.testing.assert_allclose(world.winding_number(self.points), inside, atol=0.01)

    def test_union(self):
        moved = np.concatenate([self.vertices, self.vertices + np.float32([0.7, 0, 0])])
        both = grelha.World(moved, np.concatenate([self.faces, self.faces + len(self.vertices)]))
        one, other = (grelha.World(part, self.faces).contains(self.points)
                      for part in np.split(moved, 2))
        np.testing.assert_array_equal(both.contains(self.points, inside="nonzero"), one | other)
        np.testing.assert_array_equal(both.contains(self.points), one ^ other)

    def test_badly_wound(self):
        faces = self.faces.copy()
        faces[7] = faces[7, ::-1]
        world = grelha.World(self.vertices, faces)
        for ask in (world.contains, world.signed_distance):
            with self.assertRaisesRegex(ValueError, "inside: expected an oriented mesh, found 3 "
                                        "inconsistent edges, the first from vertex"):
                ask(self.points, inside="nonzero")
        right = grelha.World(self.vertices, self.faces)
        np.testing.assert_array_equal(world.contains(self.points), right.contains(self.points))
        # the other side of every face: closed as before, wound the other way
        turned = grelha.World(self.vertices, self.faces[:, ::-1])
        for rule in ("closed", "odd", "nonzero", "winding"):
            np.testing.assert_array_equal(turned.contains(self.points, inside=rule),
                                          right.contains(self.points))
        np.testing.assert_allclose(turned.winding_number(self.points, 1e-6),
                                   -right.winding_number(self.points, 1e-6), atol=2e-6)

    def test_far_away(self):
        far = np.array([4e6, 5e6, 300.])
        world = grelha.World(self.vertices + far, without(self.vertices, self.faces, 0.8))
        near = grelha.World(self.vertices, without(self.vertices, self.faces, 0.8))
        np.testing.assert_allclose(world.winding_number(self.points + far, 1e-3),
                                   near.winding_number(self.points, 1e-3), atol=2e-2)

    def test_wrong(self):
        world = grelha.World(self.vertices, self.faces)
        for ask in (world.contains, world.signed_distance):
            with self.assertRaisesRegex(ValueError, "inside: expected .*winding.*, found even"):
                ask(self.points, inside="even")
            with self.assertRaisesRegex(TypeError, "inside: expected "):
                ask(self.points, inside=1)
        for bad in (0, -1, np.nan):
            with self.assertRaisesRegex(ValueError, "error: expected a number above 0, found "):
                world.winding_number(self.points, bad)


def winding(vertices, faces, points):
    """Winding numbers, after Van Oosterom and Strackee."""
    a, b, c = (vertices[faces[:, k]].astype(np.float64) - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
    volume = (np.cross(a, b) * c).sum(-1)
    beside = (la * lb * lc + (a * b).sum(-1) * lc + (b * c).sum(-1) * la + (c * a).sum(-1) * lb)
    return np.arctan2(volume, beside).sum(-1) / (2 * np.pi)


if __name__ == "__main__":
    unittest.main()
