"""Pictures of scans from all sides: nothing is dark, and the program draws the same."""
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import grelha
from meshes import CUBE, CUBE_FACES, ball, soup

SOURCES = pathlib.Path(__file__).resolve().parent.parent.parent
SCANS = SOURCES.parent / "shared" / "scenes" / "ply"
DIRECTIONS = [(azimuth, elevation) for elevation in (-45, 0, 45)
              for azimuth in range(0, 360, 45)] + [(0, 90), (0, -90)]
DARKEST = 0.05  # of what a screen shows, white is 1
SRGB_SLOPE = 12.92  # of the curve, down there
OPEN = 9.0  # the light of the background, which nothing else has
SIDE = 64  # pixels


def bumpy():
    """A closed mesh with hollows."""
    vertices, faces = ball(30)
    x, y, _ = vertices.astype(float).T
    return (vertices * (1 + 0.2 * np.sin(5 * x) * np.sin(7 * y + 1))[:, None]), faces


def write_ply(path, vertices, faces, colors=None):
    names = ["float x", "float y", "float z"]
    rows = vertices
    if colors is not None:
        names += ["float red", "float green", "float blue"]
        rows = np.concatenate([vertices, colors], 1)
    head = "".join(f"property {name}\n" for name in names)
    path.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\n{head}"
                    f"element face {len(faces)}\nproperty list uchar int vertex_index\nend_header\n"
                    + "".join(" ".join(map(repr, map(float, row))) + "\n" for row in rows)
                    + "".join("3 {} {} {}\n".format(*face) for face in faces))
    return path


class FromAllSides(unittest.TestCase):
    def scans(self, folder):
        vertices, faces = bumpy()
        colors = np.maximum(np.random.default_rng(1).random(vertices.shape), vertices[:, :1] > 0)
        yield SOURCES / "scenes" / "data" / "torus.ply"
        yield write_ply(folder / "bumpy.ply", vertices, faces)
        yield write_ply(folder / "colored.ply", vertices, faces, colors)
        yield write_ply(folder / "soup.ply", *soup(60, 1))
        for name in ("bunny10k", "horse", "dragon", "lucy"):
            if (SCANS / f"{name}.ply").exists():
                yield SCANS / f"{name}.ply"

    def test_nothing_is_dark(self):
        with tempfile.TemporaryDirectory() as folder:
            for path in self.scans(pathlib.Path(folder)):
                scene = grelha.read(path)
                for view in DIRECTIONS:
                    with self.subTest(scan=path.name, view=view):
                        self.expect_bright(scene, view)

    def expect_bright(self, scene, view):
        image = scene.render(SIDE, SIDE, samples=1, orbit=view, background=(OPEN,) * 3)
        seen = (image < OPEN).all(-1)
        self.assertGreater(seen.sum(), 30)
        least = np.full(3, DARKEST, np.float32)
        if scene.colors is not None:  # a dark colour stays one
            found = scene.surfaces(*scene.camera_rays(SIDE, SIDE, orbit=view))
            least = found.colors[seen] * DARKEST / SRGB_SLOPE
        self.assertTrue((image[seen] >= least).all(), (image[seen] - least).min())

    def test_the_program_draws_the_same(self):
        program = pathlib.Path(grelha.__file__).parents[2] / "grelha"
        if not program.exists():
            self.skipTest(f"there is no {program}")
        turns = [(8, "0,-45"), (8, "0,0"), (8, "0,45"), (1, "0,90"), (1, "0,-90")]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for path in self.scans(folder):
                pictures = []
                for count, first in turns:
                    subprocess.run([program, "render", path, "--size", f"{SIDE}x{SIDE}", "-q",
                                    "--turntable", str(count), "--orbit", first, "-o",
                                    folder / "turn-{}.pfm"], check=True)
                    pictures += [(folder / f"turn-{k}.pfm").read_bytes() for k in range(count)]
                scene = grelha.read(path)
                self.assertEqual(len(pictures), len(DIRECTIONS))
                for view, picture in zip(DIRECTIONS, pictures):
                    mine = folder / "mine.pfm"
                    grelha.write_image(mine, scene.render(SIDE, SIDE, orbit=view))
                    self.assertEqual(mine.read_bytes(), picture, (path.name, view))
                for options, view in ((["--up", "x"], {"up": (1, 0, 0)}),
                                      (["--orthographic", "auto"], {"orthographic": "auto"})):
                    subprocess.run([program, "render", path, "--size", f"{SIDE}x{SIDE}", "-q",
                                    *options, "-o", folder / "his.pfm"], check=True)
                    grelha.write_image(mine, scene.render(SIDE, SIDE, **view))
                    self.assertEqual(mine.read_bytes(), (folder / "his.pfm").read_bytes(), view)


class Solids(unittest.TestCase):
    def test_solids_are_meshes_with_names(self):
        rng = np.random.default_rng(3)
        names = ["lid of a box", "", "caf\u00e9", "x # y"]
        corners = [rng.integers(-9, 9, (n, 3, 3)) for n in (4, 1, 7, 2)]
        text = "".join(
            f"solid {name}\n" + "".join(
                "facet\nouter loop\n" + "".join("vertex {} {} {}\n".format(*c) for c in facet)
                + "endloop\nendfacet\n" for facet in facets)
            + "endsolid\n" for name, facets in zip(names, corners))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "parts.stl"
            path.write_text(text, encoding="utf-8")
            scene = grelha.read(path)
        self.assertEqual([(name, len(faces)) for name, faces in scene.solids],
                         [(name, len(facets)) for name, facets in zip(names, corners)])
        for again in (scene, __import__("pickle").loads(__import__("pickle").dumps(scene))):
            self.assertEqual(again.solids, scene.solids)
            self.assertEqual(again.world.meshes, 4)
            for k, (_, faces) in enumerate(again.solids):
                np.testing.assert_array_equal(again.vertices[again.faces[faces]], corners[k])
                mesh, face = again.world.mesh_of(np.array(faces))
                np.testing.assert_array_equal(mesh, k)
                np.testing.assert_array_equal(face, np.arange(len(faces)))
        scene.world.set_visible(0, False)
        moved = scene.world.vertices[:0]
        with self.assertRaisesRegex(ValueError, "vertices"):
            scene.world.update_mesh(1, moved)
        self.assertEqual(grelha.Scene(CUBE, CUBE_FACES).solids, [])


class Meshes(unittest.TestCase):
    def test_colors_of_faces(self):
        vertices, faces = ball(8)
        rng = np.random.default_rng(4)
        encoded = rng.integers(0, 256, (len(faces), 3), np.uint8)
        share = encoded / 255
        light = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
        scene = grelha.Scene(vertices, faces, colors=encoded, material={"diffuse": (1, 0.5, 0.25)})
        again = __import__("pickle").loads(__import__("pickle").dumps(scene))
        rays = scene.camera_rays(40, 40)
        for one in (scene, again):
            found = one.surfaces(*rays)
            hits = one.world.closest(*rays)
            there = hits.id >= 0
            np.testing.assert_allclose(
                found.colors[there], light[hits.face[there]] * (1, 0.5, 0.25), rtol=1e-6)
        black = grelha.Scene(vertices, faces, colors=np.zeros_like(encoded),
                             material={"specular": 0}).render(40, 40, background=(0, 0, 0))
        self.assertEqual(black.max(), 0)
        self.assertIsNone(scene.colors)
        with self.assertRaisesRegex(ValueError, r"colors: expected shape \(114, 3\) or \(224, 3\)"):
            grelha.Scene(vertices, faces, colors=encoded[1:])

    def test_smooth(self):
        vertices, faces = ball(12)
        faces = np.concatenate([faces, [[0, 0, 1]]])  # without area
        flat = grelha.Scene(vertices, faces)
        round_ = grelha.Scene(vertices, faces, smooth=60, colors=np.ones_like(vertices))
        rays = flat.camera_rays(40, 40)
        seen = [s.surfaces(*rays) for s in (flat, round_)]
        there = seen[0].id >= 0
        np.testing.assert_array_equal(seen[0].id, seen[1].id)
        off = [np.linalg.norm(s.normals - s.points, axis=-1)[there].max() for s in seen]
        self.assertTrue(off[1] < 0.05 < off[0], off)
        self.assertEqual(len(grelha.Scene(CUBE, CUBE_FACES, smooth=80).vertices), 24)
        self.assertEqual(len(grelha.Scene(CUBE, CUBE_FACES, smooth=100).vertices), 8)
        for wrong in (0, 181, np.nan):
            with self.assertRaisesRegex(ValueError, "smooth"):
                grelha.Scene(vertices, faces, smooth=wrong)

    def test_transparent(self):
        scene = grelha.Scene(*bumpy())
        image = scene.render(40, 40, transparent=True)
        self.assertEqual(image.shape, (40, 40, 4))
        alpha = image[..., 3:]
        over = image[..., :3] + (1 - alpha) * np.float32((1, 0, 2))
        np.testing.assert_allclose(over, scene.render(40, 40, background=(1, 0, 2)), atol=2e-6)
        self.assertTrue((alpha == 0).any() and (alpha == 1).any() and (alpha % 1 > 0).any())
        with self.assertRaisesRegex(ValueError, "transparent"):
            scene.render(8, 8, transparent=True, error=0.1)
        with tempfile.TemporaryDirectory() as folder:
            for ending in ("pfm", "hdr"):
                with self.assertRaisesRegex(ValueError, "image: expected three channels"):
                    grelha.write_image(f"{folder}/a.{ending}", image)
            with self.assertRaisesRegex(ValueError, "image: expected shape"):
                grelha.write_image(f"{folder}/a.png", image[..., :2])
            self.expect_bytes_of_the_program(pathlib.Path(folder))

    def expect_bytes_of_the_program(self, folder):
        program = pathlib.Path(grelha.__file__).parents[2] / "grelha"
        if not program.exists():
            self.skipTest(f"there is no {program}")
        mesh = write_ply(folder / "bumpy.ply", *bumpy())
        image = grelha.read(mesh).render(40, 40, transparent=True)
        for ending, begin in (("png", b"IDAT"), ("exr", b"screenWindowWidth")):
            subprocess.run([program, "render", mesh, "--size", "40x40", "-q", "--transparent",
                            "-o", folder / f"a.{ending}"], check=True)
            grelha.write_image(folder / f"b.{ending}", image)
            pixels = [(folder / f"{name}.{ending}").read_bytes().split(begin, 1)[1]
                      for name in "ab"]
            if ending == "exr":  # offsets of blocks, which notes before them move
                pixels = [p[-2000:] for p in pixels]
            self.assertEqual(*pixels)


if __name__ == "__main__":
    unittest.main()
