#!/usr/bin/env python3
"""page_blocks.py ROOT PROGRAM SCRATCH [BUILD]: the blocks of every page, in order. Those of a shell
are run, those of C and C++ are compiled by a test or are pieces of a file that is. BUILD: what
`cmake --install` may install. Blocks of Python have a test of their own."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

SKIPPED = {  # lines that begin so are not run: why
    "sudo ": "needs root",
    "./run test": "minutes: all tests",
    "./run scene terrain --size 200": "gigabytes: 20 million triangles",
    "./run info terrain.nff": "gigabytes",
    "/usr/bin/time -v ./run render terrain": "gigabytes",
    "cmake --preset": "minutes: a build",
    "cmake --build": "minutes: a build",
    "git clone ": "needs a network",
    "tests/fuzz/campaign.sh": "half an hour a target, by clang",
    "build/fuzz/": "clang's libFuzzer",
    "job=$(sbatch": "needs Slurm; the test farm_script has a stand-in",
    "sbatch ": "needs Slurm; the test farm_script has a stand-in",
    "ffmpeg ": "needs ffmpeg",
    "mpirun ": "needs MPI; the test ranks has it",
    'eval "$(./run python)"': "minutes: a build",
    "python3 ": "needs the module; its own tests have it",
    "environment/bin/python": "minutes: a build",
}
COMPILED = {  # how the blocks of C and C++ of a page are tested
    ("docs/library.md", "cpp"): "tests/library/CMakeLists.txt",
    ("docs/library.md", "c"): "tests/library/CMakeLists.txt",
    ("docs/shapes.md", "cpp"): "tests/fifth_kind/disc.hpp",
}
SCENE = ("v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 2 600\n"
         "l 5 5 5\nf 1 0 0 1 0 1 0 1\ns 0 0 0 1\n")  # as many rows as parts.md divides
RUN = """#!/bin/sh
# in place of ./run, which would build
case $1 in render | info | scene | compare | merge) exec grelha "$@" ;; esac
echo "no command of the program: $1"
exit 2
"""


def blocks(text):
    """Language and lines of each block."""
    for block in re.finditer(r"^```(\w+)\n(.*?)^```$", text, re.M | re.S):
        yield block[1], block[2].splitlines()


def plain(line):
    """Without a comment, and without what tells a declaration from a definition."""
    return " ".join(re.sub(r"\s*//.*", "", line).split()).rstrip(" ;{}")


def is_excerpt(lines, file):
    """Whether the lines stand in a file in this order."""
    text, at = " ".join(plain(line) for line in file.read_text().splitlines()), 0
    for line in map(plain, lines):
        at = text.find(line, at)
        if at < 0:
            return False
    return True


def code_is_tested(root, page, language, lines):
    how = COMPILED.get((page, language))
    if not how:
        return f"{page} has a block of {language} that no test compiles"
    source = root / how
    if source.name == "CMakeLists.txt":  # it takes every block of the language
        known = re.search(rf"grelha_blocks\(\S+ {language} ", source.read_text())
        return "" if known and page in source.read_text() else f"{how} leaves out {page}"
    return "" if is_excerpt(lines, source) else f"{page}: a block is no piece of {how}"


class Shell:
    """One page's folder, in which its blocks run one after the other."""

    def __init__(self, root, program, scratch, build):
        self.build, self.scratch = build, scratch
        self.prefix = scratch / "prefix"
        scratch.mkdir(parents=True)
        (scratch / "bin").mkdir()
        (scratch / "bin/grelha").symlink_to(program)
        (scratch / "run").write_text(RUN)
        (scratch / "run").chmod(0o755)
        (scratch / "scenes").symlink_to(root / "scenes")
        (scratch / "S.nff").write_text(SCENE)
        for name in ("first_hit.cpp", "first_hit.c"):
            shutil.copy(root / "examples" / name, scratch)
        self.places = {"/usr/share/grelha/scenes": root / "scenes/data", "PREFIX": self.prefix,
                       "build/release": build}

    def run(self, lines):
        """What went wrong, or nothing."""
        code = "\n".join(lines)
        code = re.sub("|".join(self.places), lambda name: str(self.places[name[0]]), code)
        done = subprocess.run(
            ["sh", "-eu", "-c", code], cwd=self.scratch, capture_output=True, text=True,
            timeout=300, stdin=subprocess.DEVNULL,
            env=os.environ | {
                "PATH": f"{self.scratch / 'bin'}:{os.environ['PATH']}",
                "PKG_CONFIG_PATH": ":".join(
                    str(pc.parent) for pc in self.prefix.glob("**/grelha.pc"))})
        return f"\n{code}\nended with {done.returncode}:\n{done.stderr}" if done.returncode else ""


def unskipped(lines, skipped, installs):
    """The lines to run; the others are counted by their beginning."""
    left = []
    for line in lines:
        why = next((begin for begin in SKIPPED if line.startswith(begin)), None)
        if why:
            skipped[why] = skipped.get(why, 0) + 1
        elif line.strip() and (installs or "pkg-config" not in line and "--install" not in line):
            left.append(line)
    return left


def picture_differs(root, program, made):
    shown = root / "docs/images/balls.png"
    done = subprocess.run([program, "compare", made, shown, "--max-rmse", "0"],
                          capture_output=True)
    return "docs/images/balls.png is not what the README makes" if done.returncode else ""


def main():
    root, program, scratch = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    build = pathlib.Path(sys.argv[4]).resolve() if sys.argv[4:] else None
    installs = build and shutil.which("pkg-config")
    shutil.rmtree(scratch, ignore_errors=True)
    wrong, skipped, run = [], {}, 0
    for page in (root / "README.md", root / "CONTRIBUTING.md", *sorted(root.glob("docs/*.md"))):
        name, shell = str(page.relative_to(root)), None
        for language, lines in blocks(page.read_text()):
            if language in ("c", "cpp"):
                wrong.append(code_is_tested(root, name, language, lines))
            elif language == "sh":
                shell = shell or Shell(root, program, scratch / page.stem, build)
                lines = unskipped(lines, skipped, installs)
                run += len(lines)
                failure = shell.run(lines)
                wrong.append(failure and name + ": " + failure)
            elif language != "python":
                wrong.append(f"{name}: a block of {language}, which nothing tests")
    wrong.append(picture_differs(root, program, scratch / "README/balls.png"))
    wrong += [f"nothing begins with {begin}: not skipped" for begin in SKIPPED
              if begin not in skipped]
    wrong = [what for what in wrong if what]
    for begin, count in skipped.items():
        print(f"skipped {count} lines {begin}...: {SKIPPED[begin]}")
    print(f"{run} lines of the shell were run" + ("" if installs else "; nothing was installed"))
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
