#!/usr/bin/env python3
"""Instructions of NEON beside those of SSE2, which has as many lanes: whole pictures, emulated.

    ./run perf neon [--keep]

Needs the build of `./run test-arm`. Both programs run under qemu-user, which logs each instruction.
A picture of one sample is taken from one of five, so that loading and building drop out. The rays
are the same, since the pictures are. --keep writes the table into docs/performance.md.
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import ROOT, Bench, arguments, commit, table

SCENES = {  # and what their rays meet
    "balls.nff": "spheres, mirrors, shadows", "torus.ply": "triangles, shadows",
    "columns.nff": "cones, shadows", "concave.nff": "triangles of polygons",
    "glass.nff": "spheres, triangles, glass"}
LOG = ["-singlestep", "-d", "exec,nochain", "-D", "/dev/stdout"]
MOST = 1.2


def neon(folder):
    root = ROOT / "build/arm64-root"
    return ["qemu-aarch64", *LOG, "-L", root, "-E", f"LD_LIBRARY_PATH={folder}", folder / "grelha"]


def instructions(program, isa, scene, samples, picture):
    """Of a render of 16 x 16 pixels."""
    words = [*program, "render", ROOT / "scenes/data" / scene, "-o", picture, "--size", "16x16",
             "-j", "1", "-q", "--isa", isa, "--samples", str(samples)]
    with subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE) as run:
        count = sum(block.count(b"\n") for block in iter(lambda: run.stdout.read(1 << 20), b""))
    if run.returncode:
        sys.exit(f"neon: {words[-3]} ended with {run.returncode}")
    return count


def main():
    bench = Bench("neon", arguments(__doc__, 1).parse_args())
    arm = ROOT / "build/arm64"
    if not (arm / "grelha").exists():
        sys.exit("neon: there is no build for ARM; `./run test-arm` makes it")
    programs = {"sse2": ["qemu-x86_64", *LOG, bench.program], "neon": neon(arm)}
    rows, over = [], []
    for scene, what in SCENES.items():
        a_sample, pictures = {}, set()
        for isa, program in programs.items():
            picture = bench.folder / f"{scene}-{isa}.pfm"
            one, five = (instructions(program, isa, scene, n, picture) for n in (1, 5))
            a_sample[isa] = (five - one) / (4 * 256)
            pictures.add(picture.read_bytes())
        ratio = a_sample["neon"] / a_sample["sse2"]
        over += [scene] * (ratio > MOST)
        rows.append([f"{scene}: {what}", f"{a_sample['sse2']:.0f}", f"{a_sample['neon']:.0f}",
                     f"{ratio:.2f}", "yes" if len(pictures) == 1 else "**no**"])
        print(*rows[-1], flush=True)
    head = ["scene", "SSE2: instructions a sample", "NEON", "ratio", "same picture"]
    bench.section(f"{table(head, rows)}\n\nCommit {commit()}, both by qemu-user, 16 x 16 pixels. "
                  "`./run perf neon`.")
    sys.exit(f"neon: above {MOST}: {', '.join(over)}" if over else 0)


if __name__ == "__main__":
    main()
