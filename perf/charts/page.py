"""report.html: all charts on one page that needs no network.

Chart.js (MIT licence, Debian's libjs-chart.js) is put into it when it is made.
"""
import base64
import dataclasses
import html
import json
import pathlib
import re

from chart import FRONT, LOOKS, STAR

LIBRARY = pathlib.Path("/usr/share/javascript/chart.js/chart.min.js")
TEMPLATE = pathlib.Path(__file__).resolve().parent / "page.html"
TITLES = {
    "picture": "Pictures: error against time",
    "grid": "Grids: time and memory", "features": "No more than needed"}


def embedded(path):
    return "data:image/webp;base64," + base64.b64encode(pathlib.Path(path).read_bytes()).decode()


def with_pictures(charts, pictures):
    """Points name their pictures by number, so that charts of the same points share them."""
    for chart in charts:
        for point in (p for panel in chart["panels"] for s in panel["series"] for p in s["points"]):
            for key in ("picture", "error"):
                if key in point:
                    point[key] = pictures.setdefault(point[key], len(pictures))
    return charts


def markdown(text):
    """Tables, paragraphs and the two emphases that `tell` uses."""
    def cell(words):
        words = re.sub(r"\*\*(.+?)\*\*", r"<b>\1</b>", html.escape(words.strip()))
        return re.sub(r"\*(.+?)\*", r"<i>\1</i>", words)

    out = []
    for block in text.strip().split("\n\n"):
        lines = block.split("\n")
        if block.startswith("!["):
            continue  # the page draws the chart itself
        if not block.startswith("|"):
            out.append(f"<p>{cell(block)}</p>")
            continue
        rows = [[cell(c) for c in line.strip("|").split("|")] for line in lines
                if not line.startswith("|---")]
        told = ("<tr>" + "".join(f"<{tag}>{c}</{tag}>" for c in row) + "</tr>"
                for i, row in enumerate(rows)
                for tag in ["td" if i else "th"])
        out.append("<table>" + "".join(told) + "</table>")
    return "\n".join(out)


def make_page(path, kinds):
    """`kinds`: by name what was measured, None for what was not."""
    pictures, sections, charts = {}, [], []
    for name, kind in kinds.items():
        if kind is None:
            sections.append(
                f'<section id="{name}"><h2>{TITLES[name]}</h2>'
                f'<p class="missing">Not measured: ./run charts {name}</p></section>')
            continue
        places = []
        for chart in with_pictures(kind["charts"], pictures):
            places.append(
                f'<h3>{html.escape(chart["title"])}</h3><p>{html.escape(chart["note"])}</p>'
                f'<div class="panels" id="chart-{chart["name"]}"></div>')
            charts.append(chart)
        sections.append(
            f'<section id="{name}"><h2>{TITLES[name]}</h2>{"".join(places)}'
            f'<details><summary>in numbers</summary>{markdown(kind["told"])}</details></section>')
    looks = [dataclasses.asdict(look) for look in LOOKS]
    data = json.dumps({
        "charts": charts, "looks": looks, "front": FRONT, "star": STAR,
        "pictures": [embedded(p) for p in pictures]})
    data = data.replace("</", "<\\/")  # no script ends within
    page = TEMPLATE.read_text()
    parts = (("@LIBRARY@", LIBRARY.read_text()), ("@DATA@", data),
             ("@SECTIONS@", "\n".join(sections)))
    for mark, text in parts:
        page = page.replace(mark, text)
    path.write_text(page)
