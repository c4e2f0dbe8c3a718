"""Misuse: an exception of the right kind that names the argument, never a crash."""
import os
import tempfile
import unittest
import warnings

import numpy as np

import grelha
from grelha.open3d import RaycastingScene
from grelha.trimesh import RayMeshIntersector
from meshes import CUBE, CUBE_FACES

RAGGED = [[1, 2, 3], [1, 2]]
# What is no array of shape (..., 3), and the exception
NO_TRIPLES = [
    (None, TypeError), ("abc", TypeError), (b"abc", TypeError), ({}, TypeError),
    (object(), TypeError),
    ({1, 2, 3}, TypeError), (RAGGED, TypeError), (["a", "b", "c"], TypeError),
    (np.zeros(3, complex), TypeError), (np.zeros((2, 3), bool), TypeError),
    (np.array(["2020-01-01"] * 3, "M8[D]"), TypeError), (np.zeros(3, "f4,f4"), TypeError),
    ([None] * 3, TypeError), (lambda: 0, TypeError), (np.float32, TypeError),
    (1.0, ValueError), (np.float64(1), ValueError), ([], ValueError), ([1, 2], ValueError),
    (np.zeros(4), ValueError), (np.zeros((3, 2)), ValueError), (np.zeros((3, 0)), ValueError),
    (np.zeros((2, 3, 4)), ValueError), (np.ma.masked_invalid(np.zeros((4, 3))), TypeError),
]
NO_WHOLES = [(None, TypeError), ("a", TypeError), ([0.5] * 3, TypeError), ({}, TypeError),
             (np.zeros(3, complex), TypeError), (object(), TypeError),
             (np.ma.masked_less(np.zeros((1, 3), int), 0), TypeError)]
NO_COUNTS = [("2", TypeError), (1.5, TypeError), (None, TypeError), ([1], TypeError),
             (-1, ValueError), (10 ** 9, ValueError), (10 ** 30, ValueError)]
RAY_METHODS = ("closest", "occluded", "all_hits", "count_hits", "crossings",
               "count_crossings")
POINT_METHODS = ("contains", "closest_points", "signed_distance", "winding_number")


class Misuses(unittest.TestCase):
    count = 0

    @classmethod
    def setUpClass(cls):
        cls.world = grelha.World(CUBE, CUBE_FACES)
        cls.scene = grelha.Scene(CUBE, CUBE_FACES)
        cls.rays = np.zeros((4, 3), np.float32), np.ones((4, 3), np.float32)

    def refused(self, name, kind, call, *args, **kwargs):
        """The call raises this kind of exception, whose text begins with the argument's name."""
        Misuses.count += 1
        with self.subTest(name=name, call=getattr(call, "__name__", call), given=args, more=kwargs):
            with self.assertRaises(kind) as caught:
                call(*args, **kwargs)
            self.assertIn(name, str(caught.exception).split(":")[0])
            self.assertIn(": expected", str(caught.exception))

    def test_rays(self):
        o, d = self.rays
        for method in RAY_METHODS:
            call = getattr(self.world, method)
            for bad, kind in NO_TRIPLES:
                self.refused("origins", kind, call, bad, d)
                self.refused("directions", kind, call, o, bad)
            self.refused("directions", ValueError, call, o, d[:3])
            self.refused("directions", ValueError, call, o.reshape(2, 2, 3), d)
            for name in ("t_min", "t_max"):
                for bad, kind in (("a", TypeError), (None, TypeError), ({}, TypeError),
                                  (1j, TypeError), ([1, 2], ValueError),
                                  (np.zeros((4, 2)), ValueError), (np.zeros(5), ValueError)):
                    self.refused(name, kind, call, o, d, **{name: bad})
            for bad, kind in NO_WHOLES[1:] + [([1, 2], ValueError), (12, ValueError),
                                              (-2, ValueError), (2 ** 40, ValueError),
                                              ([0, 1, 2, 12], ValueError)]:
                self.refused("skip", kind, call, o, d, skip=bad)
            for bad, kind in NO_WHOLES[1:] + [([1, 2], ValueError), (256, ValueError),
                                              (-1, ValueError)]:
                self.refused("mask", kind, call, o, d, mask=bad)
            for bad, kind in NO_COUNTS:
                self.refused("threads", kind, call, o, d, threads=bad)

    def test_points(self):
        for method in POINT_METHODS:
            call = getattr(self.world, method)
            for bad, kind in NO_TRIPLES:
                self.refused("points", kind, call, bad)
            for bad, kind in NO_COUNTS:
                self.refused("threads", kind, call, CUBE, threads=bad)
        for bad, kind in (("a", TypeError), (None, TypeError), (-1, ValueError),
                          (np.nan, ValueError), ([1, 2], TypeError), (2 ** 64, ValueError),
                          (2 ** 2000, ValueError)):
            self.refused("radius", kind, self.world.closest_points, CUBE, bad)

    def test_meshes(self):
        for make in (grelha.World, grelha.Scene):
            for bad, kind in NO_TRIPLES + [((1, 2, 3), ValueError), (CUBE[None], ValueError)]:
                self.refused("vertices", kind, make, bad, CUBE_FACES)
            for bad, kind in NO_WHOLES + [
                    ([0, 1, 2], ValueError), ([[0, 1]], ValueError), ([[0, 1, 8]], ValueError),
                    ([[0, -1, 2]], ValueError), (np.uint64([[0, 1, 2 ** 64 - 1]]), ValueError),
                    (CUBE_FACES[None], ValueError), (np.zeros((2, 4), int), ValueError)]:
                self.refused("faces", kind, make, CUBE, bad)
            for bad in (np.nan, np.inf, -np.inf, 2e18, 1e300):
                broken = CUBE.astype(np.float64)
                broken[3, 1] = bad
                self.refused("vertices", ValueError, make, broken, CUBE_FACES)
            for bad, kind in NO_COUNTS:
                self.refused("threads", kind, make, CUBE, CUBE_FACES, threads=bad)
        for bad, kind in NO_TRIPLES:
            self.refused("vertices", kind, self.world.update, bad)
        self.refused("vertices", ValueError, self.world.update, CUBE[:5])

    def test_spheres(self):
        for bad, kind in NO_TRIPLES:
            self.refused("centers", kind, grelha.World.spheres, bad, 1)
        for bad, kind in (("a", TypeError), (None, TypeError), (0, ValueError), (-1, ValueError),
                          (np.nan, ValueError), (np.inf, ValueError), ([1, 2], ValueError)):
            self.refused("radii", kind, grelha.World.spheres, CUBE, bad)

    def test_pictures(self):
        for name in ("width", "height", "samples", "depth"):
            for bad, kind in (("a", TypeError), (1.5, TypeError), (0, ValueError), (-3, ValueError),
                              (10 ** 9, ValueError)):
                self.refused(name, kind, self.scene.render, **{name: bad})
        for name in ("eye", "at", "up"):
            for bad, kind in NO_TRIPLES + [(CUBE, ValueError)]:
                if bad is not None:
                    self.refused(name, kind, self.scene.render, **{name: bad})
            self.refused(name, ValueError, self.scene.render, **{name: [np.nan] * 3})
        for bad, kind in (("a", TypeError), (0, ValueError), (180, ValueError),
                          (np.nan, ValueError)):
            self.refused("angle", kind, self.scene.render, angle=bad)
        for bad, kind in (("a", TypeError), (0, ValueError), (-1, ValueError), (2, ValueError)):
            self.refused("error", kind, self.scene.render, error=bad)
        self.refused("samples", ValueError, self.scene.render, error=0.1, samples=3)
        self.refused("up", ValueError, self.scene.render, eye=(0, 0, 1), at=(0, 0, 0), up=(0, 0, 1))

    def test_images(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.png")
            for bad, kind in ((None, TypeError), ("a", TypeError), (1, ValueError),
                              (np.zeros(3), ValueError), (np.zeros((2, 2, 5)), ValueError),
                              (np.zeros((0, 2)), ValueError), (np.zeros((2, 2), bool), TypeError)):
                self.refused("image", kind, grelha.write_image, path, bad)
            self.refused("path", ValueError, grelha.write_image, path + ".jpg", np.zeros((2, 2)))
            with self.assertRaises(OSError):
                grelha.write_image(os.path.join(folder, "none", "a.png"), np.zeros((2, 2)))
            with self.assertRaises(TypeError):
                grelha.write_image(None, np.zeros((2, 2)))

    def test_files(self):
        with self.assertRaises(FileNotFoundError):
            grelha.read("/nowhere/at/all.nff")
        with self.assertRaises(OSError):
            grelha.read("/")
        with self.assertRaises(TypeError):
            grelha.read(7.5)
        with tempfile.TemporaryDirectory() as folder:
            for text in ("", "v\nfrom 1 2", "ply\nformat ascii 1.0\nelement", "\0\1\2"):
                path = os.path.join(folder, "broken.nff")
                with open(path, "w") as file:
                    file.write(text)
                with self.assertRaisesRegex(ValueError, "broken.nff"):
                    grelha.read(path)

    def test_classes_cannot_be_misused(self):
        for call in (lambda: grelha.World(), lambda: grelha.World(CUBE),
                     lambda: self.world.closest(), lambda: self.world.closest(CUBE),
                     lambda: self.world.closest(*self.rays, what=1),
                     lambda: grelha.World.closest(3, *self.rays),
                     lambda: grelha.Scene()):
            Misuses.count += 1
            with self.assertRaises((TypeError, AttributeError)):
                call()

    def test_type_errors_are_one_line_without_arrays(self):
        big = np.ones((10, 3))
        for call in (lambda: grelha.World(big, faced=big), lambda: grelha.World(big),
                     lambda: grelha.World.spheres(big, radius=big),
                     lambda: self.world.closest(big, big, tmin=big),
                     lambda: self.world.closest(big, big, big, big, big, big),
                     lambda: self.world.contains(points=big, rays=big),
                     lambda: self.world.update(vertex=big),
                     lambda: self.scene.render(with_=big), lambda: grelha.write_image(image=big),
                     lambda: grelha.read("a", big), lambda: grelha.World.contains(3, big)):
            Misuses.count += 1
            with self.assertRaises((TypeError, AttributeError)) as caught:
                call()
            self.assertNotRegex(str(caught.exception), r"\n|1\.|array")

    def test_masks(self):
        world = grelha.World(CUBE, CUBE_FACES)
        for bad, kind in (([1, 2], ValueError), (1, ValueError), ([256] * 12, ValueError),
                          ([-1] * 12, ValueError), ([0.5] * 12, TypeError), ("a", TypeError)):
            self.refused("masks", kind, setattr, world, "masks", bad)
        self.assertIsNone(world.masks)

    def test_starts(self):
        call, down = self.world.start, (0, 0, -1)
        for bad, kind in NO_WHOLES + [(12, ValueError), (-1, ValueError)]:
            self.refused("face", kind, call, bad, 0, 0, down)
        for bad, kind in (("a", TypeError), (None, TypeError), (-1, ValueError), (2, ValueError),
                          (np.nan, ValueError)):
            self.refused("u", kind, call, 0, bad, 0, down)
            self.refused("v", kind, call, 0, 0, bad, down)
        self.refused("u", ValueError, call, [0, 1], [0, 0, 0], 0, down)
        for bad, kind in NO_TRIPLES:
            self.refused("directions", kind, call, 0, 0, 0, bad)

    def test_what_was_not_made(self):
        """Each ended the interpreter, or was taken."""
        for cls, ask in ((grelha.World, lambda x: x.closest((0, 0, 0), (0, 0, 1))),
                         (grelha.World, repr), (grelha.World, lambda x: x.masks),
                         (grelha.Scene, lambda x: x.render()), (grelha.Scene, lambda x: x.world)):
            Misuses.count += 1
            with self.assertRaisesRegex(TypeError, "__init__"):
                ask(cls.__new__(cls))
        for thing in (self.world, self.scene):
            before = repr(thing)
            with self.assertRaisesRegex(TypeError, "made already"):
                thing.__init__(CUBE[:3], [[0, 1, 2]])
            with self.assertRaises(AttributeError):
                thing.__setstate__(thing.__reduce__()[1][1])
            with self.assertRaises(AttributeError):
                thing.mask = 3
            self.assertEqual(repr(thing), before)

    def test_open3d(self):
        scene = RaycastingScene()
        scene.add_triangles(CUBE, CUBE_FACES)
        for bad, kind in NO_TRIPLES:
            self.refused("vertex_positions", kind, scene.add_triangles, bad, CUBE_FACES)
            for method in ("compute_distance", "compute_closest_points", "compute_occupancy",
                           "compute_signed_distance"):
                self.refused("query_points", kind, getattr(scene, method), bad)
        for method in ("cast_rays", "test_occlusions", "count_intersections", "list_intersections"):
            for bad, kind in ((None, TypeError), ("a", TypeError), (np.zeros(6), ValueError),
                              (np.zeros((2, 5)), ValueError), (1, ValueError)):
                self.refused("rays", kind, getattr(scene, method), bad)
        for bad, kind in (([[0.5, 1, 2]], TypeError), ([0, 1, 2], ValueError),
                          ([[0, 1, 8]], ValueError), ([[0, 1, -1]], ValueError)):
            self.refused("triangle_indices", kind, scene.add_triangles, CUBE, bad)
        for bad, kind in ((0, ValueError), (2, ValueError), (-1, ValueError), (1.5, TypeError),
                          (CUBE, TypeError), ("a", TypeError), (None, TypeError)):
            self.refused("nsamples", kind, scene.compute_occupancy, CUBE, nsamples=bad)
        self.refused("mesh", TypeError, scene.add_triangles, 3)
        self.refused("create_rays_pinhole", TypeError, scene.create_rays_pinhole, 1, 2)
        self.refused("intrinsic_matrix", ValueError, scene.create_rays_pinhole, np.eye(4),
                     np.eye(4), 4, 4)
        self.refused("width_px", ValueError, scene.create_rays_pinhole, np.eye(3), np.eye(4), 0, 4)
        for bad in (CUBE, "a", None):
            self.refused("fov_deg", TypeError, scene.create_rays_pinhole, bad, (0, 0, 0),
                         (0, 0, 1), (0, 1, 0), 4, 4)
            self.refused("height_px", TypeError, scene.create_rays_pinhole, 60, (0, 0, 0),
                         (0, 0, 1), (0, 1, 0), 4, bad)
        self.refused("fov_deg", ValueError, scene.create_rays_pinhole, 0, (0, 0, 0), (0, 0, 1),
                     (0, 1, 0), 4, 4)

    def test_trimesh(self):
        self.refused("mesh", TypeError, RayMeshIntersector, 3)
        mesh = type("Mesh", (), {"vertices": CUBE, "faces": CUBE_FACES})()
        ray = RayMeshIntersector(mesh)
        for bad, kind in NO_TRIPLES + [((1, 2, 3), ValueError)]:
            for method in ("intersects_id", "intersects_first", "intersects_any"):
                self.refused("ray_origins", kind, getattr(ray, method), bad, CUBE)
                self.refused("ray_directions", kind, getattr(ray, method), CUBE, bad)
            self.refused("points", kind, ray.contains_points, bad)
        self.refused("ray_directions", ValueError, ray.intersects_any, CUBE, CUBE[:2])
        for bad in (CUBE, "a", None, 2):
            self.refused("multiple_hits", TypeError, ray.intersects_location, CUBE, CUBE, bad)
        for bad, kind in ((CUBE, TypeError), ("a", TypeError), (1.5, TypeError), (-1, ValueError)):
            self.refused("max_hits", kind, ray.intersects_id, CUBE, CUBE, True, bad)

    @classmethod
    def tearDownClass(cls):
        print(cls.count, "misuses")
        assert cls.count > 300


if __name__ == "__main__":
    warnings.simplefilter("ignore", getattr(np, "exceptions", np).VisibleDeprecationWarning)
    unittest.main()
