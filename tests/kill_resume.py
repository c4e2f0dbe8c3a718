#!/usr/bin/env python3
"""Kills renders and goes on with them.

    kill_resume.py PROGRAM SCENE [N [SEED]] [-- OPTIONS OF RENDER]

N times (3) a render with a checkpoint is killed (SIGKILL) after a random time, again and again,
each time with other threads, until one comes to its end; its picture must be that of an undisturbed
one, byte for byte. Says how often it was killed, and how often it went on from a checkpoint.
Without options: for every way there is to spend samples. Of a render by time (--time SECONDS) the
picture is that of the samples it says it took.
"""
import json, os, random, signal, subprocess, sys, tempfile, time

KINDS = (["--samples", "150", "--lens", "3", "--shadows", "random:.5"],
         ["--error", ".004", "--lens", "3", "--shadows", "random:.5"],
         ["--time", "2", "--lens", "3", "--shadows", "random:.5"],
         ["--aa", "adaptive:.05,4", "--lens", "3,0,2"])

words = sys.argv[1:]
kinds = [["--size", "120x80"] + kind for kind in KINDS]
if "--" in words:
    kinds = [words[words.index("--") + 1:]]
    words = words[:words.index("--")]
program, scene = words[:2]
rounds = int(words[2]) if len(words) > 2 else 3
seed = int(words[3]) if len(words) > 3 else 1
rng = random.Random(seed)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def repeatable(options, stats):
    """The options whose picture an interrupted render must have made."""
    if "--time" not in options or options[options.index("--time") + 1].startswith("samples:"):
        return options
    at = options.index("--time") + 1
    samples = json.loads(read(stats))["error"]["samples"]
    return options[:at] + [f"samples:{samples}"] + options[at + 1:]


def kill_and_resume(options, folder):
    names = ("whole.pfm", "picture.pfm", "kept.grelha", "stats.json")
    whole, picture, checkpoint, stats = (os.path.join(folder, n) for n in names)
    command = [program, "render", os.path.abspath(scene), "--quiet"]
    begin = time.monotonic()
    subprocess.run(command + options + ["-o", whole], check=True)
    alone = time.monotonic() - begin
    killed = resumed = 0
    for turn in range(rounds):
        for attempt in range(200):
            resumed += os.path.exists(checkpoint)
            run = subprocess.Popen(command + options + [
                "-o", picture, "--checkpoint", checkpoint, "--checkpoint-every", str(alone / 30),
                "--threads", str(rng.randint(1, 3)), "--stats", stats])
            # twice as long every 20 times: where the machine is busier than when `alone` was
            # measured, a render might otherwise never live until its next checkpoint
            patience = .5 * alone * 2 ** (attempt / 20)
            try:
                run.wait(rng.uniform(0, patience))
                break
            except subprocess.TimeoutExpired:
                run.send_signal(signal.SIGKILL)
                run.wait()
                killed += 1
        where = f"{' '.join(options)}, seed {seed}, round {turn}"
        if run.returncode != 0:
            sys.exit(f"{where}: ended with {run.returncode}")
        if repeatable(options, stats) != options:
            subprocess.run(command + repeatable(options, stats) + ["-o", whole], check=True)
        if read(whole) != read(picture):
            sys.exit(f"{where}: another picture")
        if os.path.exists(checkpoint) != ("--error" in options):  # a finer error goes on from it
            sys.exit(f"{where}: the checkpoint is {'gone' if '--error' in options else 'there'}")
        for file in (picture, stats, checkpoint):
            if os.path.exists(file):
                os.remove(file)
        left = [
            n for n in os.listdir(folder)
            if n != "whole.pfm" and not n.endswith(".grelha-tmp")]
        if left:
            sys.exit(f"{where}: left behind {left}")
    print(
        f"{' '.join(options)}: {rounds} renders of {alone:.2f} s, killed {killed} times, went on "
        f"{resumed} times: the same bytes",
        flush=True)
    if resumed < rounds:
        sys.exit("too few went on from a checkpoint to have shown anything")


for options in kinds:
    with tempfile.TemporaryDirectory() as folder:
        kill_and_resume(options, folder)
