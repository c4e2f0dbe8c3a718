#!/usr/bin/env python3
"""Plants known faults, one at a time, in a copy of the sources: the test named must turn red.

  tests/plant.py [--only PART OF A NAME] [--folder FOLDER] [--list]

A fault is a piece of text and what replaces it; one that is not found exactly once ends the script,
so that no fault is thought planted that is not. All are built without SIMD copies and with -O1, but
the one that wants copies, and -O3, where products and sums are contracted. Exits 1 when a test
stayed green. Takes some ten minutes; the list with its last outcome is in docs/numerics.md.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from faults import FAULTS

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(command, log, **more):
    with open(log, "ab") as out:
        return subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, **more).returncode


def configure(source, build, simd, log):
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    how = ["-DGRELHA_SIMD=OFF", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1"]
    if simd:
        how = ["-DGRELHA_SIMD=ON", "-DCMAKE_BUILD_TYPE=Release"]
    command = ["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DGRELHA_TESTS=ON",
               "-DGRELHA_PERF=OFF", *how, *launcher]
    if run(command, log):
        sys.exit(f"plant: {log}: no build can be set up")


def copy_sources(to):
    """All but builds and history; a file that is there already keeps its time, so that it is not
    built again."""
    def left_out(folder, names):
        return {"build", ".git"} & set(names) if pathlib.Path(folder) == ROOT else set()

    def copy(file, place):
        file, place = pathlib.Path(file), pathlib.Path(place)
        if not place.exists() or file.read_bytes() != place.read_bytes():
            shutil.copy(file, place)

    shutil.copytree(ROOT, to, dirs_exist_ok=True, ignore=left_out, copy_function=copy)


def outcome(source, fault, log):
    """Whether the fault's test passes on what the folder holds."""
    build = source / ("build-simd" if fault.simd else "build")
    if not build.exists():
        configure(source, build, fault.simd, log)
    if run(["ninja", "-C", build, f"{fault.test}_test"], log):
        sys.exit(f"plant: {log}: does not compile with '{fault.name}'")
    # A walk that has lost its way may not end: that is as red.
    try:
        command = [build / "tests" / f"{fault.test}_test", f"--gtest_filter={fault.cases}",
                   "--gtest_brief=1"]
        return run(command, log, timeout=300) == 0
    except subprocess.TimeoutExpired:
        return False


def position_of(fault):
    """The fault's text, however lines are broken: between words and signs any white space may
    stand."""
    return re.compile(r"\s*".join(
        re.escape(word) for word in re.findall(r"\w+|[^\w\s]", fault.old)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="faults whose name holds this")
    parser.add_argument(
        "--folder", type=pathlib.Path,
        help="where to copy to and build; a second run finds it built [a temporary one]")
    parser.add_argument("--list", action="store_true",
                        help="name the faults and their tests, and check that each can be planted")
    asked = parser.parse_args()
    faults = [f for f in FAULTS if asked.only in f.name]
    for f in faults:
        if (n := len(position_of(f).findall((ROOT / f.file).read_text()))) != 1:
            sys.exit(f"plant: '{f.name}': the text is found {n} times in {f.file}, not once")
        if asked.list:
            print(f"{f.name}: {f.file}; {f.test}_test {f.cases}")
    if asked.list:
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        source = asked.folder or pathlib.Path(temporary)
        copy_sources(source)
        green = []
        for f in faults:
            log, file = source / "plant.log", source / f.file
            sound = file.read_text()
            if not outcome(source, f, log):
                sys.exit(f"plant: {log}: {f.test}_test {f.cases} is red without '{f.name}'")
            file.write_text(position_of(f).sub(lambda _: f.new, sound))
            passed = outcome(source, f, log)
            file.write_text(sound)
            print(f"{'GREEN' if passed else 'red'}: {f.name}: {f.test}_test {f.cases}", flush=True)
            green += [f.name] * passed
        print(f"{len(faults) - len(green)} of {len(faults)} faults were noticed")
        return 1 if green else 0


if __name__ == "__main__":
    sys.exit(main())
