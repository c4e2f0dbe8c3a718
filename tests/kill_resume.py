#!/usr/bin/env python3
"""Kills renders and goes on with them: kill_resume.py PROGRAM SCENE [N [SEED]] [-- OPTIONS OF RENDER]

N times (3) a render with a checkpoint is killed (SIGKILL) after a random time, again and again, each time with other threads, until one
comes to its end; its picture must be that of an undisturbed one, byte for byte. Says how often it was killed, and how often it went on
from a checkpoint.
"""
import os, random, signal, subprocess, sys, tempfile, time

words = sys.argv[1:]
options = ["--size", "120x80", "--samples", "150", "--lens", "3", "--shadows", "random:.5"]
if "--" in words:
    options = words[words.index("--") + 1:]
    words = words[:words.index("--")]
program, scene = words[:2]
rounds = int(words[2]) if len(words) > 2 else 3
seed = int(words[3]) if len(words) > 3 else 1
rng = random.Random(seed)

with tempfile.TemporaryDirectory() as folder:
    whole, picture, checkpoint = (os.path.join(folder, n) for n in ("whole.pfm", "picture.pfm", "kept.grelha"))
    command = [program, "render", os.path.abspath(scene), "--quiet"] + options
    begin = time.monotonic()
    subprocess.run(command + ["-o", whole], check=True)
    alone = time.monotonic() - begin
    killed = resumed = 0
    for turn in range(rounds):
        for attempt in range(200):
            resumed += os.path.exists(checkpoint)
            run = subprocess.Popen(command + ["-o", picture, "--checkpoint", checkpoint, "--checkpoint-every", str(alone / 30),
                                              "--threads", str(rng.randint(1, 3))])
            try:
                run.wait(rng.uniform(0, .5 * alone))
                break
            except subprocess.TimeoutExpired:
                run.send_signal(signal.SIGKILL)
                run.wait()
                killed += 1
        if run.returncode != 0:
            sys.exit(f"seed {seed}, round {turn}: ended with {run.returncode}")
        if open(whole, "rb").read() != open(picture, "rb").read():
            sys.exit(f"seed {seed}, round {turn}: another picture")
        if os.path.exists(checkpoint):
            sys.exit(f"seed {seed}, round {turn}: the checkpoint is still there")
        os.remove(picture)
        left = [n for n in os.listdir(folder) if n != "whole.pfm" and not n.startswith(".grelha-") and n != "kept.grelha.new"]
        if left:
            sys.exit(f"seed {seed}, round {turn}: left behind {left}")
    print(f"{rounds} renders of {alone:.2f} s, killed {killed} times, went on {resumed} times: the same bytes")
    if resumed < rounds:
        sys.exit("too few went on from a checkpoint to have shown anything")
