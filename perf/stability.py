#!/usr/bin/env python3
"""Counts the errors of ray tracers in hard cases: Grelha, and Embree in default and robust mode.

    ./run perf stability [--rays 1000000] [--pixels 128] [--keep]
                         [options of the benchmark: --rows PART OF A NAME, --seed N]

Runs perf/stability.cpp, prints its tables and names the rows that fail: no answer of Grelha may be
wrong. With --keep docs/stability.csv and a section of docs/numerics.md are
written; otherwise the CSV lies beside the program. The section has the rows of SHOWN, the CSV all.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
import bench

TRACERS = ["grelha", "embree", "embree robust"]
KINDS = ["lost", "false", "self"]
SHOWN = ["vertices of closed meshes", "closed meshes moved by 1e6", "slivers, grazed",
         "small triangles from far", "floor sphere of radius 1e5",
         "lids over floors", "mirror rays in a bowl on a ground",
         "odd directions", "rays of NaN and infinity", "lights behind needles and specks"]


def number(n):
    return f"{n:,}"


def cell(counts):
    """Lost, false and self-hits; a dash for 0 of all."""
    if counts is None:
        return ""
    if counts["aborts"]:
        return "aborts"
    return " + ".join(
        number(counts[k]) if k == "lost" else f"{number(counts[k])} {k}"
        for k in KINDS if counts[k]) or "0"


def rays_table(rows):
    names = [t for t in TRACERS if any(t in r["tracers"] for r in rows)]
    return bench.table(
        ["row", "condition", "answers", *names],
        [[r["name"], r["condition"], number(r["tracers"]["grelha"]["answers"]),
          *(cell(r["tracers"].get(t)) for t in names)] for r in rows])


def pictures_table(rows):
    return bench.table(
        ["row", "condition", "truth", "pixels", "wrong"],
        [[r["name"], r["condition"], r["truth"], number(r["pixels"]), number(r["wrong"])]
         for r in rows])


def costs_table(rows):
    def of(row, tracer):
        found = row["ratio"].get(tracer)
        return f"{found[0]:.2f}, {found[1]:.2f}" if found else "–"
    names = [t for t in TRACERS if any(t in r["ratio"] for r in rows)]
    return bench.table(["rays", *names], [[r["name"], *(of(r, t) for t in names)] for r in rows])


def section(data, command):
    """What the page shows."""
    rows = data["rows"]
    asked = sum(r["tracers"]["grelha"]["answers"] for r in rows)
    wrong = sum(r["tracers"]["grelha"][k] for r in rows for k in KINDS)
    return f"""\
Of {asked:,} answers in {len(rows)} rows Grelha gave {wrong:,} wrong. Some rows, by `{command}`
([all](stability.csv)); a bare number counts lost hits, *aborts*: an assertion of Embree ends the
program.

{rays_table([r for r in rows if r["name"] in SHOWN])}"""


def complaints(data):
    for r in data.get("rows", []):
        grelha = r["tracers"]["grelha"]
        if wrong := sum(grelha[k] for k in KINDS):
            yield f"{r['name']}: {wrong} wrong; {grelha['first']}"
    for r in data.get("pictures", []):
        if r["wrong"]:
            yield f"{r['name']}: {r['wrong']} wrong; {r['first']}"
    for r in data.get("costs", []):
        if r["name"] in ("NaN", "infinity", "zero direction") and max(r["ratio"]["grelha"]) > 2.5:
            yield f"{r['name']}: {max(r['ratio']['grelha']):.1f} times the time of ordinary rays"


def write_csv(data, path):
    with open(path, "w", newline="") as f:
        table = csv.writer(f, lineterminator="\n")
        table.writerow(["row", "condition", "truth", "tracer", "answers", *KINDS, "aborts"])
        for r in data.get("rows", []):
            for tracer, c in r["tracers"].items():
                table.writerow([
                    r["name"], r["condition"], r["truth"], tracer, c["answers"],
                    *(c[k] for k in KINDS), c["aborts"]])
        for r in data.get("pictures", []):
            table.writerow([
                r["name"], r["condition"], r["truth"], "grelha", r["pixels"], "", r["wrong"], "",
                ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0],
                                     epilog="Other options go to the benchmark.")
    parser.add_argument("--program", default=bench.ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--keep", action="store_true",
                        help="write docs/stability.csv and the section of docs/numerics.md")
    asked, rest = parser.parse_known_args()
    folder = pathlib.Path(asked.program).resolve().parent
    done = subprocess.run([folder / "stability", *rest], stdout=subprocess.PIPE, text=True)
    if not done.stdout:
        sys.exit(done.returncode or 1)
    data = json.loads(done.stdout)
    parts = []
    if "rows" in data:
        parts.append("Answers that are wrong, each ray asked for its closest hit and occlusion, "
                     "in packets and alone;\n*aborts*: an assertion ends the program.\n\n"
                     + rays_table(data["rows"]))
    if "pictures" in data:
        parts.append(f"Pictures, which Grelha alone makes:\n\n{pictures_table(data['pictures'])}")
    if "costs" in data:
        parts.append(
            "Time of odd rays against that of ordinary ones through 5,000 spheres, in packets and "
            "alone (Embree is not asked for what ends it):\n\n"
            + costs_table(data["costs"]))
    text = "\n\n".join(parts)
    print(text)
    write_csv(data, (bench.DOCS if asked.keep else folder) / "stability.csv")
    if asked.keep:
        bench.record("stability")
        command = (f"./run perf stability --rays {data['rays']} --pixels {data['pixels']} "
                   f"--seed {data['seed']}")
        bench.put_section(bench.DOCS / "numerics.md", "perf/stability.py", section(data, command))
    found = list(complaints(data))
    for line in found:
        print(f"stability: {line}", file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
