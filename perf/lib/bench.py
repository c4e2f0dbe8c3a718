"""Helpers of the benchmark scripts: scenes, runs of the program, results as CSV, and sections made
from them in docs/performance.md."""
import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
from datetime import date

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

from machine import cpu_name  # noqa: F401, scripts import it from here

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCS = ROOT / "docs"
# After Okabe and Ito: told apart by the colour-blind too.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#999999", "#F0E442"]
plt.rcParams.update({
    "svg.hashsalt": "grelha", "svg.fonttype": "none", "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans"],
    "axes.spines.top": False, "axes.spines.right": False})


DRAW_HELP = "measure nothing: draw the chart in docs/images again from the CSV in docs/"


def arguments(doc, rounds):
    parser = argparse.ArgumentParser(description=doc.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="[build/release/grelha]")
    parser.add_argument("--rounds", type=int, default=rounds,
                        help="of all measurements in turn; the least time counts")
    parser.add_argument("--keep", action="store_true",
                        help="write CSV, chart and section into docs/, not into the build folder")
    parser.add_argument("--draw", action="store_true", help=DRAW_HELP)
    return parser


def read_csv(name, folder=DOCS):
    """Reads the rows of a CSV as dicts of words; the folder is docs/ if none is named."""
    with open(folder / f"{name}.csv", newline="") as f:
        return list(csv.DictReader(f))


def cores():
    return len(os.sched_getaffinity(0))


class Bench:
    """A name, a program, a folder to work in, and where results go."""

    def __init__(self, name, asked):
        self.name, self.rounds = name, asked.rounds
        self.program = pathlib.Path(asked.program).resolve()
        self.folder = self.program.parent / f"perf-{name}"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.docs = DOCS if asked.keep or asked.draw else self.folder
        (self.docs / "images").mkdir(exist_ok=True)

    def scene(self, name, size):
        path = self.folder / f"{name}-{size}.nff"
        if not path.exists():
            subprocess.run([self.program, "scene", name, "--size", str(size), "-o", path],
                           check=True)
        return path

    def render(self, scene, *options, picture=None):
        stats = self.folder / "stats.json"
        subprocess.run([
            self.program, "render", scene, "-o", picture or self.folder / "picture.png", "--quiet",
            "--stats", stats, *map(str, options)], check=True)
        return json.loads(stats.read_text())

    def tool(self, *words):
        """JSON of the benchmark program beside the script."""
        done = subprocess.run([self.program.parent / self.name, *map(str, words)], check=True,
                              stdout=subprocess.PIPE, text=True)
        return json.loads(done.stdout)

    def write_csv(self, name, header, rows):
        with open(self.docs / f"{name}.csv", "w", newline="") as f:
            table = csv.writer(f, lineterminator="\n")
            table.writerow(header)
            table.writerows(rows)
        if self.docs == DOCS:
            record(name)

    def save(self, figure, name):
        path = self.docs / "images" / f"{name}.svg"
        figure.savefig(path, metadata={"Date": None})
        figure.savefig(self.folder / f"{name}.png", dpi=80)  # to look at
        plt.close(figure)

    def section(self, text, part=""):
        """Prints the section; when kept, puts it between its two marks in docs/performance.md."""
        print(text)
        if self.docs == DOCS:
            put_section(DOCS / "performance.md", f"perf/{self.name}.py", text, part)


def put_section(page, maker, text, part=""):
    """Between its two marks, where the page has them, or at its end."""
    part = part and f", {part}"
    name = pathlib.Path(maker).stem
    old = page.read_text()
    new = f"<!-- made by {maker}{part} -->\n{text.strip()}\n<!-- end of {name}{part} -->"
    marks = re.compile(f"<!-- made by {re.escape(maker)}{part} -->.*<!-- end of {name}{part} -->",
                       re.S)
    page.write_text(marks.sub(lambda _: new, old) if marks.search(old) else
                    old.rstrip() + "\n\n" + new + "\n")


def csv_bench(doc, name, command, draw, told):
    """The command line of a benchmark that prints a line of its conditions after "# ", then CSV.

    command(folder) gives the words that run it, from the folder it stands in. draw(rows, about,
    path) draws the chart and told(rows, about) writes the section of docs/accuracy.md.
    """
    parser = argparse.ArgumentParser(description=doc.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--keep", action="store_true", help="write into docs/")
    parser.add_argument("--draw", action="store_true", help=DRAW_HELP)
    asked, rest = parser.parse_known_args()
    folder = pathlib.Path(asked.program).resolve().parent
    to = DOCS if asked.keep or asked.draw else folder
    numbers = to / f"{name}.csv"
    if not asked.draw:
        done = subprocess.run([*command(folder), *rest], stdout=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(done.returncode)
        numbers.write_text(done.stdout)
        if to == DOCS:
            record(name)
    lines = numbers.read_text().splitlines()
    about = lines[0].removeprefix("# ")
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    chart = (DOCS / "images" if to == DOCS else folder) / f"{name}.svg"
    draw(rows, about, chart)
    section = told(rows, about)
    if asked.keep:
        put_section(DOCS / "accuracy.md", f"perf/{name}.py", section)
    print(section, numbers, chart, sep="\n")


def columns_of(text, columns):
    """Some columns of the tables of Markdown in a text."""
    def shorter(line):
        cells = line.strip("|").split("|")
        return f"|{'|'.join(cells[c] for c in columns)}|" if line.startswith("|") else line
    return "\n".join(map(shorter, text.splitlines())) + "\n" if columns else text


def table_bench(doc, name, columns=(), has_section=True):
    """Runs a benchmark that prints a table, prints and returns it; --keep: into
    docs/performance.md, or some of its columns."""
    parser = argparse.ArgumentParser(description=doc.partition("\n")[0])
    parser.add_argument("--program", default=ROOT / "build/release/grelha",
                        help="the benchmark stands beside it [build/release/grelha]")
    parser.add_argument("--keep", action="store_true", help="write into docs/performance.md")
    asked, rest = parser.parse_known_args()
    folder = pathlib.Path(asked.program).resolve().parent
    done = subprocess.run([folder / name, *rest], stdout=subprocess.PIPE, text=True)
    if done.returncode:
        print(done.stdout)
        sys.exit(done.returncode)
    if asked.keep and has_section:
        section = (f"{columns_of(done.stdout, columns)}\n{cpu_name()}, one thread, commit "
                   f"{commit()}, `./run perf {name} --keep`.")
        put_section(DOCS / "performance.md", f"perf/{name}.py", section)
    print(done.stdout)
    return done.stdout


def commit():
    """The one that is measured."""
    done = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"],
                          stdout=subprocess.PIPE, text=True)
    return done.stdout.strip() or "no commit"


def machine():
    flags = next((line for line in open("/proc/cpuinfo") if line.startswith("flags")), "").split()
    simd = [name for flag, name in (("avx512f", "AVX-512"), ("avx2", "AVX2")) if flag in flags]
    return cpu_name() + (f" with {simd[0]}" if simd else "")


def record(name):
    """Says in docs/measured.csv of what and where a CSV is; perf/figures.py puts it into pages."""
    rows = {r["csv"]: list(r.values()) for r in read_csv("measured")}
    rows[name] = [name, commit(), date.today().isoformat(), machine()]
    with open(DOCS / "measured.csv", "w", newline="") as f:
        writer = csv.writer(f, lineterminator="\n")
        writer.writerows([["csv", "commit", "date", "machine"], *sorted(rows.values())])


def table(header, rows):
    """Markdown, the first column to the left."""
    lines = ["| " + " | ".join(header) + " |", "|---" + "|--:" * (len(header) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def seconds(value):
    if value is None:
        return "–"
    if value >= 100:
        return f"{value:.0f}"
    if value >= 1:
        return f"{value:.3g}"
    return f"{value:.3f}".lstrip("0") if value >= .0995 else f"{value:.4f}".lstrip("0")


def times(value):
    return "–" if value is None else f"{value:.0f}" if value >= 20 else f"{value:.1f}"
