#!/usr/bin/env python3
"""Compares the speed and the answers of this checkout with those of another tree of Grelha.

    ./run perf ab TREE [OPTIONS]

TREE is a folder with another checkout, such as `git worktree add` makes; it needs no build. The hot
loops of both become shared libraries below build/ab. One process times them in turns on the same
rays and compares every answer bit by bit; perf/ab/host.cpp. A ratio above 1: this tree is slower.
With --count, instructions of both are counted by Callgrind: exact, however loaded the machine is.
The exit status is 1 if answers differ.

A scene is a row of SCENES, `GENERATOR SIZE`, or a file. Modes: as a render traces rays, by calls of
one ray, by streams of eight, and as a render without t.
"""
import argparse
import csv
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
from datetime import date

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "lib"), str(HERE / "ab")]
from build_copies import ISAS, build_copies, runs  # noqa: E402
from machine import cpu_name  # noqa: E402

ROOT = HERE.parent
# Below --scenes, or of the generators
SCENES = {"bunny": "ply/bunny.ply", "dragon": "ply/dragon.ply", "horse": "ply/horse.ply",
          "blade": "ply/turbineblade.ply", "stadium": "stadium 6", "mount 8": "mount 8",
          "balls 4": "balls 4", "balls 5": "balls 5", "rings": "rings 7", "tree": "tree 11"}
KINDS = ("primary", "lens", "area", "glossy", "scattered", "shadow", "mirror", "vertices", "edges")
MODES = ("render", "calls", "streams", "no-t")
LOST = 1.04  # ratios above are told as lost: 4 %, about what a busy machine gives by chance
WORST = 5


def asked_for():
    parser = argparse.ArgumentParser(prog="ab", description=__doc__.partition("\n")[0])
    parser.add_argument("tree", type=pathlib.Path, metavar="TREE", help="another checkout")
    parser.add_argument("--scene", action="append", metavar="NAME",
                        help=f"repeatable; a file, GENERATOR SIZE, or of [{', '.join(SCENES)}]")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, help="of rays [all]")
    parser.add_argument("--modes", nargs="+", choices=MODES, default=MODES[:3],
                        help="[render calls streams]")
    parser.add_argument("--rounds", type=int, default=9, help="the least time of them counts [9]")
    parser.add_argument("--size", type=int, help="pixels across [512; 128 with --count]")
    parser.add_argument("--isa", choices=ISAS, help="[avx2, where there is one]")
    parser.add_argument("--embree", action="store_true", help="beside Embree robust")
    parser.add_argument("--count", action="store_true", help="instructions instead of time")
    parser.add_argument("-o", dest="csv", type=pathlib.Path, metavar="CSV", help="write every cell")
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT.parent / "shared/scenes",
                        help="folder of the scans [../shared/scenes]")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/ab",
                        help="folder of what is built [build/ab]")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/grelha",
                        help="ab_host stands beside it [build/release/grelha]")
    asked = parser.parse_args()
    asked.isa = asked.isa or ("avx2" if runs("avx2") else "scalar")
    asked.size = asked.size or (128 if asked.count else 512)
    for wrong, why in (
            (not (asked.tree / "kernel/query/variants.hpp").exists(),
             f"{asked.tree} is no checkout of Grelha"),
            (not runs(asked.isa), f"this processor has no {asked.isa}"),
            (asked.size < 32, "--size: at least 32"),
            (asked.rounds < 1, "--rounds: at least 1"),
            (asked.count and asked.isa == "avx512", "Callgrind knows no AVX-512: take --isa avx2"),
            (asked.count and asked.embree, "--count: the instructions of Embree are not counted"),
            (asked.count and not shutil.which("valgrind"),
             "there is no valgrind (apt-get install valgrind)")):
        if wrong:
            print("ab: error:", why, file=sys.stderr)
            sys.exit(2)
    return asked


def commit_of(tree):
    """Its short name, "-dirty" where files differ from it."""
    if not shutil.which("git"):
        return "of no name: there is no git"
    def git(*words):
        return subprocess.run(["git", "-C", tree, *words], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True).stdout.strip()
    if pathlib.Path(git("rev-parse", "--show-toplevel") or "/").resolve() != tree:
        return "no commit"  # a plain copy, perhaps in a folder of another repository
    return git("describe", "--always", "--dirty", "--exclude=*")


def scene_files(asked):
    """Names, and what the host is told; what is not there is skipped."""
    for name in asked.scene or SCENES:
        told = SCENES.get(name, name)
        if name in SCENES and "/" in told:
            told = asked.scenes / told
            if not told.exists():
                print(f"{name} is skipped: there is no {told}", file=sys.stderr)
                continue
        yield name, str(told)


def counts(folder):
    """Instructions of each call of ab_run, in their order."""
    dumps = sorted(folder.glob("out.*"), key=lambda p: int(p.suffix[1:]))
    totals = [int(line.split()[1]) for dump in dumps for line in open(dump)
              if line.startswith("totals:")]
    return [n for n in totals if n]  # the last dump is that of the program's end


class Run:
    """Two libraries, and all that is measured of them."""

    def __init__(self, asked, libraries):
        self.asked, self.libraries, self.cells = asked, libraries, []

    def host(self, scene):
        asked = self.asked
        return [asked.program.resolve().parent / "ab_host", "--other", self.libraries[0], "--this",
                self.libraries[1], "--scene", scene, "--kinds", ",".join(asked.kinds), "--modes",
                ",".join(asked.modes), "--rounds", str(1 if asked.count else asked.rounds),
                "--size", str(asked.size), "--embree", str(int(asked.embree))]

    def measure(self, name, scene):
        """Tells each cell when it is there."""
        with subprocess.Popen(self.host(scene), stdout=subprocess.PIPE, text=True) as host:
            for row in csv.DictReader(host.stdout):
                self.add(name, row, float(row["other_ns"]), float(row["this_ns"]))
        if host.returncode:
            sys.exit(host.returncode)

    def count(self, name, scene):
        folder = self.asked.work / "counts"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        done = subprocess.run([
            "valgrind", "-q", "--tool=callgrind", "--toggle-collect=ab_run", "--dump-after=ab_run",
            f"--callgrind-out-file={folder}/out", *self.host(scene)], stdout=subprocess.PIPE,
            text=True)
        if done.returncode:
            sys.exit(done.returncode)
        rows, each = list(csv.DictReader(done.stdout.splitlines())), counts(folder)
        if len(each) != 2 * len(rows):
            sys.exit(f"ab: {len(each)} counts of {len(rows)} cells, in {folder}")
        for row, other, this in zip(rows, each[::2], each[1::2]):
            self.add(name, row, other / int(row["rays"]), this / int(row["rays"]))

    def add(self, name, row, other, this):
        cell = {"scene": name, "kind": row["kind"], "mode": row["mode"], "rays": int(row["rays"]),
                "other": other, "this": this, "ratio": this / other,
                "embree": float(row["embree_ns"] or "nan"), "differing": int(row["differing"])}
        if not self.cells:
            unit = "instructions a ray" if self.asked.count else "ns a ray"
            beside = f"{'Embree':>9} {'ratio':>6}" if self.asked.embree else ""
            print(f"{unit}\n{'scene':9} {'kind':9} {'mode':8}{'other':>9} {'this':>9} {'ratio':>6} "
                  f"{beside}")
        beside = f"{cell['embree']:9.1f} {this / cell['embree']:6.2f}" if self.asked.embree else ""
        differ = f"  {cell['differing']} of {cell['rays']} answers differ"
        print(f"{name:9} {cell['kind']:9} {cell['mode']:8}{other:9.1f} {this:9.1f} "
              f"{cell['ratio']:6.3f} {beside}{differ if cell['differing'] else ''}", flush=True)
        self.cells.append(cell)


def mean(cells):
    return statistics.geometric_mean(c["ratio"] for c in cells)


def named(cell):
    return f"{cell['scene']}, {cell['kind']}, {cell['mode']} {cell['ratio']:.3f}"


def summary(cells):
    kinds = [(k, [c for c in cells if c["kind"] == k]) for k in KINDS]
    worst = sorted(cells, key=lambda c: -c["ratio"])[:WORST]
    lost = sum(c["ratio"] > LOST for c in cells)
    differing = sum(c["differing"] > 0 for c in cells)
    answers = f"answers differ in {differing} cells" if differing else "all answers are the same"
    return "\n".join((
        "geometric means: " + ", ".join(f"{k} {mean(some):.3f}" for k, some in kinds if some),
        f"over all {len(cells)} cells: {mean(cells):.3f}",
        "worst: " + "; ".join(map(named, worst)),
        f"{lost} of {len(cells)} cells lost more than {100 * (LOST - 1):.0f} %; {answers}"))


def write_csv(path, cells, about, count):
    unit = "instructions" if count else "ns"
    with open(path, "w", newline="") as f:
        f.write(f"# {about}\n")
        table = csv.writer(f, lineterminator="\n")
        table.writerow(["scene", "kind", "mode", "rays", f"other_{unit}", f"this_{unit}", "ratio",
                        "embree_ns", "differing"])
        for c in cells:
            table.writerow([
                c["scene"], c["kind"], c["mode"], c["rays"], f"{c['other']:.2f}",
                f"{c['this']:.2f}", f"{c['ratio']:.4f}",
                "" if math.isnan(c["embree"]) else f"{c['embree']:.2f}", c["differing"]])


def main():
    asked = asked_for()
    trees = [asked.tree.resolve(), ROOT]
    about = (f"commit {commit_of(ROOT)} beside {commit_of(trees[0])}, {asked.isa}, one thread of "
             f"{cpu_name()}, {date.today()}")
    print(about, flush=True)
    run = Run(asked, build_copies(trees, asked.work.resolve(), asked.isa,
                                  asked.program.resolve().parent))
    for name, scene in scene_files(asked):
        (run.count if asked.count else run.measure)(name, scene)
    if not run.cells:
        sys.exit("ab: no such rays in these scenes")
    print("\n" + summary(run.cells))
    if asked.csv:
        write_csv(asked.csv, run.cells, about, asked.count)
    sys.exit(any(c["differing"] for c in run.cells))


if __name__ == "__main__":
    main()
