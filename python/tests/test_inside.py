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
        self.assertTrue(check.closed and check.oriented and check.edge_manifold)
        self.assertEqual(check[:3], (12, 8, 18))
        self.assertEqual([found.count for found in check[3:]], [0] * 5)
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
        self.assertFalse(check.closed or check.oriented or check.edge_manifold)
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


if __name__ == "__main__":
    unittest.main()
