"""Files, pictures and the module itself."""
import inspect
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball, rays

DATA = pathlib.Path(__file__).resolve().parent.parent.parent / "scenes" / "data"
FAR = np.array([5_000_000.5, 0.125, -3_000_000.25])


def ply(vertices, faces):
    head = ("ply\nformat ascii 1.0\n"
            f"element vertex {len(vertices)}\nproperty double x\nproperty double y\n"
            f"property double z\nelement face {len(faces)}\n"
            "property list uchar int vertex_indices\nend_header\n")
    return head + "".join(f"{float(x)!r} {float(y)!r} {float(z)!r}\n" for x, y, z in vertices) + (
        "".join("3 {} {} {}\n".format(*f) for f in faces))


class Files(unittest.TestCase):
    def test_ply(self):
        scene = grelha.read(DATA / "torus.ply")
        self.assertEqual((scene.vertices.dtype, scene.faces.dtype), (np.float32, np.int64))
        self.assertEqual(scene.vertices.shape[1], 3)
        world = grelha.World(scene.vertices, scene.faces)
        for a, b in zip(scene.world.closest(*rays(3000, 1)), world.closest(*rays(3000, 1))):
            np.testing.assert_array_equal(a, b)
        self.assertEqual(str(scene.world), f"<grelha.World: {len(scene.faces)} triangles>")

    def test_kinds_of_primitives(self):
        scene = grelha.read(str(DATA / "balls.nff").encode())
        hits = scene.world.closest(*rays(3000, 1))
        self.assertTrue((hits.id >= 0).any())
        self.assertTrue((hits.face == -1).all() or len(scene.faces))
        mixed = grelha.read(DATA / "columns.nff").world
        hits = mixed.closest(*rays(9000, 1, 6.0))
        self.assertLess(hits.face.max(), len(mixed.faces))
        again = __import__("pickle").loads(__import__("pickle").dumps(mixed))
        for a, b in zip(again.closest(*rays(9000, 1, 6.0)), hits):
            np.testing.assert_array_equal(a, b)

    def test_frames(self):
        vertices, faces = ball(8)
        for scale, shift in ((1, FAR), (1e-20, 0), (2.0 ** -60, 0)):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "far.ply")
                pathlib.Path(path).write_text(ply(vertices * scale + shift, faces))
                scene = grelha.read(path)
            np.testing.assert_allclose(scene.vertices, vertices * scale + shift,
                                       atol=1e-6 * scale, rtol=0)
            middle = np.zeros(3) + shift
            hit = scene.world.closest(middle + np.array([3, 0.1, 0]) * scale, (-1, 0, 0))
            near = grelha.World(vertices, faces).closest((3, 0.1, 0), (-1, 0, 0))
            self.assertAlmostEqual(hit.t / scale, near.t, 4)
            self.assertEqual(hit.id, near.id)
            self.assertTrue(scene.world.occluded(middle, (1, 0, 0), t_max=1.01 * scale))
            self.assertFalse(scene.world.occluded(middle, (1, 0, 0), t_max=0.8 * scale))
            self.assertTrue(scene.world.contains(middle))
            outside = middle + np.array([0, 0, 3.0]) * scale
            self.assertAlmostEqual(scene.world.signed_distance(outside) / scale, 2, 4)
            found = scene.world.closest_points(outside)
            self.assertAlmostEqual(found.distance / scale, 2, 4)
            np.testing.assert_allclose(found.points, middle + np.array([0, 0, 1.0]) * scale,
                                       atol=1e-6 * scale, rtol=0)
            self.assertEqual(scene.world.closest_points(outside, 1.9 * scale).id, -1)
            lists = scene.world.all_hits(middle + np.array([3, 0.1, 0]) * scale, (-1, 0, 0))
            self.assertAlmostEqual(lists.t[0] / scale, near.t, 4)

    def test_warnings_are_pythons(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "far.ply")
            pathlib.Path(path).write_text(ply(np.full((3, 3), np.inf), [[0, 1, 2]]))
            with self.assertWarnsRegex(UserWarning, "left out"):
                grelha.read(path)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                with self.assertRaises(UserWarning):
                    grelha.read(path)


class Pictures(unittest.TestCase):
    def test_render(self):
        scene = grelha.read(DATA / "balls.nff")
        picture = scene.render(64, 48)
        self.assertEqual((picture.shape, picture.dtype), ((48, 64, 3), np.float32))
        np.testing.assert_array_equal(picture, scene.render(64, 48, threads=1))
        self.assertEqual(scene.render().shape, (scene.camera["height"], scene.camera["width"], 3))
        fine = scene.render(64, 48, samples=16)
        self.assertFalse(np.array_equal(picture, fine))
        self.assertFalse(np.array_equal(fine, scene.render(64, 48, samples=16, seed=1)))
        coarse = scene.render(64, 48, error=0.05)
        np.testing.assert_array_equal(coarse, scene.render(64, 48, error=0.05, samples=65536))
        self.assertFalse(np.array_equal(coarse, scene.render(64, 48, error=0.05, samples=8)))
        self.assertLess(np.sqrt(((np.clip(coarse, 0, 1) - np.clip(fine, 0, 1)) ** 2).mean()), 0.1)

    def test_camera(self):
        scene = grelha.Scene(CUBE + FAR, CUBE_FACES)
        view = scene.camera
        np.testing.assert_allclose(view["at"], FAR + 0.5, atol=0.5)
        picture = scene.render(80, 80)
        same = scene.render(80, 80, eye=view["eye"], at=view["at"], up=view["up"],
                            angle=view["angle"])
        np.testing.assert_array_equal(picture, same)
        back = picture[0, 0]
        self.assertTrue((scene.render(20, 20, at=2 * np.array(view["eye"]) - view["at"]) == back)
                        .all())
        self.assertLess((picture == back).all(-1).mean(), 0.7)

    def test_lights_of_a_mesh_follow_the_camera(self):
        scene = grelha.Scene(*ball(16))
        eye, at = np.array(scene.camera["eye"]), np.array(scene.camera["at"])
        behind = 2 * at - eye
        seen = scene.render(64, 64, eye=behind, background=(9, 9, 9))
        self.assertGreater(seen.min(), 0.12)
        self.assertGreater(np.median(seen[seen < 9]), 0.4)
        stay = scene.render(64, 64, eye=behind, background=(9, 9, 9), lights=scene.lights)
        self.assertLess(np.median(stay[stay < 9]), 0.2)
        self.assertEqual(scene.lights.shape, (3, 2, 3))
        dark = scene.render(64, 64, lights=np.empty((0, 2, 3)), background=(0, 0, 0))
        self.assertLess(dark.max(), 0.2, "the glow of the material")
        again = __import__("pickle").loads(__import__("pickle").dumps(scene))
        np.testing.assert_array_equal(again.render(64, 64, eye=behind, background=(9, 9, 9)), seen)

    def test_colors(self):
        vertices, faces = ball(16)
        rng = np.random.default_rng(1)
        light = rng.random((len(vertices), 3)).astype(np.float32)
        scene = grelha.Scene(vertices, faces, colors=light)
        np.testing.assert_array_equal(scene.colors, light)
        self.assertIsNone(grelha.Scene(vertices, faces).colors)
        image = scene.render(64, 64, samples=1)
        again = __import__("pickle").loads(__import__("pickle").dumps(scene))
        np.testing.assert_array_equal(again.render(64, 64, samples=1), image)
        white = grelha.Scene(vertices, faces, colors=np.ones_like(light)).render(64, 64, samples=1)
        self.assertTrue((image <= white + 1e-6).all() and (image < white - 0.1).any())
        encoded = rng.integers(0, 256, (len(vertices), 3), np.uint8)
        share = encoded / 255
        np.testing.assert_allclose(
            grelha.Scene(vertices, faces, colors=encoded).colors,
            np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4), rtol=1e-6)
        for wrong in (light[1:], light[:, :2], light + 1, -light, np.full_like(light, np.nan)):
            with self.assertRaisesRegex(ValueError, "colors"):
                grelha.Scene(vertices, faces, colors=wrong)
        with self.assertRaisesRegex(TypeError, "colors"):
            grelha.Scene(vertices, faces, colors="red")

    def test_colors_of_files_are_those_of_the_program(self):
        program = pathlib.Path(grelha.__file__).parents[2] / "grelha"
        if not program.exists():
            self.skipTest(f"there is no {program}")
        vertices, faces = ball(8)
        encoded = np.random.default_rng(2).integers(0, 256, (len(vertices), 3))
        text = ply(vertices, faces).replace("property double z\n", "property double z\n" + "".join(
            f"property uchar {name}\n" for name in ("red", "green", "blue")))
        lines = text.split("end_header\n")
        rows = lines[1].split("\n")
        for i, color in enumerate(encoded):
            rows[i] += " {} {} {}".format(*color)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "colored.ply")
            path.write_text(lines[0] + "end_header\n" + "\n".join(rows))
            for words, colors in (([], True), (["--no-colors"], False)):
                of_program, of_python = path.with_suffix(".a.png"), path.with_suffix(".b.png")
                subprocess.run([program, "render", path, "--size", "40x40", "-q", "-o", of_program,
                                *words], check=True)
                scene = grelha.read(path, colors=colors)
                self.assertEqual(scene.colors is not None, colors)
                grelha.write_image(of_python, scene.render(40, 40), srgb=colors)
                self.assertEqual(*[p.read_bytes().split(b"IDAT", 1)[1]
                                   for p in (of_program, of_python)])
            with self.assertRaisesRegex(ValueError, "srgb"):
                grelha.write_image(path.with_suffix(".exr"), scene.render(4, 4), srgb=True)

    def test_camera_rays_are_those_of_pictures(self):
        vertices, faces = ball(12)
        for shift in (0, FAR):
            scene = grelha.Scene(vertices + shift, faces)
            for view in ({}, {"orbit": (70, 20, 1.3)}, {"orthographic": 3},
                         {"eye": np.array([0, 0, 4]) + shift, "at": np.zeros(3) + shift}):
                origins, directions = scene.camera_rays(40, 30, **view)
                self.assertEqual((origins.shape, directions.shape), ((30, 40, 3), (30, 40, 3)))
                np.testing.assert_allclose((directions.astype(float) ** 2).sum(-1), 1, atol=1e-6)
                hits = scene.world.closest(origins, directions)
                image = scene.render(40, 30, samples=1, background=(9, 9, 9), **view)
                np.testing.assert_array_equal(hits.id < 0, (image == 9).all(-1))
                self.assertTrue(0.1 < (hits.id >= 0).mean() < 0.9)

    def test_surfaces(self):
        vertices, faces = ball(12)
        colors = np.random.default_rng(3).random((len(vertices), 3))
        for shift in (0, FAR):
            scene = grelha.Scene(vertices + shift, faces, colors=colors,
                                 material={"diffuse": (0.5, 1, 0.25)})
            origins, directions = scene.camera_rays(50, 50)
            hits, found = (scene.world.closest(origins, directions),
                           scene.surfaces(origins, directions))
            np.testing.assert_array_equal(found.id, hits.id)
            there = hits.id >= 0
            self.assertTrue(np.isnan(found.points[~there]).all() and (~there).any())
            corners = (vertices.astype(float) + shift)[faces[hits.face[there]]]
            weights = np.stack([1 - hits.u - hits.v, hits.u, hits.v], -1)[there].astype(float)
            mixed = (weights[..., None] * corners).sum(1)
            np.testing.assert_allclose(found.points[there], mixed, atol=1e-5)
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
            np.testing.assert_allclose(found.normals[there], normals, atol=1e-5)
            wanted = (weights[..., None] * colors[faces[hits.face[there]]]).sum(1) * (0.5, 1, 0.25)
            np.testing.assert_allclose(found.colors[there], wanted, atol=1e-5)
        one = scene.surfaces(origins[25, 25], directions[25, 25])
        self.assertEqual((one.points.shape, one.id.shape), ((3,), ()))
        balls = grelha.read(DATA / "balls.nff")
        seen = balls.surfaces(*balls.camera_rays(20, 20))
        self.assertGreater(len(np.unique(seen.colors[seen.id >= 0], axis=0)), 1)

    def test_several_meshes(self):
        vertices, faces = ball(12)
        glows = [{"diffuse": 0, "specular": 0, "emission": color} for color in np.eye(3).tolist()]
        meshes = [(vertices + np.float32([3 * i, 0, 0]), faces) for i in range(3)]
        scene = grelha.Scene.of(meshes, materials=glows)

        def shown(scene):
            image = scene.render(90, 30, samples=1, background=(0, 0, 0))
            return {tuple(p) for p in image.reshape(-1, 3).tolist()} - {(0, 0, 0)}

        rgb = {(1, 0, 0), (0, 1, 0), (0, 0, 1)}
        self.assertEqual(shown(scene), rgb)
        self.assertEqual(scene.world.meshes, 3)
        self.assertEqual(shown(pickle.loads(pickle.dumps(scene))), rgb)
        scene.world.set_visible(1, False)
        self.assertEqual(shown(scene), rgb - {(0, 1, 0)})
        scene.world.set_visible(1, True)
        scene.world.update_mesh(2, meshes[1][0] * np.float32([1, 0.5, 0.5]))  # inside the second
        self.assertEqual(shown(scene), rgb - {(0, 0, 1)})
        plain = grelha.Scene.of(meshes).render(60, 20, samples=1)
        one = grelha.Scene(np.concatenate([v for v, _ in meshes]),
                           np.concatenate([faces + i * len(vertices) for i in range(3)]))
        np.testing.assert_array_equal(plain, one.render(60, 20, samples=1))
        far = grelha.Scene.of([(v.astype(float) + FAR, f) for v, f in meshes], materials=glows)
        self.assertEqual(shown(far), rgb)
        self.assertEqual(grelha.Scene.of([]).world.meshes, 0)
        for wrong in (glows[:2], [], [1, 2, 3], "abc", 5, glows[0], [{"shiny": 1}] * 3):
            with self.assertRaisesRegex((TypeError, ValueError), "material"):
                grelha.Scene.of(meshes, materials=wrong)
        with self.assertRaisesRegex(ValueError, "without materials"):
            scene.world.add_mesh(vertices, faces)
        with self.assertRaisesRegex(ValueError, "mesh 1"):
            grelha.Scene.of([meshes[0], (vertices, faces + 9999)])

    def test_material(self):
        vertices, faces = ball(12)
        plain = grelha.Scene(vertices, faces).render(32, 32, samples=1)
        same = grelha.Scene(vertices, faces, material={}).render(32, 32, samples=1)
        np.testing.assert_array_equal(plain, same)
        glow = {"diffuse": 0, "specular": 0, "emission": (0.25, 0.5, 1)}
        image = grelha.Scene(vertices, faces, material=glow).render(
            32, 32, samples=1, background=(0, 0, 0))
        self.assertEqual({tuple(p) for p in image.reshape(-1, 3).tolist()},
                         {(0, 0, 0), (0.25, 0.5, 1)})
        mirror = grelha.read(DATA / "torus.ply", material={"mirror": 1, "diffuse": 0})
        self.assertGreater(np.abs(mirror.render(32, 32) -
                                  grelha.read(DATA / "torus.ply").render(32, 32)).max(), 0.1)
        for wrong in ({"colour": 1}, {"diffuse": -1}, {"shine": np.nan}, {"diffuse": (1, 2)},
                      {"transmission": 1, "ior": 0}):
            with self.assertRaisesRegex(ValueError, "material"):
                grelha.Scene(vertices, faces, material=wrong)
        with self.assertRaisesRegex(TypeError, "material"):
            grelha.Scene(vertices, faces, material=1)
        with self.assertRaisesRegex(ValueError, "material: expected a mesh"):
            grelha.read(DATA / "balls.nff", material={})

    def test_points_and_smooth_normals(self):
        vertices, faces = ball(12)
        with tempfile.TemporaryDirectory() as folder:
            cloud, mesh = (os.path.join(folder, name) for name in ("cloud.ply", "mesh.ply"))
            pathlib.Path(cloud).write_text(ply(vertices, []))
            pathlib.Path(mesh).write_text(ply(vertices, faces))
            self.assertIn(f"{len(vertices)} spheres", str(grelha.read(cloud)))
            balls = grelha.read(cloud, points=0.125).world
            self.assertIn(f"{len(vertices)} spheres", str(balls))
            self.assertAlmostEqual(balls.closest((0, 0, 3), (0, 0, -1)).t, 2 - 0.125, 6)
            self.assertGreater(grelha.read(cloud, points="auto").render(24, 24).std(), 0.05)
            flat, round_ = grelha.read(mesh), grelha.read(mesh, smooth=60)
            rays_ = flat.camera_rays(40, 40)
            seen = [s.surfaces(*rays_) for s in (flat, round_)]
            there = seen[0].id >= 0
            off = [np.linalg.norm(s.normals - s.points, axis=-1)[there].max() for s in seen]
            self.assertTrue(off[1] < 0.05 < off[0], off)
            for name, value in (("points", 0), ("points", "all"), ("smooth", 0), ("smooth", 181)):
                with self.assertRaisesRegex((ValueError, TypeError), name):
                    grelha.read(cloud, **{name: value})


class Module(unittest.TestCase):
    def test_docstrings_and_stubs_have_all_names(self):
        stubs = pathlib.Path(grelha.__file__).with_name("__init__.pyi").read_text()
        for owner in (grelha.World, grelha.Scene):
            self.assertGreater(len(inspect.getdoc(owner)), 80)
            for name, member in vars(owner).items():
                if not name.startswith("_"):
                    self.assertTrue(inspect.getdoc(member), name)
                    self.assertRegex(stubs, rf"def {name}\(")
        for name in grelha.__all__:
            self.assertRegex(stubs, rf"(class|def) {name}\b|{name}:")

    def test_stubs_hold(self):
        """mypy accepts the recipes and this module's calls; a wrong call it does not."""
        mypy = "/usr/bin/mypy"
        if not os.path.exists(mypy):
            self.skipTest("there is no mypy (apt-get install mypy)")
        recipes = DATA.parent.parent / "python" / "recipes"
        with tempfile.TemporaryDirectory() as folder:
            wrong = pathlib.Path(folder, "wrong.py")
            wrong.write_text("import grelha\ngrelha.World(1, 2).closest(nothing=3)\n")
            for files, status in ((sorted(recipes.glob("*.py")), 0), ([wrong], 1)):
                for file in files:
                    done = subprocess.run([mypy, "--cache-dir", folder, file], text=True,
                                          capture_output=True, check=False,
                                          env={**os.environ, "MYPYPATH": os.environ["PYTHONPATH"]})
                    self.assertEqual(done.returncode, status, done.stdout + done.stderr)

    def test_numpy_2_is_refused_where_it_cannot_be_read(self):
        if grelha._grelha.pybind11 >= (2, 12):
            self.skipTest("this module reads arrays of numpy 2")
        program = ("import sys, types; sys.modules['numpy'] = types.ModuleType('numpy'); "
                   "sys.modules['numpy'].__version__ = '2.0.1'; import grelha")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                              check=False)
        self.assertRegex(done.stderr, "ImportError: grelha: expected numpy before 2, found 2.0.1")

    def test_program_prints_nothing(self):
        done = subprocess.run([sys.executable, "-c", "import grelha"], capture_output=True,
                              check=True, cwd="/")
        self.assertEqual((done.stdout, done.stderr), (b"", b""))


if __name__ == "__main__":
    unittest.main()
