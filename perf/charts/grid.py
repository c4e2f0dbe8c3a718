"""Time and memory by the grid's density M and the size of packets, the kernel's choice among them.

Time is that of tracing alone, without shading, in CPU nanoseconds a ray (camera, bounce and shadow
rays together) on one thread; the least of several renders that take turns, less the time of all
else, which no grid changes. Pictures must be the same, bit for bit, whatever M and packet.
"""
import hashlib
import math
import sys

from chart import STARLESS
from image_error import turns
from kept import by_scene, size_in

NAME, TITLE = "grid", "Time and memory of grids"
SCENES = [("balls", 4), ("balls", 6), ("mount", 6), ("mount", 8), ("boat", 10), ("knot", 8),
          ("gears", 4), ("rings", 7), ("tree", 11), ("lattice", 12), ("stadium", 6), ("tetra", 8)]
DENSITIES = (.25, .35, .5, .7, 1, 1.4, 2, 3)
PACKETS = (1, 16, 64)
AUTO = "chosen"
WITHIN = 1.1  # of the best density, by time, is what the kernel's choice must be


def variants(plan):
    densities = DENSITIES[::3] if plan.settings < len(DENSITIES) else DENSITIES
    yield AUTO, []
    for m in densities:
        yield f"M {m:g}", ["--density", m]
    for n in PACKETS[:-1]:
        yield f"packets of {n}", ["--packet", n]


def beside_tracing(stats):
    """CPU seconds of a render's other phases. A busy machine stretches the clock's time, not the
    processor's."""
    seconds = stats["seconds"]
    traced = sum(stats["phases"][k] for k in ("primary", "bounce", "shadow"))
    return seconds["render_cpu"] - traced * min(1, seconds["render_cpu"] / seconds["render"])


def measure_scene(shop, plan, source):
    scene, picture = shop.scene(source), shop.folder / "grid.pfm"
    kernel = shop.info(scene)["kernel"]
    primitives = sum(kernel[k] for k in ("spheres", "triangles", "cones", "planes"))
    points, spent, others = {}, 0, math.inf
    for turn in turns(plan, lambda: spent):
        for label, words in variants(plan):
            options = ["--threads", "1", "--samples", "1", *words]
            stats = shop.render(scene, options, picture)
            if turn == 0:
                points[label] = {
                    "label": label, "build": math.inf, "render": math.inf,
                    "cells": [g["cells"] for g in stats["grids"]],
                    "bytes": stats["bytes"]["grids"],
                    "rays": sum(stats["rays"].values()), "primitives": primitives,
                    "bits": hashlib.sha256(picture.read_bytes()).hexdigest(),
                    "command": shop.command(source, options)}
            point = points[label]
            spent += stats["seconds"]["render_cpu"]
            others = min(others, beside_tracing(stats))
            point["render"] = min(point["render"], stats["seconds"]["render_cpu"])
            point["build"] = min(point["build"], stats["seconds"]["build"])
    if len({p["bits"] for p in points.values()}) > 1:
        bits = ", ".join(f"{p['label']} {p['bits'][:8]}" for p in points.values())
        sys.exit(f"{scene.name}: pictures differ: " + bits)
    for p in points.values():  # what is not tracing is the same whatever the grid
        p["ns"] = (p["render"] - others) / p["rays"] * 1e9
    return {"scene": " ".join(map(str, source)), "points": list(points.values())}


def measure(shop, plan):
    results = []
    for source in SCENES[:plan.scenes]:
        print(f"grid: {source[0]} {source[1]}", flush=True)
        results.append(measure_scene(shop, plan, source))
    return {"size": shop.size[1], "scenes": results}


def csv(result):
    header = [
        "scene", "setting", "cells", "trace_ns_a_ray", "render_cpu_seconds", "build_seconds",
        "grid_bytes", "primitives", "command"]
    rows = [[s["scene"], p["label"], " ".join("x".join(map(str, c)) for c in p["cells"]),
             f"{p['ns']:.4g}", f"{p['render']:.4g}", f"{p['build']:.4g}", p["bytes"],
             p["primitives"], p["command"]]
            for s in result["scenes"] for p in s["points"]]
    return header, rows


def from_csv(rows):
    """The measurements in the format of docs/charts-grid.csv."""
    def point(row):
        grids = [[int(n) for n in grid.split("x")] for grid in row["cells"].split()]
        return {
            "label": row["setting"], "cells": grids, "ns": float(row["trace_ns_a_ray"]),
            "render": float(row["render_cpu_seconds"]), "build": float(row["build_seconds"]),
            "bytes": int(row["grid_bytes"]), "primitives": int(row["primitives"]),
            "command": row["command"]
        }

    return {"size": size_in(rows[0]["command"]), "scenes": by_scene(rows, point)}


def cells(p):
    """A primitive: where a choice of the kernel's own lies on the axis of densities."""
    return sum(math.prod(c) for c in p["cells"])


def split(scene):
    """The choice, the densities with M, the packets with their size."""
    chosen = next(p for p in scene["points"] if p["label"] == AUTO)
    densities = [(float(p["label"][2:]), p) for p in scene["points"] if p["label"].startswith("M ")]
    packets = [(int(p["label"].rsplit(" ")[-1]), p)
               for p in scene["points"] if p["label"].startswith("packets")]
    packets.append((PACKETS[-1], chosen))
    return chosen, densities, packets


def density_like(chosen, densities):
    """The M that would give as many cells."""
    return min(densities,
               key=lambda d: abs(math.log(max(cells(d[1]), 1) / max(cells(chosen), 1))))[0]


def panel(title, y, series, x="M"):
    label, ticks = {
        "M": ("density M (--density)", DENSITIES), "packet": ("rays in a packet", PACKETS)
    }[x]
    return {
        "title": title, "x": {"label": label, "log": True, "ticks": ticks}, "y": y, "series": series
    }


def point(x, y, p):
    return {"x": x, "y": y, "label": p["label"], "command": p["command"]}


def scene_series(scene, look, value):
    chosen, densities, _ = split(scene)
    points = [point(m, value(p), p) for m, p in densities]
    star = {**point(density_like(chosen, densities), value(chosen), chosen), "star": True}
    return {"name": scene["scene"], "look": look, "joined": True, "points": [*points, star]}


def charts(result):
    times = []
    for scene in result["scenes"]:
        best = min(p["ns"] for _, p in split(scene)[1])
        series = scene_series(scene, 5, lambda p: p["ns"] / best)
        worst = max(p["y"] for p in series["points"])
        y = {
            "label": "time of tracing / best",
            "span": [.9, math.ceil(20 * min(max(1.35, worst), 2.6)) / 20 + .05]
        }
        curves = panel(f"{scene['scene']}: best {best:.3g} ns a ray", y,
                       [{**series, "name": "tracing with M"}])
        times.append({**curves, "lines": [{"y": WITHIN, "label": "10 % above the best density"}]})
    looked = list(zip(STARLESS, result["scenes"], strict=False))
    memory = [scene_series(s, look, lambda p: p["bytes"] / p["primitives"]) for look, s in looked]
    build = [
        scene_series(s, look, lambda p: p["build"] / p["primitives"] * 1e9) for look, s in looked
    ]
    packets = []
    for look, scene in looked:
        chosen, _, sizes = split(scene)
        packets.append({
            "name": scene["scene"], "look": look, "joined": True,
            "points": [point(n, p["ns"] / chosen["ns"], p) for n, p in sizes]})
    return [{
        "name": "grid", "title": f"Time of tracing against density M, {result['size']}",
        "columns": 3, "panel_size": (3.7, 2.6), "panels": times
    }, {
        "name": "grid-memory", "title": "Memory, time to build, and packets", "columns": 3,
        "panel_size": (4.3, 4), "panels": [
            panel("memory of the grids", {"label": "bytes a primitive", "log": True}, memory),
            panel("building them, one thread", {"label": "nanoseconds a primitive", "log": True},
                  build),
            panel("packets", {"label": "time / time in packets of 64"}, packets, "packet")
        ]
    }]


def tell(result, table):
    rows, missed, small = [], [], []
    for scene in result["scenes"]:
        chosen, densities, packets = split(scene)
        m, best = min(densities, key=lambda d: d[1]["ns"])
        ratio = chosen["ns"] / best["ns"]
        whole = lambda p: p["render"] + p["build"]
        soonest = min(densities, key=lambda d: whole(d[1]))
        by_size = {n: p["ns"] / chosen["ns"] for n, p in packets}
        rows.append([
            scene["scene"], f"{chosen['ns']:.3g}", f"{best['ns']:.3g} (M {m:g})",
            f"{ratio:.2f}" + (" **missed**" if ratio > WITHIN else ""),
            f"{whole(chosen) / whole(soonest[1]):.2f} (M {soonest[0]:g})",
            f"{chosen['bytes'] / chosen['primitives']:.0f}",
            *[f"{by_size[n]:.2f}" for n in PACKETS[:-1]]])
        n, least = min(by_size.items(), key=lambda size: size[1])
        if 1 / least > WITHIN:
            small.append(f"{scene['scene']} (of {n}: {least:.2f})")
        if ratio > WITHIN:
            missed.append(f"{scene['scene']} ({ratio:.2f})")
    verdict = ("within 10 % of the best density in every scene" if not missed else
               "more than 10 % above the best density on " + ", ".join(missed))
    header = [
        "", "chosen, ns a ray", "best", "chosen / best", "build and render, chosen / best",
        "bytes a primitive", "packets of 1 / 64", "of 16 / 64"]
    packets = "no smaller ones are more than 10 % faster in any scene"
    if small:
        packets = "smaller ones are more than 10 % faster on " + ", ".join(small)
    return f"""The kernel's choice is {verdict}. Packets of 64: {packets}.

{table(header, rows)}"""
