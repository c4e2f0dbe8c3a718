#!/usr/bin/env python3
"""Closest points beside Embree and CGAL, insides beside CGAL and VTK: runs perf/distance.cpp,
prints its tables and draws a chart of time against distance.

    ./run perf distance [--keep] [--draw] [--scene NAME] [--points N] [--rounds N]

--keep writes the tables into docs/performance.md and the chart into docs/images.
--draw measures nothing: it draws the chart again from the tables that are kept.
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import DOCS, ROOT, table_bench
from chart import draw

PLACES = ("in the surface", ".01 sizes", "1 size", "10 sizes", "1e4 sizes", "the middle")
LOOKS = {"array": 5, "call": 6, "Embree": 2, "CGAL": 3}


def rows_of(text):
    """Rows of the table of closest points, as dicts by its header."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    names = next((row for row in cells if row[2:4] == ["array", "call"]), [])
    return [dict(zip(names, row)) for row in cells if len(row) == len(names) and row[1] in PLACES]


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


def draw_chart(text, folder):
    rows = rows_of(text)
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    draw({"name": "distance", "title": "Time of a closest point, by the distance from the mesh",
          "columns": 2, "panels": [panel_of(scene, [row for row in rows if row["scene"] == scene])
                                   for scene in scenes]},
         folder / "distance.svg", ROOT / "build" / "distance.png")


if __name__ == "__main__":
    if "--draw" in sys.argv:
        page = (DOCS / "performance.md").read_text()
        draw_chart(re.search("<!-- made by perf/distance.py -->.*<!-- end of distance -->", page,
                             re.S)[0], DOCS / "images")
    else:
        draw_chart(table_bench(__doc__, "distance"),
                   DOCS / "images" if "--keep" in sys.argv else ROOT / "build")
