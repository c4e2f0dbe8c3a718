#!/usr/bin/env python3
"""Closest points beside Embree and CGAL, insides beside CGAL and VTK: runs perf/distance.cpp,
prints its tables and draws a chart of time against distance.

    ./run perf distance [--keep] [--draw] [--scene NAME] [--points N] [--rounds N]

--keep writes docs/distance.csv, docs/insides.csv and the chart; perf/figures.py makes the table of
docs/performance.md. --draw measures nothing: it draws the chart again from the CSV.
"""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DOCS, ROOT, read_csv, record, table_bench
from chart import draw

PLACES = ("in the surface", ".01 sizes", "1 size", "10 sizes", "1e4 sizes", "the middle")
LOOKS = {"array": 5, "call": 6, "Embree": 2, "CGAL": 3}


def tables_of(text):
    """Tables of Markdown as lists of rows of words, with their headers."""
    found = []
    for block in text.split("\n\n"):
        lines = [line for line in block.splitlines() if line.startswith("|")]
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
        if rows:
            found.append([rows[0], *rows[2:]])
    return found


def keep(tables, folder):
    for name, rows in zip(("distance", "insides"), tables):
        with open(folder / f"{name}.csv", "w", newline="") as f:
            csv.writer(f, lineterminator="\n").writerows(rows)
        if folder == DOCS:
            record(name)


def panel_of(scene, rows):
    series = []
    for name, look in LOOKS.items():
        points = [{"x": PLACES.index(row["points"]), "y": float(row[name]), "label": row["points"],
                   "command": f"./run perf distance --scene '{scene}'"}
                  for row in rows if row[name] != "-"]
        if points:
            series.append({"name": name if look in (2, 3) else f"Grelha, {name}", "look": look,
                           "joined": True, "points": points})
    return {"title": scene, "series": series,
            "x": {"label": "where the points lie", "names": [p.replace(" ", "\n", 1).replace(
                "in\nthe surface", "surface").replace("the\nmiddle", "middle") for p in PLACES]},
            "y": {"label": "microseconds a point", "log": True}}


def draw_chart(rows, folder):
    rows = [row for row in rows if row["points"] in PLACES]
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    draw({"name": "distance", "title": "Time of a closest point, by the distance from the mesh",
          "columns": 2, "panels": [panel_of(scene, [row for row in rows if row["scene"] == scene])
                                   for scene in scenes]},
         folder / "distance.svg", ROOT / "build" / "distance.png")


if __name__ == "__main__":
    KEPT = "--keep" in sys.argv or "--draw" in sys.argv
    FOLDER = DOCS if KEPT else ROOT / "build"
    if "--draw" not in sys.argv:
        keep(tables_of(table_bench(__doc__, "distance", has_section=False)), FOLDER)
    draw_chart(read_csv("distance", FOLDER), DOCS / "images" if KEPT else FOLDER)
