"""How far a picture lies from its reference, and how references are made and kept: what error_suite
and charts share."""
import hashlib
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

from bench import ROOT

REFERENCE_SEEDS = (1001, 1002)


class Refused(Exception):
    """The program does not know an option, or refuses it here."""


def read_pfm(path):
    with open(path, "rb") as f:
        if f.readline().strip() != b"PF":
            raise ValueError(f"{path}: not a colour PFM")
        width, height = map(int, f.readline().split())
        order = "<" if float(f.readline()) < 0 else ">"
        pixels = np.frombuffer(f.read(), order + "f4", width * height * 3)
    return pixels.reshape(height, width, 3)[::-1].astype(np.float64)  # rows are stored bottom first


def rmse(a, b):
    return float(np.sqrt(np.mean((np.clip(a, 0, 1) - np.clip(b, 0, 1)) ** 2)))


def blurred(plane):
    """By a Gaussian of 11 x 11 and sigma 1.5, whole windows only."""
    kernel = np.exp(-np.arange(-5, 6) ** 2 / (2 * 1.5 ** 2))
    for axis in (0, 1):
        plane = np.apply_along_axis(np.convolve, axis, plane, kernel / kernel.sum(), mode="valid")
    return plane


def ssim(a, b):
    """Structural similarity of Wang, Bovik, Sheikh and Simoncelli (2004) with their window and
    constants, of the luma (Rec. 601) of the displayed values; 1 for equal pictures."""
    x, y = (np.clip(picture, 0, 1) @ [.299, .587, .114] for picture in (a, b))
    mx, my = blurred(x), blurred(y)
    vx, vy, both = blurred(x * x) - mx * mx, blurred(y * y) - my * my, blurred(x * y) - mx * my
    c1, c2 = .01 ** 2, .03 ** 2
    return float(
        np.mean((2 * mx * my + c1) * (2 * both + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2))))


class Workshop:
    """Renders square pictures into a folder of its own, where scenes and references stay."""

    def __init__(self, program, folder, size):
        self.program = pathlib.Path(program).resolve()
        self.folder = self.program.parent / folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.size = ["--size", f"{size}x{size}"]

    def scene(self, source):
        """Of a generator's name and size, or of a file of the project."""
        if isinstance(source, str):
            return ROOT / source
        name, size = source
        path = self.folder / f"{name}-{size}.nff"
        subprocess.run([self.program, "scene", name, "--size", str(size), "-o", path], check=True)
        return path

    def info(self, scene):
        return json.loads(
            subprocess.run([self.program, "info", "--json", scene], check=True,
                           stdout=subprocess.PIPE, text=True).stdout)

    def command(self, source, options, tail=()):
        """Returns the command that repeats a render; `tail`: lines added to its scene."""
        name, make = str(source), ""
        if not isinstance(source, str):
            name = f"{source[0]}-{source[1]}.nff"
            make = f"./run scene {source[0]} --size {source[1]} -o {name} && "
        if tail:
            make += "printf '%s\\n' " + " ".join(f"'{line}'" for line in tail) + f" >> {name} && "
        return make + " ".join([
            "./run render", name, "-o p.pfm --stats p.json", *self.size, *map(str, options)])

    def render(self, scene, options, picture):
        stats = self.folder / "stats.json"
        done = subprocess.run([
            self.program, "render", scene, "-o", picture, "--quiet", "--stats", stats, *self.size,
            *map(str, options)], stderr=subprocess.PIPE, text=True)
        if done.returncode == 2:
            raise Refused(done.stderr.strip())
        if done.returncode:
            sys.exit(done.stderr)
        return json.loads(stats.read_text())

    def reference(self, scene, options, samples):
        """The mean of two halves, and the error it is estimated to have."""
        halves = []
        for seed in REFERENCE_SEEDS:
            settings = reference_settings(options, samples, seed)
            words = "\0".join([*map(str, settings), *self.size]).encode() + scene.read_bytes()
            path = self.folder / f"{scene.stem}-{hashlib.sha256(words).hexdigest()[:16]}.pfm"
            if not path.exists():
                self.render(scene, settings, path.with_suffix(".part.pfm"))
                path.with_suffix(".part.pfm").rename(path)
            halves.append(read_pfm(path))
        return (halves[0] + halves[1]) / 2, rmse(*halves) / 2


def turns(plan, spent):
    """Numbers the renders of a set that takes turns: `spent()` tells the CPU seconds so far. As
    many as the plan's rounds, and of short renders up to four times as many while they come to less
    than the seconds a set is given."""
    for turn in range(4 * plan.rounds):
        if turn >= plan.rounds and spent() * (turn + 1) / turn > plan.seconds:
            return
        yield turn


def reference_settings(options, samples, seed):
    return [*options, "--sampler", "sobol", "--samples", str(samples // 2), "--seed", str(seed)]


def time_to_reach(curve, error):
    """Of points with `rmse` and `seconds`: by the last two neighbours in time on either side of
    `error`, on straight lines of the log-log chart; None where there are none. The last: a sample
    that misses what is small looks as good as a thousand."""
    curve = sorted((math.log(p["seconds"]), math.log(p["rmse"])) for p in curve if p["rmse"] > 0)
    at = math.log(error)
    for (t0, e0), (t1, e1) in reversed(list(zip(curve, curve[1:]))):
        if e0 != e1 and min(e0, e1) <= at <= max(e0, e1):
            return math.exp(t0 + (t1 - t0) * (at - e0) / (e1 - e0))
    return None
