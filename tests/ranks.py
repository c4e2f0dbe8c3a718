#!/usr/bin/env python3
"""Renders by MPI: ranks.py PROGRAM SCENE [MPIRUN]

1 to 4 ranks make the bytes of one process; a rank that dies ends the run, and what the checkpoint
kept is gone on with by another number of ranks; so it is after SIGINT. Of several scenes all go on
after one that cannot be read; ranks given unequal options say so.
"""
import os, signal, subprocess, sys, tempfile, time

program, scene = map(os.path.abspath, sys.argv[1:3])
mpirun = sys.argv[3] if len(sys.argv) > 3 else "mpirun"
environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
job = [program, "render", os.path.abspath(scene), "--quiet", "--threads", "2", "--size", "150x107",
       "--samples", "200", "--lens", "3"]


def ranks(n, *more):
    # mpirun sends SIGTERM and, by default a second later, SIGKILL: too soon for what is in work
    # where processors are shared
    run_ranks = [mpirun, "--oversubscribe", "--mca", "odls_base_sigkill_timeout", "5", "-n", str(n)]
    return run_ranks + job + list(more)


def rank_of(pid):
    with open(f"/proc/{pid}/environ", "rb") as file:
        for word in file.read().split(b"\0"):
            if word.startswith(b"OMPI_COMM_WORLD_RANK="):
                return int(word.split(b"=")[1])


def processes(parent):
    with open(f"/proc/{parent}/task/{parent}/children") as file:
        return [int(pid) for pid in file.read().split()]


def want(truth, what):
    if not truth:
        sys.exit(what)


with tempfile.TemporaryDirectory() as folder:
    whole, picture, kept = (os.path.join(folder, n) for n in ("whole.pfm", "x.pfm", "kept"))

    def check_same(who):
        want(open(whole, "rb").read() == open(picture, "rb").read(), f"{who}: another picture")
        want(not os.path.exists(kept), f"{who}: the checkpoint is still there")
        os.remove(picture)

    begin = time.monotonic()
    subprocess.run(job + ["-o", whole], check=True)
    alone = time.monotonic() - begin
    for n in range(1, 5):
        subprocess.run(ranks(n, "-o", picture), check=True, env=environment)
        check_same(f"{n} ranks")

    small = ["--quiet", "--threads", "1", "--size", "30x20"]
    subprocess.run(job[:3] + small + ["-o", whole], check=True)
    for name in ("a.nff", "c.nff"):
        os.symlink(os.path.abspath(scene), os.path.join(folder, name))
    run = subprocess.run([
        mpirun, "--oversubscribe", "-n", "3", program, "render", "a.nff", "missing.nff", "c.nff",
        "-o", "{}.pfm"] + small, env=environment, cwd=folder, stderr=subprocess.PIPE, text=True)
    want(run.returncode == 1, f"with a scene missing: status {run.returncode}")
    want(run.stderr.count("error:") == 1 and "missing.nff: error: cannot open" in run.stderr,
         f"with a scene missing: {run.stderr}")
    for name in ("a.pfm", "c.pfm"):
        want(open(whole, "rb").read() == open(os.path.join(folder, name), "rb").read(),
             f"{name}: another picture")
    one = ["-n", "1", program, "render", os.path.join(folder, "a.nff"), "-o", picture] + small
    run = subprocess.run([mpirun, "--oversubscribe"] + one + ["--depth", "3", ":"] + one,
                         env=environment, stderr=subprocess.PIPE, text=True)
    want("grelha: error: rank 1 was given other options than the first\n" in run.stderr,
         f"unequal options: {run.stderr}")
    subprocess.run(job + ["-o", whole], check=True)

    for what, killed, message in (("a rank killed", 2, "rank 2"), ("SIGINT", None, "")):
        run = subprocess.Popen(
            ranks(3, "-o", picture, "--checkpoint", kept, "--checkpoint-every", str(alone / 50)),
            env=environment, stderr=subprocess.PIPE, text=True)
        while not os.path.exists(kept) and run.poll() is None:
            time.sleep(alone / 100)
        if killed is None:
            run.send_signal(signal.SIGINT)  # which mpirun makes a SIGTERM of
        else:
            for pid in processes(run.pid):
                if rank_of(pid) == killed:
                    os.kill(pid, signal.SIGKILL)
        said = run.communicate(timeout=60)[1]
        want(run.returncode != 0, f"{what}: ended as if all were well")
        want(message in said, f"{what}: {said}")
        if not os.path.exists(picture):  # else it came to its end first
            want(os.path.exists(kept), f"{what}: nothing is kept")
            subprocess.run(ranks(2, "-o", picture, "--checkpoint", kept), check=True,
                           env=environment)
        check_same(what)
        print(f"--- {what}:\n{said}")
print("ranks 1 to 4: the same bytes, also after a rank died")
