"""Each recipe runs, says something, and writes a picture with something on it."""
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np

import grelha

RECIPES = pathlib.Path(__file__).resolve().parent.parent / "recipes"
SCENES = RECIPES.parent.parent / "scenes" / "data"
SAYS = {
    "sun_hours": r"0\.00 to 1[01]\.\d\d hours of sun",
    "ambient_occlusion": r"0\.[5-9]\d\d of the sky",
    "wall_thickness": r"thinnest 0\.0[0-9]*[1-9]",
    "distance_slice": r"0 open edges; 0\.2\d\d of the slice is inside",
    "nested_shells": r"^10748\d\d particles .*: 0 lost, 0 crossings too many",
    "turntable": r"8 pictures of \d+ triangles",
}


def pixels_of(path):
    """The RGB bytes of a PNG, (h, w, 3)."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert (depth, colour) == (8, 2)
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    pixels = np.zeros((height + 1, width + 1, 3), np.int64)  # a black row and column come first
    for y, row in enumerate(rows):
        line = row[1:].reshape(width, 3).astype(np.int64)
        above = pixels[y, 1:]
        if row[0] in (0, 2):
            pixels[y + 1, 1:] = (line + (above if row[0] == 2 else 0)) % 256
            continue
        for x in range(width):
            left, corner, up = pixels[y + 1, x], pixels[y, x], pixels[y, x + 1]
            if row[0] == 1:
                guess = left
            elif row[0] == 3:
                guess = (left + up) // 2
            else:
                far = np.abs(np.stack([up - corner, left - corner, left + up - 2 * corner]))
                guess = np.choose(far.argmin(0), [left, up, corner])
            pixels[y + 1, x + 1] = (line[x] + guess) % 256
    return pixels[1:, 1:]


class Recipes(unittest.TestCase):
    def run_recipe(self, name, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder) / "a.png"
            done = subprocess.run(
                [sys.executable, "-W", "error", RECIPES / f"{name}.py", *arguments, "-o", picture],
                capture_output=True, text=True, env=os.environ, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""), name)
            pixels = pixels_of(picture)
            self.assertGreater(min(pixels.shape[:2]), 300)
            self.assertGreater(pixels.std(), 5, name)
            return done.stdout

    def test_each(self):
        names = {path.stem for path in RECIPES.glob("*.py")}
        self.assertEqual(names, set(SAYS))
        for name, pattern in SAYS.items():
            with self.subTest(name):
                self.assertRegex(self.run_recipe(name), re.compile(pattern, re.M))

    def test_files(self):
        for name in ("ambient_occlusion", "wall_thickness", "distance_slice", "turntable"):
            with self.subTest(name):
                self.run_recipe(name, SCENES / "torus.ply")

    def test_a_mesh_with_a_hole(self):
        world = grelha.read(SCENES / "torus.ply").world
        faces = world.faces[2:]
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "open.ply")
            rows = [*world.vertices.tolist(), *([3, *face] for face in faces.tolist())]
            body = "".join(" ".join(map(str, row)) + "\n" for row in rows)
            path.write_text("ply\nformat ascii 1.0\n"
                            f"element vertex {len(world.vertices)}\nproperty float x\n"
                            "property float y\nproperty float z\n"
                            f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
                            "end_header\n" + body)
            said = self.run_recipe("distance_slice", path)
        self.assertRegex(said, r"^4 open edges; 0\.[1-9]\d* of the slice is inside")

    def test_they_are_short(self):
        for path in RECIPES.glob("*.py"):
            self.assertLess(len(path.read_text().splitlines()), 66, path)


if __name__ == "__main__":
    unittest.main()
