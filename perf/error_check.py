#!/usr/bin/env python3
"""What --error promises against what it keeps, on scene files of your own.

    ./run perf error_check [--size N] [--samples N] SCENE...

For each scene and each E of .02, .01 and .005: the true RMSE in display units (channels cut to 0 to
1) against a reference of another seed, the RMSE the run claimed, its samples a pixel and its time,
as rows of a Markdown table. A scene passes when the true RMSE is at most E, when that of the pixels
that got more than the smallest number of samples is at least E / 3, and when the claim is within 30
% of the truth. Rows in which the whole picture's is below E / 3 are marked.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import ROOT  # noqa: E402
from image_error import read_pfm, rmse  # noqa: E402

ERRORS = (.02, .01, .005)
REFERENCE_SEED, SEED = 1001, 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="[build/release/grelha]")
    parser.add_argument("--size", type=int, default=192, help="side of the pictures [192]")
    parser.add_argument("--samples", type=int, default=4096,
                        help="of the reference, a pixel [4096]")
    parser.add_argument("scenes", nargs="+", type=pathlib.Path, metavar="SCENE")
    asked = parser.parse_args()
    failures = 0
    print("| scene | asked | true RMSE | true / asked | of the pixels sampled more "
          "| claimed / true | samples a pixel | seconds |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        picture, samples, stats = (pathlib.Path(folder) / name
                                   for name in ("picture.pfm", "samples.pfm", "stats.json"))

        def render(scene, *options):
            command = [
                asked.program, "render", scene, "-o", picture, "--stats", stats, "--quiet",
                "--size", f"{asked.size}x{asked.size}", *map(str, options)]
            subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
            return read_pfm(picture), json.loads(stats.read_text())

        for scene in asked.scenes:
            reference, _ = render(scene, "--samples", asked.samples, "--seed", REFERENCE_SEED)
            for error in ERRORS:
                image, told = render(scene, "--error", error, "--seed", SEED, "--samples-map",
                                     samples)
                true, claim = rmse(image, reference), told["error"]
                taken = read_pfm(samples)[..., 0]
                more = taken > taken.min()
                beyond = rmse(image[more], reference[more]) if more.any() else math.inf
                met = true <= error and beyond >= error / 3 and abs(claim["rmse"] / true - 1) <= .3
                failures += not met
                print(
                    f"| {scene.name} | {error:g} | {true:.2g} | "
                    f"{true / error:.2f}{' (below a third)' if true < error / 3 else ''} | "
                    f"{beyond / error:.2f} of {100 * more.mean():.1f} % | "
                    f"{claim['rmse'] / true:.2f} | {claim['samples'] / asked.size ** 2:.1f} | "
                    f"{told['seconds']['render']:.2f} |{'' if met else ' **not met**'}", flush=True)
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
