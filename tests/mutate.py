#!/usr/bin/env python3
"""Feeds damaged copies of scenes to the program: none may crash, hang or silence it.

  tests/mutate.py build/asan/grelha SCENE... [--copies 200] [--render] [--seed 1] [--keep FOLDER]

Each scene is copied --copies times with bits flipped, its end cut off, words swapped, doubled,
dropped or replaced by hostile ones, always the same way for one seed. `grelha info` (with --render
also a 16x16 picture) of each copy must end within 10 s with status 0, 1 or 2, by no signal and
without a sanitizer's report; a status other than 0 comes with exactly one line that holds ": error:
", status 0 with none. Exits 1 when any copy failed; --keep saves those.
"""
import argparse
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

TIMEOUT_S = 10
HOSTILE = [
    b"nan", b"inf", b"-inf", b"1e39", b"-1", b"0", b"1e-45", b"4294967296", b"99999999999999999999",
    b"1e18", b"-0", b"#", b"s", b"p", b"pp", b"mesh", b"ply", b"v", b"x", b"\xff\xfe",
    b"2147483647", b"end_header", b"list"]
TROUBLE = re.compile(
    rb"(Address|Leak|Thread)Sanitizer|UndefinedBehavior|runtime error:|terminate called")


def flip_bits(data, rng):
    out = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 8, 64])):
        # Half of the flips near the start, where headers and views are.
        end = min(len(out), 600) if rng.random() < 0.5 else len(out)
        out[rng.randrange(end)] ^= 1 << rng.randrange(8)
    return bytes(out)


def truncate(data, rng):
    return data[:rng.randrange(len(data))]


def cut_out(data, rng):
    start = rng.randrange(len(data))
    return data[:start] + data[start + rng.choice([1, 2, 3, 16, 1000]):]


def words(data, rng):
    """Spans of some words: all of a short text, those of a window of a long one."""
    start = 0 if rng.random() < 0.5 else rng.randrange(len(data))
    return [(start + m.start(), start + m.end())
            for m in re.finditer(rb"[^\s]+", data[start:start + 4000])]


def swap_words(data, rng):
    spans = words(data, rng)
    if len(spans) < 2:
        return flip_bits(data, rng)
    (a, b), (c, d) = sorted(rng.sample(spans, 2))
    return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]


def replace_word(data, rng):
    spans = words(data, rng)
    if not spans:
        return flip_bits(data, rng)
    a, b = rng.choice(spans)
    new = rng.choice(HOSTILE + [b"", data[a:b] + b" " + data[a:b], data[a:b] + data[a:b]])
    return data[:a] + new + data[b:]


MUTATIONS = [flip_bits, truncate, cut_out, swap_words, replace_word]


def complaint(run, error_text):
    """Returns the error of one run, or None."""
    if run is None:
        return f"no end within {TIMEOUT_S} s"
    if run.returncode not in (0, 1, 2):
        return f"status {run.returncode}"
    if TROUBLE.search(error_text):
        return "a sanitizer's report"
    errors = sum(b": error: " in line for line in error_text.splitlines())
    if errors != (0 if run.returncode == 0 else 1):
        return f"status {run.returncode} with {errors} error lines"
    return None


def attempt(command):
    try:
        run = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                             timeout=TIMEOUT_S, check=False)
    except subprocess.TimeoutExpired:
        return None, b""
    return run, run.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--copies", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--render", action="store_true", help="also render each copy at 16x16")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the copies that failed")
    options = parser.parse_args()
    failures, statuses = 0, {}
    with tempfile.TemporaryDirectory() as folder_name:
        folder = pathlib.Path(folder_name)
        for scene in options.scenes:
            data = scene.read_bytes()
            work = folder / f"of-{scene.name}"
            work.mkdir(exist_ok=True)
            for sibling in scene.resolve().parent.iterdir():  # meshes the scene may name
                link = work / sibling.name
                if sibling.name != scene.name and sibling.is_file() and not link.exists():
                    link.symlink_to(sibling)
            for index in range(options.copies):
                rng = random.Random(f"{options.seed} {scene.name} {index}")
                damaged = data
                for _ in range(rng.choice([1, 1, 1, 2, 4])):
                    if damaged:
                        damaged = rng.choice(MUTATIONS)(damaged, rng)
                copy = work / scene.name
                copy.write_bytes(damaged)
                commands = [[options.program, "info", str(copy)]]
                if options.render:
                    picture = str(work / "picture.pfm")
                    commands.append([options.program, "render", str(copy), "--size", "16x16",
                                     "--quiet", "-o", picture])
                for command in commands:
                    run, error_text = attempt(command)
                    status = run.returncode if run else "timeout"
                    statuses[status] = statuses.get(status, 0) + 1
                    wrong = complaint(run, error_text)
                    if not wrong:
                        continue
                    failures += 1
                    print(f"{scene} copy {index}, {command[1]}: {wrong}\n"
                          f"{error_text[:1500].decode(errors='replace')}")
                    if options.keep:
                        options.keep.mkdir(parents=True, exist_ok=True)
                        shutil.copy(copy, options.keep / f"{index}-{scene.name}")
    counted = ", ".join(f"{n} with status {s}" for s, n in sorted(statuses.items(), key=str))
    print(f"{sum(statuses.values())} runs: {counted}; {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
