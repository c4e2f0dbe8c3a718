"""How calls look: shapes that broadcast, masks, starts on faces, signatures, names."""
import inspect
import unittest

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball, rays

FAR = np.array([4_512_345.25, -731_000.5, 1_204.125])


class Broadcasting(unittest.TestCase):
    def setUp(self):
        self.world = grelha.World(*ball())
        self.origins, self.directions = rays(60, 1)

    def same(self, *shapes, dtype=np.float32):
        """Arguments of such shapes give what numpy's own broadcasting of them gives."""
        shapes = [*shapes, *[()] * (5 - len(shapes))]
        rng = np.random.default_rng(3)
        origins = (rng.normal(size=(*shapes[0], 3)) * 2).astype(dtype)
        directions = rng.normal(size=(*shapes[1], 3)).astype(dtype)
        t_min, t_max = rng.uniform(0, 0.3, shapes[2]), rng.uniform(0.3, 9, shapes[3])
        skip = rng.integers(-1, 100, shapes[4])
        shape = np.broadcast_shapes(*shapes)
        full = [np.broadcast_to(a, (*shape, 3)).reshape(-1, 3).copy()
                for a in (origins, directions)]
        full += [np.broadcast_to(a, shape).ravel() for a in (t_min, t_max, skip)]
        for name in ("closest", "occluded", "count_hits"):
            found = getattr(self.world, name)(origins, directions, t_min, t_max, skip)
            expected = getattr(self.world, name)(*full)
            for a, b in zip(found if name == "closest" else [found],
                            expected if name == "closest" else [expected]):
                self.assertEqual(a.shape, shape)
                np.testing.assert_array_equal(a.ravel(), b, str(shapes))
        lists = self.world.all_hits(origins, directions, t_min, t_max, skip)
        for a, b in zip(lists, self.world.all_hits(*full)):
            np.testing.assert_array_equal(a, b)

    def test_as_numpy(self):
        for dtype in (np.float32, np.float64):
            for shapes in (((1,), (60,)), ((60,), (1,)), ((6, 1), (6, 10)), ((6, 10), (1, 10)),
                           ((6, 1), (1, 10)), ((10,), (6, 10)), ((6, 10), ()), ((1, 1), (6, 10)),
                           ((5, 1, 4), (3, 1)), ((0,), (1,)), ((6, 0), (1,)),
                           ((), (), (60,)), ((), (), (), (6, 10)), ((), (60,), (), (), (1,)),
                           ((6, 10), (6, 10), (6, 1), (10,), (1, 1)), ((60,), (60,), (1,))):
                self.same(*shapes, dtype=dtype)

    def test_pictures_from_one_eye(self):
        eye, directions = np.float32([[[3, 1, 2]]]), self.directions.reshape(6, 10, 3)
        self.assertEqual(self.world.closest(eye, directions).t.shape, (6, 10))
        rows = np.float32(np.zeros((6, 1, 3))) + [3, 1, 2]
        np.testing.assert_array_equal(self.world.closest(rows, directions).t,
                                      self.world.closest(eye, directions).t)


class Masks(unittest.TestCase):
    def setUp(self):
        self.world = grelha.World(CUBE, CUBE_FACES)
        self.down = np.tile(np.float32([0.3, 0.6, 4]), (4, 1)), np.float32([0, 0, -1])
        self.top, self.bottom = self.world.all_hits(self.down[0][0], self.down[1]).id

    def test_masks(self):
        masks = np.full(12, 1)
        masks[self.top] = 2
        self.world.masks = masks
        world = self.world
        self.assertEqual((world.masks.dtype, world.masks.tolist()), (np.uint8, masks.tolist()))
        mask = [1, 2, 3, 4]
        self.assertEqual(world.closest(*self.down, mask=mask).id.tolist(),
                         [self.bottom, self.top, self.top, -1])
        self.assertEqual(world.occluded(*self.down, mask=mask).tolist(), [True, True, True, False])
        self.assertEqual(world.count_hits(*self.down, mask=mask).tolist(), [1, 1, 2, 0])
        self.assertEqual(np.diff(world.all_hits(*self.down, mask=mask).offsets).tolist(),
                         [1, 1, 2, 0])
        self.assertEqual(world.closest(self.down[0][0], self.down[1], mask=1).id, self.bottom)
        self.assertEqual(world.closest(*self.down).t.tolist(), [3] * 4)
        world.update(CUBE * 2)
        self.assertEqual(world.closest(*self.down, mask=1).t.tolist(), [4] * 4)
        world.masks = None
        self.assertEqual(world.closest(*self.down, mask=4).t.tolist(), [2] * 4)

    def test_given_arrays_may_change(self):
        masks = np.zeros(12, np.uint8)
        self.world.masks = masks
        masks[:] = 255
        self.world.masks[:] = 255
        self.assertFalse(self.world.occluded(*self.down).any())


class Starts(unittest.TestCase):
    def test_starts_lie_on_the_side_of_the_direction(self):
        world = grelha.World(CUBE, CUBE_FACES)
        inwards = np.cross(*(CUBE[CUBE_FACES[:, k]] - CUBE[CUBE_FACES[:, 0]] for k in (2, 1)))
        for directions, inside in ((inwards, True), (-inwards, False)):
            origins = world.start(np.arange(12), 0.25, 0.5, directions)
            self.assertEqual((origins.shape, origins.dtype), ((12, 3), np.float32))
            np.testing.assert_array_equal(world.contains(origins), inside)
            np.testing.assert_array_equal(np.isfinite(world.closest(origins, directions).t), inside)

    def test_no_thickness_is_that_of_a_rounding(self):
        """Points on edges and corners of a ball, and close to them: `skip` alone met neighbours."""
        for shift in (0, FAR):
            vertices, faces = ball(24)
            world = grelha.World(vertices + shift, faces)
            corners = (world.vertices - shift)[faces]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            face = np.arange(len(faces))
            for u in (0, 1e-9, 1e-7, 0.3, 0.5):
                for v in (0, 1e-8, 0.5):
                    origins = world.start(face, u, v, -normals)
                    t = world.closest(origins, -normals).t * np.linalg.norm(normals, axis=1)
                    self.assertGreater(t.min(), 1.5)
                    self.assertLess(t.max(), 2.001)

    def test_shapes(self):
        world = grelha.World(CUBE, CUBE_FACES)
        self.assertEqual(world.start(0, 0.2, 0.3, (0, 0, 1)).shape, (3,))
        self.assertEqual(world.start(np.arange(12)[:, None], [0.2, 0.3], 0.3, (0, 0, 1)).shape,
                         (12, 2, 3))
        self.assertEqual(world.start(0, 0.2, 0.3, np.ones((5, 1, 3))).shape, (5, 1, 3))
        self.assertEqual(grelha.World(CUBE + FAR, CUBE_FACES).start(0, 0, 0, (0, 0, 1)).dtype,
                         np.float64)
        self.assertEqual(world.start([], 0.2, 0.3, (0, 0, 1)).shape, (0, 3))


class Names(unittest.TestCase):
    def test_signatures(self):
        for owner, more in ((grelha.World, []), (grelha.Scene, ["colors", "smooth", "material"])):
            self.assertEqual(list(inspect.signature(owner).parameters),
                             ["vertices", "faces", *more, "threads"])
            for name, member in vars(owner).items():
                if callable(member) and not name.startswith("_"):
                    inspect.signature(member)
        text = str(inspect.signature(grelha.World(CUBE, CUBE_FACES).closest))
        self.assertEqual(text, "(origins, directions, t_min=0.0, t_max=inf, skip=None, *, "
                               "mask=None, threads=0)")
        self.assertEqual(str(inspect.signature(grelha.read)),
                         "(path, *, colors=True, points=None, smooth=None, material=None, "
                         "threads=0)")
        self.assertEqual(str(inspect.signature(grelha.write_image)), "(path, image, *, srgb=False)")

    def test_texts(self):
        self.assertEqual(repr(grelha.World(CUBE, CUBE_FACES)), "<grelha.World: 12 triangles>")
        self.assertRegex(repr(grelha.Scene(CUBE, CUBE_FACES)),
                         r"^<grelha.Scene: 12 triangles; \d+ x \d+ pixels>$")


if __name__ == "__main__":
    unittest.main()
