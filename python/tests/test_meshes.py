"""Several meshes in one World: whose hits they are, and updates of one."""
import copy
import pathlib
import pickle
import tempfile
import types
import unittest

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball, rays

BALL, BALL_FACES = ball(24)
FAR = np.array([5e5, 4e6, 200.0])
AROUND = np.float32([[-9, -9, -9], [9, -9, -9], [9, 9, 9]])


def scene():
    """A triangle around all, two balls with grids of their own, no faces, and a cube."""
    return [(AROUND, [[0, 1, 2]]), (BALL, BALL_FACES), (BALL + np.float32([3, 0, 0]), BALL_FACES),
            (CUBE, np.zeros((0, 3), int)), (CUBE - np.float32([0, 3, 0]), CUBE_FACES)]


def joined(meshes):
    """The arrays of all, one after the other."""
    vertices, faces, first = [], [], 0
    for v, f in meshes:
        vertices.append(v)
        faces.append(np.asarray(f) + first)
        first += len(v)
    return np.concatenate(vertices), np.concatenate(faces)


class Meshes(unittest.TestCase):
    def same(self, world, other, shift=0.0):
        """Two Worlds have the same vertices, and answers of the same bits."""
        np.testing.assert_array_equal(world.vertices, other.vertices)
        origins, directions = rays(5000, 7)
        for a, b in zip(world.closest(origins + shift, directions),
                        other.closest(origins + shift, directions)):
            np.testing.assert_array_equal(a, b)
        for a, b in zip(world.crossings(origins + shift, directions),
                        other.crossings(origins + shift, directions)):
            np.testing.assert_array_equal(a, b)
        for a, b in zip(world.closest_points(origins[:500] + shift),
                        other.closest_points(origins[:500] + shift)):
            np.testing.assert_array_equal(a, b)

    def test_is_the_world_of_joined_arrays(self):
        world = grelha.World.of(scene())
        self.assertEqual(world.meshes, 5)
        self.same(world, grelha.World(*joined(scene())))
        np.testing.assert_array_equal(world.faces, joined(scene())[1])

    def test_kinds_of_meshes(self):
        thing = types.SimpleNamespace(vertices=CUBE.tolist(), faces=CUBE_FACES.tolist())
        world = grelha.World.of(iter([thing, grelha.World(CUBE + 5, CUBE_FACES),
                                      (CUBE.astype(np.int16), CUBE_FACES.astype(np.uint64))]))
        self.assertEqual((world.meshes, len(world.faces)), (3, 36))
        self.assertEqual(world.mesh_of(world.closest((5.5, 5.2, 9), (0, 0, -1)).id)[0], 1)

    def test_none(self):
        world = grelha.World.of([])
        self.assertEqual(world.meshes, 0)
        self.assertEqual(world.closest((0, 0, 0), (0, 0, 1)).id, -1)
        self.assertEqual(world.mesh_of(-1), (-1, -1))

    def test_mesh_of(self):
        world = grelha.World.of(scene())
        mesh, face = world.mesh_of(np.arange(len(world.faces)))
        counts = [len(f) for _, f in scene()]
        np.testing.assert_array_equal(mesh, np.repeat(np.arange(5), counts))
        np.testing.assert_array_equal(face, np.concatenate([np.arange(n) for n in counts]))
        self.assertEqual((mesh.dtype, face.dtype), (np.int64, np.int64))
        self.assertEqual([x.tolist() for x in world.mesh_of([[-1, 0], [1, 2]])],
                         [[[-1, 0], [1, 1]], [[-1, 0], [0, 1]]])
        one = world.mesh_of(len(world.faces) - 1)
        self.assertEqual((one, type(one[0])), ((4, 11), int))
        for bad in (-2, len(world.faces)):
            with self.assertRaisesRegex(ValueError, "ids: expected -1, or ids of .* primitives"):
                world.mesh_of([0, bad])
        with self.assertRaisesRegex(TypeError, "ids: expected whole numbers"):
            world.mesh_of(0.5)

    def test_other_worlds_are_one_mesh(self):
        world = grelha.World(CUBE, CUBE_FACES)
        self.assertEqual((world.meshes, world.mesh_of(11)), (1, (0, 11)))
        world.update_mesh(0, CUBE * 2)
        self.same(world, grelha.World(CUBE * 2, CUBE_FACES))
        balls = grelha.World.spheres(CUBE, 1)
        self.assertEqual((balls.meshes, balls.mesh_of(3)), (1, (-1, -1)))
        with self.assertRaisesRegex(ValueError, "update_mesh: expected a World of triangles alone"):
            balls.update_mesh(0, CUBE)

    def test_updates_beyond_the_range_of_a_file_are_refused(self):
        rows = "\n".join(" ".join(repr(float(x)) for x in row) for row in CUBE * 1e-25)
        faces = "\n".join("3 " + " ".join(map(str, face)) for face in CUBE_FACES)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "tiny.ply")
            path.write_text("ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\n"
                            "property double y\nproperty double z\nelement face 12\n"
                            "property list uchar int vertex_indices\nend_header\n"
                            f"{rows}\n{faces}\n")
            world = grelha.read(path).world
        with self.assertRaisesRegex(ValueError, "vertices"):
            world.update_mesh(0, CUBE * 1e18)
        self.assertTrue(np.isfinite(world.vertices).all())

    def test_update_of_one_is_a_new_world_bit_for_bit(self):
        meshes, world = scene(), grelha.World.of(scene())
        rng = np.random.default_rng(3)
        for step in range(30):
            mesh = int(rng.integers(5))
            vertices, faces = meshes[mesh]
            if step % 10 == 9:  # the box around all changes
                vertices = vertices + np.float32(30)
            elif step % 2:
                vertices = vertices + rng.normal(size=3).astype(np.float32) * 0.2
            else:  # the box of the mesh stays, and its grid must not
                apart = (vertices > vertices.min(0) + 0.05) & (vertices < vertices.max(0) - 0.05)
                vertices = vertices + apart * rng.uniform(-0.01, 0.01, apart.shape).astype("f4")
            meshes[mesh] = vertices, faces
            world.update_mesh(mesh, vertices)
            self.same(world, grelha.World(*joined(meshes)))
        world.update(joined(scene())[0])
        self.same(world, grelha.World.of(scene()))
        self.assertEqual(world.meshes, 5)

    def test_update_keeps_the_offset(self):
        meshes = [(v + FAR, f) for v, f in scene()]
        world = grelha.World.of(meshes)
        offset = world.offset.tolist()
        meshes[2] = (meshes[2][0] + [0.25, 0.5, 0], BALL_FACES)
        world.update_mesh(2, meshes[2][0])
        self.assertEqual(world.offset.tolist(), offset)
        self.same(world, grelha.World(*joined(meshes)), FAR)
        world.update_mesh(2, meshes[2][0] + [1000, 0, 0])
        self.assertEqual(world.offset.tolist(), offset)
        np.testing.assert_allclose(world.closest(FAR + (1003.25, 0.5, 9), (0, 0, -1)).t, 8,
                                   rtol=1e-5)
        local = np.float32(BALL + [7, 0, 0])  # float32 too has the offset subtracted
        world.update_mesh(1, local * 2 ** 18)
        np.testing.assert_allclose(world.vertices[3:3 + len(BALL)], local * 2.0 ** 18, atol=1)

    def test_offset_follows_what_is_there(self):
        """Whoever comes and goes in a survey, answers are those of a new World."""
        near = [(v.astype(float), f) for v, f in (scene()[1], scene()[4])]
        far = [(v + FAR + 0.3, f) for v, f in near]
        for begun in ([], near[:1]):
            world = grelha.World.of(begun)
            for i, (vertices, faces) in enumerate(far):
                if i < len(begun):
                    world.update_mesh(i, vertices)
                else:
                    world.add_mesh(vertices, faces)
            self.same(world, grelha.World.of(far), FAR)
            self.assertTrue(world.offset.any())
        world = grelha.World.of(near)
        for i, (vertices, _) in enumerate(far):
            world.update_mesh(i, vertices)
            world = pickle.loads(pickle.dumps(world))
        self.same(world, grelha.World.of(far), FAR)
        for i, (vertices, _) in enumerate(near):
            world.update_mesh(i, vertices)
        self.same(world, grelha.World.of(near))
        world.update(joined(far)[0])
        self.same(world, grelha.World.of(far), FAR)
        farther = [(v + FAR, f) for v, f in far]
        for i, (vertices, _) in enumerate(farther):
            world.update_mesh(i, vertices)
        self.same(world, grelha.World.of(farther), 2 * FAR)
        for of_all in (True, False):  # one stays where the other comes to
            world = grelha.World.of(near if of_all else [near[0], far[1]])
            if of_all:
                world.update(np.concatenate([near[0][0], far[1][0]]))
            world.update_mesh(0, far[0][0])
            self.same(world, grelha.World.of(far), FAR)

    def test_float64_makes_all_float64(self):
        for change in (lambda world: world.add_mesh(CUBE.astype(float), CUBE_FACES),
                       lambda world: world.update_mesh(0, CUBE.astype(float))):
            world = grelha.World.of([(CUBE, CUBE_FACES)])
            self.assertEqual(world.vertices.dtype, np.float32)
            change(world)
            self.assertEqual(world.vertices.dtype, np.float64)

    def test_errors_name_the_mesh(self):
        good = (CUBE, CUBE_FACES)
        broken = CUBE.copy()
        broken[3, 1] = np.nan
        for bad, kind, text in (
                ((CUBE, CUBE_FACES + 1), ValueError, "mesh 2: faces: expected indices of 8"),
                ((broken, CUBE_FACES), ValueError, r"mesh 2: vertices: .*nan at \(3, 1\)"),
                ((CUBE[:, :2], CUBE_FACES), ValueError, "mesh 2: vertices: expected shape"),
                ((np.ma.masked_less(CUBE, 0), CUBE_FACES), TypeError, "mesh 2: vertices: .*masked"),
                ((CUBE, None), TypeError, "mesh 2: faces: expected whole numbers"),
                (CUBE, TypeError, "mesh 2: expected vertices and faces, found ndarray"),
                (types.SimpleNamespace(vertices=CUBE), TypeError, "mesh 2: expected vertices and"),
                (None, TypeError, "mesh 2: expected vertices and faces, found NoneType")):
            with self.subTest(text), self.assertRaisesRegex(kind, text):
                grelha.World.of([good, good, bad])
        with self.assertRaisesRegex(TypeError, "meshes: expected a sequence"):
            grelha.World.of(types.SimpleNamespace(vertices=CUBE, faces=CUBE_FACES))
        with self.assertRaisesRegex(TypeError, "threads"):
            grelha.World.of([good], threads="a")

    def test_errors_of_updates_change_nothing(self):
        world = grelha.World.of(scene())
        broken = CUBE.copy()
        broken[7, 2] = np.inf
        for mesh, vertices, kind, text in (
                (5, CUBE, ValueError, "mesh: expected 0 to 4, found 5"),
                (-1, CUBE, ValueError, "mesh: expected 0 to 4, found -1"),
                (1.5, CUBE, TypeError, "mesh: expected a whole number"),
                (True, CUBE, TypeError, "mesh: expected a whole number, found bool"),
                (4, CUBE[:7], ValueError, r"vertices: .*\(8, 3\), found \(7, 3\)"),
                (4, broken, ValueError, r"vertices: expected finite .*inf at \(7, 2\)"),
                (4, None, TypeError, "vertices: expected numbers")):
            with self.subTest(text), self.assertRaisesRegex(kind, text):
                world.update_mesh(mesh, vertices)
        self.same(world, grelha.World.of(scene()))
        world.update_mesh(3, broken)  # which no face uses

    def test_masks_leave_meshes_out(self):
        world = grelha.World.of(scene())
        world.masks = 1 << world.mesh_of(np.arange(len(world.faces)))[0]
        down = (0, 0, 9), (0, 0, -1)
        self.assertEqual(world.mesh_of(world.closest(*down).id)[0], 1)
        self.assertEqual(world.mesh_of(world.closest(*down, mask=255 - 2).id)[0], 0)
        world.update_mesh(1, BALL * 2)
        self.assertEqual(world.mesh_of(world.closest(*down, mask=255 - 2).id)[0], 0)
        self.same(world, grelha.World.of([*scene()[:1], (BALL * 2, BALL_FACES), *scene()[2:]]))

    def test_hidden_meshes_are_not_there(self):
        world = grelha.World.of(scene())
        down = (0, 0, 9), (0, 0, -1)
        for mesh in range(5):
            self.assertTrue(world.is_visible(mesh))
            left = [(v, f if i != mesh else np.zeros((0, 3), int))
                    for i, (v, f) in enumerate(scene())]
            other = grelha.World.of(left)
            world.set_visible(mesh, False)
            self.assertFalse(world.is_visible(mesh))
            ids, others = world.closest(*rays(3000, 5)).id, other.closest(*rays(3000, 5)).id
            for got, expected in zip(world.mesh_of(ids), other.mesh_of(others)):
                np.testing.assert_array_equal(got, expected)
            self.assertEqual(world.check()[:3], other.check()[:3])
            points = np.float32([[0, 0, 0], [3, 0, 0], [0, -3, 0]])
            np.testing.assert_array_equal(world.contains(points, inside="winding"),
                                          other.contains(points, inside="winding"))
            copied = pickle.loads(pickle.dumps(world))
            self.assertFalse(copied.is_visible(mesh))
            self.same(copied, world)
            world.set_visible(mesh, True)
            self.same(world, grelha.World.of(scene()))
        world.set_visible(1, False)
        world.update_mesh(1, BALL * 2)
        world.update_mesh(2, BALL + np.float32([3, 1, 0]))
        self.assertEqual(world.mesh_of(world.closest(*down).id)[0], 0)
        world.set_visible(1, True)
        self.same(world, grelha.World.of([*scene()[:1], (BALL * 2, BALL_FACES),
                                          (BALL + np.float32([3, 1, 0]), BALL_FACES),
                                          *scene()[3:]]))
        with self.assertRaisesRegex(ValueError, "mesh: expected 0 to 4, found 5"):
            world.set_visible(5, True)
        for visible in ("no", None, 2, 0.5):
            with self.assertRaisesRegex(TypeError, "visible: expected True or False, found "):
                world.set_visible(0, visible)
        world.set_visible(0, np.bool_(False))
        with self.assertRaisesRegex(ValueError, "set_visible: expected a World of triangles alone"):
            grelha.World.spheres(CUBE, 1).set_visible(0, False)

    def test_added_meshes(self):
        for far in (np.zeros(3, np.float32), FAR):
            meshes = [(v + far, f) for v, f in scene()]
            world = grelha.World.of(meshes[:3])
            offset = world.offset.tolist()
            world.masks = np.ones(len(world.faces), int)
            self.assertEqual(world.add_mesh(*meshes[3]), 3)
            self.assertEqual(world.add_mesh(*meshes[4]), 4)
            self.assertEqual((world.meshes, world.offset.tolist()), (5, offset))
            self.same(world, grelha.World.of(meshes), far)
            self.assertEqual(world.masks[-13:].tolist(), [1] + [255] * 12)
            broken = np.concatenate([CUBE[:7] + far, [[0, 0, np.nan]]])
            with self.assertRaisesRegex(ValueError, r"vertices: expected finite .*nan at \(7, 2\)"):
                world.add_mesh(broken, CUBE_FACES)
            with self.assertRaisesRegex(ValueError, "faces: expected indices of 7 vertices"):
                world.add_mesh(CUBE[:7] + far, CUBE_FACES)
            self.same(world, grelha.World.of(meshes), far)
        one = grelha.World(CUBE, CUBE_FACES)
        self.assertEqual(one.add_mesh(CUBE + 5, CUBE_FACES), 1)
        self.same(one, grelha.World.of([(CUBE, CUBE_FACES), (CUBE + 5, CUBE_FACES)]))
        with self.assertRaisesRegex(ValueError, "add_mesh: expected a World of triangles alone"):
            grelha.World.spheres(CUBE, 1).add_mesh(CUBE, CUBE_FACES)

    def test_meshes_moved_at_once(self):
        for far in (np.zeros(3, np.float32), FAR):
            meshes = [(v + far, f) for v, f in scene()]
            world = grelha.World.of(meshes)
            for i in (4, 1):
                meshes[i] = meshes[i][0] + np.float32([.5, -.25, 1]), meshes[i][1]
            world.update_meshes({i: meshes[i][0] for i in (4, np.int64(1))})
            self.same(world, grelha.World.of(meshes), far)
            before = world.vertices
            with self.assertRaisesRegex(ValueError, "vertices: expected as many as before"):
                world.update_meshes({4: meshes[4][0] + 1, 1: CUBE})
            with self.assertRaisesRegex(ValueError, "mesh: expected 0 to 4, found 5"):
                world.update_meshes({4: meshes[4][0] + 1, 5: CUBE})
            with self.assertRaisesRegex(TypeError, "vertices: expected a dict from numbers"):
                world.update_meshes([meshes[4][0]])
            world.update_meshes({})
            np.testing.assert_array_equal(world.vertices, before)
        near = grelha.World.of([(CUBE, CUBE_FACES), (CUBE + 4, CUBE_FACES)])
        moved = {0: CUBE + FAR, 1: CUBE + 4}
        near.update_meshes(moved)  # one of doubles, one of floats
        self.same(near, grelha.World.of([(v, CUBE_FACES) for v in moved.values()]))
        with self.assertRaisesRegex(ValueError, "update_meshes: expected a World of triangles"):
            grelha.World.spheres(CUBE, 1).update_meshes({0: CUBE})

    def test_removed_meshes(self):
        for far in (np.zeros(3, np.float32), FAR):
            meshes = [(v + far, f) for v, f in scene()]
            world = grelha.World.of(meshes)
            world.masks = world.mesh_of(np.arange(len(world.faces)))[0] + 1
            for gone in (1, 1, 2):  # the largest stays, and the offset with it
                left = world.masks[world.mesh_of(np.arange(len(world.faces)))[0] != gone]
                world.remove_mesh(gone)
                del meshes[gone]
                self.assertEqual(world.meshes, len(meshes))
                self.assertEqual(world.masks.tolist(), left.tolist())
                fresh = grelha.World.of(meshes)
                fresh.masks = left
                self.same(world, fresh, far)
            with self.assertRaisesRegex(ValueError, "mesh: expected 0 to 1, found 2"):
                world.remove_mesh(2)
        with self.assertRaisesRegex(ValueError, "remove_mesh: expected a World of triangles"):
            grelha.World.spheres(CUBE, 1).remove_mesh(0)

    def test_copies_and_pickles_stay_meshes(self):
        world = grelha.World.of(scene())
        world.update_mesh(1, BALL * 2)
        for other in (copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
            self.assertEqual(other.meshes, 5)
            self.same(other, world)
            other.update_mesh(4, CUBE)
            self.assertEqual(other.mesh_of(len(other.faces) - 1), (4, 11))
            np.testing.assert_array_equal(other.vertices[-8:], CUBE)
            self.assertFalse((world.vertices[-8:] == CUBE).all())

    def test_broken_states_raise(self):
        restored, (cls, state, masks) = grelha.World.of(scene()).__reduce__()
        for firsts in ([0, 1], [1, *state[-1][1:]], state[-1][:-1], state[-1] // 2,
                       state[-1][::-1]):
            with self.assertRaisesRegex(ValueError, "state: expected vertices of each mesh"):
                restored(cls, (*state[:-1], np.uint32(firsts)), masks)
        short = {**state[1], "doubles": np.zeros(7)}
        with self.assertRaisesRegex(ValueError, "state: expected three doubles of each vertex"):
            restored(cls, (state[0], short, *state[2:]), masks)


if __name__ == "__main__":
    unittest.main()
