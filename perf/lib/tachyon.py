"""Runs Tachyon for frame.py: the most similar ray tracer, with grids, threads and SPD's scenes."""
import re
import shutil
import subprocess

from nff_to_tachyon import convert


class Tachyon:
    def __init__(self, folder, side):
        self.folder, self.side, self.program = folder, side, shutil.which("tachyon")

    def render(self, text, depth):
        """Seconds of one thread: of preprocessing and tracing, as it tells them."""
        (self.folder / "scene.tac").write_text(convert(text, depth))
        done = subprocess.run(
            [self.program, "scene.tac", "-numthreads", "1", "-fullshade", "-format", "PNG",
             "-res", str(self.side), str(self.side), "-o", "tachyon.png"],
            cwd=self.folder, stdout=subprocess.PIPE, text=True, check=True)
        return sum(float(re.search(rf"{what} Time: +([\d.]+)", done.stdout)[1])
                   for what in ("Preprocessing", "Ray Tracing"))
