"""Pictures of scans from all sides: nothing is dark, and the program draws the same."""
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import grelha
from meshes import ball, soup

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


if __name__ == "__main__":
    unittest.main()
