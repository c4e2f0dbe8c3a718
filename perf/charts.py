#!/usr/bin/env python3
"""Charts of speed against accuracy, as CSV and SVG in docs/, and one page for all of them.

    ./run charts [picture] [grid] [features] [--quick] [--rounds N] [--draw]

Without a name, all. Every point tells the command that repeats it: in the CSV, in the SVG when the
mouse rests on it, and in report.html, which opens without a network. --quick: smaller pictures,
fewer points, and nothing kept in docs/. --draw: the charts and the page from the CSVs in docs/.
Measurements are stored in the build folder beside the references, so the page shows all charts with
small pictures, whichever chart was made last. References are rendered again when their scene or
options change (delete charts/ there when the program draws other pictures).
"""
import argparse
import csv
import dataclasses
import importlib
import json
import pathlib
import resource
import sys
import textwrap
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "lib"), str(HERE / "charts")]
from bench import (  # noqa: E402
    DOCS, DRAW_HELP, ROOT, cpu_name, put_section, read_csv, record, table)
from chart import draw  # noqa: E402
from image_error import Workshop  # noqa: E402
from page import make_page  # noqa: E402

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


def measured(name, module, shop, plan, kept):
    start, cpu = time.monotonic(), spent()
    result = module.measure(shop, plan)
    print(
        f"{name}: {time.monotonic() - start:.0f} s, of it {spent() - cpu:.0f} CPU seconds of what "
        "was measured",
        flush=True)
    if result is None:
        kept.unlink(missing_ok=True)
    else:
        told = f"{cpu_name()}; the least of {plan.rounds} renders or more. `./run charts {name}`"
        kept.write_text(json.dumps({"told": told, "result": result}))


def wrapped(text):
    """Its paragraphs in lines; tables as they are."""
    fill = textwrap.TextWrapper(width=100, break_long_words=False, break_on_hyphens=False).fill
    return "\n\n".join(block if block.startswith("|") else fill(block)
                       for block in text.split("\n\n"))


def known(name, module, kept, out):
    """Reads the CSV, with small pictures if they were measured here; None without a CSV."""
    if not (out / f"charts-{name}.csv").exists():
        return None
    rows = read_csv(f"charts-{name}", out)
    kept_rows = module.from_csv(rows)
    here = json.loads(kept.read_text()) if kept.exists() else None
    found = {
        "words": module.tell(kept_rows, table), "result": kept_rows,
        "told": f"Drawn from charts-{name}.csv. `./run charts {name}` measures it."
    }
    if here and [list(map(str, row))
                 for row in module.csv(here["result"])[1]] == [list(row.values()) for row in rows]:
        found |= here
    return found


def draw_all(charts, out, folder):
    for chart in charts:
        draw(chart, out / "images" / f"charts-{chart['name']}.svg",
             folder / f"charts-{chart['name']}.png")


def make(name, shop, asked, plan, out):
    """Measures, tells and draws it where it is asked for; its words and charts, for the page."""
    module, kept = importlib.import_module(name), shop.folder / f"{name}.json"
    chosen = name in (asked.names or NAMES)
    if chosen and not asked.draw:
        measured(name, module, shop, plan, kept)
        if kept.exists():
            write_csv(out / f"charts-{name}.csv",
                      *module.csv(json.loads(kept.read_text())["result"]))
            if out == DOCS:
                record(f"charts-{name}")
        elif plan.quick:
            (out / f"charts-{name}.csv").unlink(missing_ok=True)
    found = known(name, module, kept, out)
    if found is None:
        return None
    charts = module.charts(found["result"])
    told = wrapped(f"{found['words']}\n\n{found['told']}")
    if chosen:
        draw_all(charts, out, shop.folder)
        print(told, flush=True)
    if chosen and out == DOCS and not asked.draw:
        put_section(DOCS / "accuracy.md", "perf/charts.py", told, name)
    return {"told": told, "charts": charts}


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
    kinds = {
        name: make(name, pictures if name == "picture" else timed, asked, plan, out)
        for name in NAMES
    }
    page = pictures.folder / "report.html"
    make_page(page, kinds)
    print(f"{out}/charts-*.csv, {out}/images/charts-*.svg, {page}")


if __name__ == "__main__":
    main()
