#!/usr/bin/env python3
"""Charts of speed against accuracy, as CSV and SVG in docs/.

    ./run charts [picture] [grid] [features] [--quick] [--rounds N] [--draw]

Without a name, all. Every point tells the command that repeats it: in the CSV, and in the SVG when
the mouse rests on it. --quick: smaller pictures, fewer points, kept in the build folder and not in
docs/. --draw: the charts from the CSVs in docs/. References are stored in the build folder and
rendered again when their scene or options change (delete charts/ there when the program draws other
pictures).
"""
import argparse
import csv
import dataclasses
import importlib
import pathlib
import resource
import sys
import textwrap
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "lib"), str(HERE / "charts")]
from bench import (  # noqa: E402
    DOCS, DRAW_HELP, ROOT, cpu_name, read_csv, record, table)
from chart import draw  # noqa: E402
from image_error import Workshop  # noqa: E402

NAMES = ("picture", "grid", "features")


@dataclasses.dataclass
class Plan:
    rounds: int
    seconds: float  # of CPU time for what takes turns, before rounds are added
    size: int       # side of pictures whose error is measured
    side: int       # and of pictures that are only timed
    scenes: int     # at most so many
    settings: int   # of each method, at most
    reference: int  # samples a pixel
    quick: bool = True


FULL = Plan(rounds=5, seconds=12, size=128, side=256, scenes=99, settings=99, reference=16384,
            quick=False)
QUICK = Plan(rounds=2, seconds=.5, size=64, side=128, scenes=99, settings=4, reference=4096)
# of the tests: does it run at all
SMOKE = Plan(rounds=1, seconds=0, size=16, side=16, scenes=1, settings=3, reference=64)


def write_csv(path, header, rows):
    with open(path, "w", newline="") as f:
        lines = csv.writer(f, lineterminator="\n")
        lines.writerow(header)
        lines.writerows(rows)


def spent():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def measured(name, module, shop, plan):
    start, cpu = time.monotonic(), spent()
    result = module.measure(shop, plan)
    print(
        f"{name}: {time.monotonic() - start:.0f} s, of it {spent() - cpu:.0f} CPU seconds of what "
        "was measured",
        flush=True)
    return result


def wrapped(text):
    """Its paragraphs in lines; tables as they are."""
    fill = textwrap.TextWrapper(width=100, break_long_words=False, break_on_hyphens=False).fill
    return "\n\n".join(block if block.startswith("|") else fill(block)
                       for block in text.split("\n\n"))


def make(name, shop, asked, plan, out):
    """Measures it unless asked only to draw, draws it and tells it."""
    module = importlib.import_module(name)
    where = f"Drawn from charts-{name}.csv. `./run charts {name}` measures it."
    if not asked.draw:
        write_csv(out / f"charts-{name}.csv", *module.csv(measured(name, module, shop, plan)))
        where = f"{cpu_name()}; the least of {plan.rounds} renders or more. `./run charts {name}`"
    result = module.from_csv(read_csv(f"charts-{name}", out))
    for chart in module.charts(result):
        draw(chart, out / "images" / f"charts-{chart['name']}.svg",
             shop.folder / f"charts-{chart['name']}.png")
    told = wrapped(f"{module.tell(result, table)}\n\n{where}")
    print(told, flush=True)
    if out == DOCS and not asked.draw:
        record(f"charts-{name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="[build/release/grelha]")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"{', '.join(NAMES)} [all]")
    parser.add_argument("--quick", action="store_true",
                        help="three minutes instead of thirty; nothing kept in docs/")
    parser.add_argument("--draw", action="store_true", help=DRAW_HELP)
    parser.add_argument("--smoke", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--rounds", type=int,
                        help="renders of each point, the least time counts [5; quick 2]")
    asked = parser.parse_args()
    if unknown := set(asked.names) - set(NAMES):
        parser.error(f"no such chart: {', '.join(sorted(unknown))}; there are {', '.join(NAMES)}")
    plan = SMOKE if asked.smoke else QUICK if asked.quick else FULL
    if asked.rounds:
        plan = dataclasses.replace(plan, rounds=asked.rounds)
    name = "charts-smoke" if asked.smoke else "charts-quick" if asked.quick else "charts"
    pictures = Workshop(asked.program, name, plan.size)
    timed = Workshop(asked.program, name, plan.side)
    out = pictures.folder if plan.quick else DOCS
    for folder in (pictures.folder, out):
        (folder / "images").mkdir(exist_ok=True)
    for name in asked.names or NAMES:
        make(name, pictures if name == "picture" else timed, asked, plan, out)
    print(f"{out}/charts-*.csv, {out}/images/charts-*.svg")


if __name__ == "__main__":
    main()
