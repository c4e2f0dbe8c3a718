"""Pictures: light, views, what World they show, and their files."""
import os
import pathlib
import pickle
import struct
import subprocess
import tempfile
import unittest
import zlib

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball

DATA = pathlib.Path(__file__).resolve().parent.parent.parent / "scenes" / "data"
FAR = np.array([5_000_000.5, 0.125, -3_000_000.25])


def png_bytes(path):
    """The pixels of a PNG whose rows have no interlace: (h, w, channels)."""
    data, at, packed = pathlib.Path(path).read_bytes(), 8, b""
    width, height, _, kind = struct.unpack(">IIBB", data[16:26])
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += 12 + size
    channels = {2: 3, 6: 4}[kind]
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, -1)
    pixels = np.zeros((height + 1, width + 1, channels), int)
    for y, row in enumerate(rows):
        for x, value in enumerate(row[1:].reshape(width, channels).astype(int)):
            left, up, corner = pixels[y + 1, x], pixels[y, x + 1], pixels[y, x]
            distances = np.abs([up - corner, left - corner, left + up - 2 * corner])
            near = np.choose(distances.argmin(0), [left, up, corner])
            guess = (0, left, up, (left + up) // 2, near)[row[0]]
            pixels[y + 1, x + 1] = (value + guess) % 256
    return pixels[1:, 1:]


class Pictures(unittest.TestCase):
    def test_lights_and_background(self):
        scene = grelha.read(DATA / "balls.nff")
        picture = scene.render(40, 40, samples=4)
        np.testing.assert_array_equal(scene.render(40, 40, samples=4, lights=scene.lights), picture)
        other = [((1, 2, 3), (0.5, 0, 0))]
        self.assertGreater(np.abs(scene.render(40, 40, samples=4, lights=other) - picture).max(), 0)
        for name, value in (("lights", [(1, 2, 3)]), ("lights", [((0, 0, 1), (-1, 0, 0))]),
                            ("lights", [((np.nan, 0, 1), (1, 0, 0))]), ("background", (-1, 0, 0)),
                            ("background", -1.0), ("orbit", (1,)), ("orbit", (0, 1, 0)),
                            ("orbit", (np.nan, 1)), ("orthographic", -1), ("orbit", (0, 1e9))):
            with self.assertRaisesRegex(ValueError, name):
                scene.render(8, 8, **{name: value})
        dull = grelha.Scene(*ball(), material={"emission": 0})
        dark = dull.render(16, 16, samples=1, lights=[], background=0.5)
        self.assertEqual(set(dark.ravel().tolist()), {0.0, 0.5})
        np.testing.assert_array_equal(scene.render(16, 16, orbit=70),
                                      scene.render(16, 16, orbit=(70, 0)))
        for name, value in (("transparent", "no"), ("angle", True), ("samples", True)):
            with self.assertRaisesRegex(TypeError, name):
                scene.render(8, 8, **{name: value})
        for call in (lambda: grelha.read(DATA / "torus.ply", colors="no"),
                     lambda: grelha.write_image("a.png", np.zeros((2, 2)), srgb="no")):
            with self.assertRaisesRegex(TypeError, "expected True or False, found str"):
                call()

    def test_pictures_follow_the_world(self):
        """What is set on scene.world stays, and is what a Scene of that mesh shows."""
        view = {"width": 40, "height": 40, "eye": (1, 2, 6), "at": (0, 0, 0)}
        vertices, faces = ball(8)
        grey = np.linspace(0, 1, 3 * len(vertices)).reshape(-1, 3)
        for given in ({}, {"colors": grey}, {"smooth": 180}, {"material": {"mirror": 0.5}},
                      {"colors": np.resize(grey, faces.shape)}):
            scene = grelha.Scene(vertices, faces, **given)
            scene.render(8, 8)
            view["lights"], eye = scene.lights, scene.camera["eye"]
            for moved in (vertices * (0.5, 1, 0.2) + (0.3, 0, 0), vertices + FAR):
                for move in (scene.world.update, lambda v: scene.world.update_mesh(0, v)):
                    move(moved)
                    shift = FAR * (moved is not vertices and abs(moved).max() > 9)
                    seen = {**view, "eye": shift + (1, 2, 6), "at": shift}
                    seen["lights"] = scene.lights + [shift, [0, 0, 0]]
                    other = grelha.Scene(moved, faces, **given).render(**seen)
                    np.testing.assert_allclose(scene.render(**seen), other, atol=2e-3)
                    self.assertGreater(other.std(), 0.01)
                    np.testing.assert_allclose(scene.lights, view["lights"], atol=0.5)
                    np.testing.assert_allclose(scene.camera["eye"], eye, atol=0.5)
                    move(vertices)
        scene.world.update_mesh(0, vertices * 0.5)
        scene.world.set_visible(0, False)
        scene.world.masks = np.arange(len(faces)) % 2
        for same in (scene, pickle.loads(pickle.dumps(scene))):
            self.assertIs(same.world, same.world)
            self.assertFalse(same.world.is_visible(0))
            self.assertEqual(same.world.masks.tolist(), scene.world.masks.tolist())
            self.assertLess(same.render(**view).std((0, 1)).max(), 1e-4)
            self.assertTrue((same.surfaces(*same.camera_rays(9, 9)).id == -1).all())
            np.testing.assert_array_equal(same.vertices, scene.world.vertices)
            same.world.set_visible(0, True)
            self.assertGreater(same.render(**view).std((0, 1)).max(), 0.01)
        balls = grelha.read(DATA / "balls.nff")
        with self.assertRaisesRegex(AttributeError, "world"):
            balls.world = grelha.World(vertices, faces)

    def test_views_are_those_of_the_program(self):
        program = pathlib.Path(grelha.__file__).parents[2] / "grelha"
        if not program.exists():
            self.skipTest(f"there is no {program}")
        scene = grelha.read(DATA / "torus.ply")
        views = [({"orbit": (azimuth, elevation)}, ["--orbit", f"{azimuth},{elevation}"])
                 for azimuth in range(0, 360, 45) for elevation in (-65, -20, 25)]
        views += [({"orbit": (0, 70)}, ["--orbit", "0,70"]),
                  ({"orbit": (10, -110, 1.5), "orthographic": 3, "background": (1, 0.5, 0)},
                   ["--orbit", "10,-110,1.5", "--orthographic", "3", "--background", "1,.5,0"]),
                  ({"eye": (3, 2, 1), "at": (0, 0.1, 0), "up": (0, 0, 1), "angle": 20.5},
                   ["--eye", "3,2,1", "--at", "0,.1,0", "--up", "0,0,1", "--angle", "20.5"]),
                  ({"orbit": (180, 0), "lights": scene.lights},
                   ["--orbit", "180,0", "--lights", "mesh"])]
        with tempfile.TemporaryDirectory() as folder:
            for given, words in views:
                of_program, of_python = (os.path.join(folder, n) for n in ("a.png", "b.png"))
                subprocess.run([program, "render", DATA / "torus.ply", "--size", "32x32", "-q",
                                "-o", of_program, *words], check=True)
                image = scene.render(32, 32, **given)
                grelha.write_image(of_python, image)
                pixels = [pathlib.Path(p).read_bytes().split(b"IDAT", 1)[1]
                          for p in (of_program, of_python)]
                self.assertEqual(*pixels, words)
                self.assertGreater(len(np.unique(image)), 100, words)

    def test_files_of_pictures(self):
        image = np.random.default_rng(1).random((5, 7, 3)).astype(np.float32)
        with tempfile.TemporaryDirectory() as folder:
            for ending in ("png", "hdr", "exr", "pfm"):
                grelha.write_image(os.path.join(folder, "a." + ending), image)
            data = pathlib.Path(folder, "a.pfm").read_bytes()
            self.assertTrue(data.startswith(b"PF\n7 5\n"))
            found = np.frombuffer(data[-5 * 7 * 12:], "<f4").reshape(5, 7, 3)[::-1]
            np.testing.assert_array_equal(found, image)
            grelha.write_image(pathlib.Path(folder, "b.pfm"), image[::-1, :, 0].astype(np.float64))
            data = pathlib.Path(folder, "b.pfm").read_bytes()
            found = np.frombuffer(data[-5 * 7 * 12:], "<f4").reshape(5, 7, 3)
            np.testing.assert_array_equal(found, np.repeat(image[..., :1], 3, -1))


    def test_bytes_stay_bytes(self):
        """A PNG has the bytes of a uint8 array; other files their light. Other integers: no."""
        grey = np.arange(256, dtype=np.uint8).reshape(16, 16)
        color = np.random.default_rng(2).integers(0, 256, (6, 5, 4)).astype(np.uint8)
        color[0, :, 3] = 0
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "a.png")
            for image in (grey, color[..., :3], color, color[::-1, ::2]):
                for srgb in (False, True):
                    grelha.write_image(name, image, srgb=srgb)
                    shown = np.repeat(image[..., None], 3, -1) if image.ndim == 2 else image
                    np.testing.assert_array_equal(png_bytes(name), shown)
            grelha.write_image(os.path.join(folder, "a.pfm"), grey)
            found = np.frombuffer(pathlib.Path(folder, "a.pfm").read_bytes()[-3072:], "<f4")
            scene = grelha.Scene(CUBE, CUBE_FACES, colors=np.uint8([[200, 100, 7]] * 8))
            found = found.reshape(16, 16, 3)[::-1].reshape(-1, 3)[:, 0]
            np.testing.assert_array_equal(found[[200, 100, 7]], scene.colors[0])
            alpha = np.float32(color[..., 3:]) / np.float32(255)
            grelha.write_image(os.path.join(folder, "a.exr"), color)
            grelha.write_image(os.path.join(folder, "b.exr"),
                               np.concatenate([found[color[..., :3]] * alpha, alpha], -1))
            files = [pathlib.Path(folder, name).read_bytes() for name in ("a.exr", "b.exr")]
            self.assertEqual(*files)
            for kind in (np.int64, np.uint16, np.int8, bool):
                with self.assertRaisesRegex(TypeError, f"image: expected .*{kind.__name__} array"):
                    grelha.write_image(name, np.ones((4, 4), kind))


if __name__ == "__main__":
    unittest.main()
