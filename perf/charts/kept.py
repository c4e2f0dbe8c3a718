"""Reads the CSVs in docs/ for the charts."""
import re


def size_in(command):
    """Of the pictures: WIDTHxHEIGHT, as the row's command has it."""
    return re.search(r"--size (\d+x\d+)", command)[1]


def by_scene(rows, point):
    """Scenes in their order, each with the points of its rows."""
    scenes = {}
    for row in rows:
        scenes.setdefault(row["scene"], []).append(point(row))
    return [{"scene": scene, "points": points} for scene, points in scenes.items()]
