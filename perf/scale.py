#!/usr/bin/env python3
"""How time grows: with primitives, threads, the picture's size and the depth of paths.

    ./run perf scale [--rounds N] [--quick] [--keep] [--draw]

Whole runs of the program on scenes of its own generators; times a ray from the phases that --stats
keeps, one thread. The largest scenes are files of up to a gigabyte and take up to 4 GB of memory;
each is deleted once measured. --quick leaves them out.
"""
import math
import pathlib
import sys
from datetime import date

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import Bench, COLOURS, arguments, cores, cpu_name, plt, read_csv, table
from chart import set_axis

SIDE = 512
KINDS = ("primary", "bounce", "shadow")
DEPTHS = (1, 2, 3, 4, 5, 6, 8, 10)  # glass sends two rays on: twice as many with each step
SIDES = (64, 128, 256, 512, 1024, 2048)


def least(old, new):
    """Of each time the least; what is counted is the same in all."""
    if isinstance(new, dict):
        return {k: least(old[k], v) for k, v in new.items()} if old else new
    return min(old, new) if old is not None and isinstance(new, float) else new


def ray_counts(stats):
    r = stats["rays"]
    return {
        "primary": r["primary"], "bounce": r["reflection"] + r["refraction"], "shadow": r["shadow"]}


def point(stats):
    """Nanoseconds a ray by kind and of all, and what a build takes."""
    rays = ray_counts(stats)
    # a busy machine stretches the clock's time, not the processor's
    idle = 1
    if stats["threads"] == 1:
        idle = min(1, stats["seconds"]["render_cpu"] / stats["seconds"]["render"])
    spent = {k: stats["phases"][k] * idle for k in KINDS}
    out = {k: spent[k] / rays[k] * 1e9 for k in KINDS if rays[k]}
    out["all"] = sum(spent.values()) / sum(rays.values()) * 1e9
    scene = stats["scene"]
    out |= {
        "primitives": scene["s"] + scene["p"], "rays": sum(rays.values()),
        "build": stats["seconds"]["build"], "load": stats["seconds"]["load"],
        "render": stats["seconds"]["render"], "write": stats["seconds"]["write"],
        "bytes": (stats["bytes"]["geometry"] + stats["bytes"]["grids"]) / (scene["s"] + scene["p"])}
    return out


def exponent(points, key, low, high):
    """Slope of the straight line through log time over log primitives, least squares."""
    chosen = [(math.log(p["primitives"]), math.log(p[key])) for size, p in points.items()
              if low <= size <= high]
    mx, my = (sum(c) / len(chosen) for c in zip(*chosen))
    return sum((x - mx) * (y - my) for x, y in chosen) / sum((x - mx) ** 2 for x, _ in chosen)


def by_primitives(bench, name, sizes):
    points = {}
    for size in sizes:
        scene = bench.scene(name, size)
        rounds = bench.rounds if size < sizes[-1] - 1 else max(2, bench.rounds // 2)
        for _ in range(rounds):
            run = bench.render(scene, "--size", f"{SIDE}x{SIDE}", "--threads", 1)
            points[size] = least(points.get(size), point(run))
        scene.unlink()
        p = points[size]
        print(
            f"{name} {size}: {p['primitives']} primitives, {p['all']:.1f} ns a ray, build "
            f"{p['build']:.4f} s",
            flush=True)
    return points


def by_option(bench, scenes, settings, options, more=1):
    """points[scene][setting], all taking turns."""
    points = {name: {} for name in scenes}
    for _ in range(more * bench.rounds):
        for name, path in scenes.items():
            for setting in settings:
                run = bench.render(path, *options(setting))
                points[name][setting] = least(points[name].get(setting), point(run))
    return points


def from_csv(rows):
    """Points by primitives, threads, side and depth, each by scene and setting."""
    found = {"primitives": {}, "threads": {}, "side": {}, "depth": {}}
    for row in rows:
        numbers = {
            key.removesuffix("_ns"): float(value)
            for key, value in row.items()
            if key not in ("against", "scene", "setting") and value
        }
        found[row["against"]].setdefault(row["scene"], {})[int(row["setting"])] = numbers
    return found.values()


# Colour, marker and dash of a curve: the first scene's and the second's, then of a second quantity
CURVES = [(COLOURS[0], "o", "-"), (COLOURS[1], "s", "-"), (COLOURS[0], "^", ":"),
          (COLOURS[1], "D", ":")]


def curves(panel, points_by_scene, x, *quantities):
    """A curve for each scene and quantity: its words, and how it comes of a setting and its
    point."""
    for quantity, (words, value) in enumerate(quantities):
        for (colour, marker, dash), (name, points) in zip(CURVES[2 * quantity:],
                                                          points_by_scene.items()):
            panel.plot([x(setting, p) for setting, p in points.items()],
                       [value(setting, p) for setting, p in points.items()],
                       marker=marker,
                       linestyle=dash,
                       color=colour,
                       label=f"{name}{words and ', '}{words}")


def named(panel, title, x, y):
    panel.set(title=title, xlabel=x, ylabel=y, xscale="log", yscale="log")
    panel.grid(alpha=.4)
    for axis in (panel.xaxis, panel.yaxis):
        low, high = axis.get_data_interval()
        set_axis(axis, low, high, {"log": True})
    panel.legend(frameon=False, fontsize=9)


def guide(panel, xs, ys, words):
    panel.plot(xs, ys, "--", color="#555555", linewidth=1, label=words)


def draw(bench, growth, threads, sizes, depths):
    figure, panels = plt.subplots(4, 2, figsize=(10, 14.5), layout="constrained")
    (rays, memory), (building, speed), (pixels, by_size), (depth, traced) = panels
    primitives, setting, area = (lambda s, p: p["primitives"]), (lambda s, p: s), (
        lambda s, p: s * s)
    of = lambda key, factor=1: lambda s, p: p[key] * factor

    curves(rays, growth, primitives, ("all rays", of("all")), ("camera rays", of("primary")))
    ends = [p for size, p in growth["balls"].items() if size >= 3]
    n0, t0, n1 = ends[0]["primitives"], ends[0]["all"], ends[-1]["primitives"]
    guide(rays, [n0, n1], [t0, t0 * (n1 / n0) ** .25], "fourth root of the primitives")
    named(rays, "Tracing, one thread", "primitives in the scene", "nanoseconds a ray")

    curves(memory, growth, primitives, ("", of("bytes")))
    named(memory, "Memory of geometry and grids", "primitives in the scene", "bytes a primitive")

    curves(building, growth, primitives, ("building grids", of("build")),
           ("reading the file", of("load")))
    guide(building, [1e4, 1e6], [2e-4, 2e-2], "in proportion")
    named(building, "Building and reading", "primitives in the scene", "seconds")

    gains = {
        name: {n: {"gain": points[1]["render"] / p["render"]}
               for n, p in points.items()}
        for name, points in threads.items()
    }
    curves(speed, gains, setting, ("", of("gain")))
    most = max(threads["balls 4"])
    guide(speed, [1, most], [1, most], "as many times as threads")
    named(speed, f"Threads, a picture of {SIDE} x {SIDE}", "threads", "times as fast as one thread")
    ticks = sorted(threads["balls 4"])
    for axis in (speed.xaxis, speed.yaxis):
        axis.set_ticks(ticks, [str(t) for t in ticks])
        axis.set_ticks([], minor=True)

    curves(pixels, sizes, area, ("rendering", of("render")), ("writing the PNG", of("write")))
    named(pixels, "Size of the picture, one thread", "pixels of the picture", "seconds")
    curves(by_size, sizes, area, ("", of("all")))
    named(by_size, "Tracing by size of the picture", "pixels of the picture", "nanoseconds a ray")

    curves(depth, depths, setting, ("", of("render")))
    named(depth, "Longest path, one thread: time", "rays in the longest path (--depth)",
          "seconds to render")
    curves(traced, depths, setting, ("", of("rays", 1e-6)))
    named(traced, "Longest path: rays", "rays in the longest path (--depth)", "million rays traced")
    for panel in (depth, traced):
        panel.set_xticks(DEPTHS, [str(d) for d in DEPTHS])
        panel.set_xticks([], minor=True)
    bench.save(figure, "scale")


def main():
    parser = arguments(__doc__, rounds=5)
    parser.add_argument("--quick", action="store_true",
                        help="no scene of a million primitives or more")
    asked = parser.parse_args()
    bench = Bench("scale", asked)
    if asked.draw:
        draw(bench, *from_csv(read_csv("scale")))
        return
    growth = {"balls": by_primitives(bench, "balls", range(1, 7 if asked.quick else 8)),
              "mount": by_primitives(bench, "mount", range(3, 10 if asked.quick else 12))}
    scenes = {"balls 4": bench.scene("balls", 4), "mount 7": bench.scene("mount", 7)}
    square = f"{SIDE}x{SIDE}"
    counts = sorted({1, *(2 ** k for k in range(10) if 2 ** k <= cores()), cores()})
    # what other programs disturb most
    threads = by_option(bench, scenes, counts, lambda n: ("--size", square, "--threads", n), more=8)
    sizes = by_option(bench, scenes, SIDES[:-1] if asked.quick else SIDES,
                      lambda n: ("--size", f"{n}x{n}", "--threads", 1))
    depths = by_option(bench, scenes, DEPTHS,
                       lambda n: ("--size", square, "--threads", 1, "--depth", n))

    rows = [["primitives", name, s, p] for name, points in growth.items()
            for s, p in points.items()]
    rows += [[what, name, s, p]
             for what, all_points in (("threads", threads), ("side", sizes), ("depth", depths))
             for name, points in all_points.items() for s, p in points.items()]
    keys = [
        "primitives", "rays", "primary", "bounce", "shadow", "all", "load", "build", "render",
        "write", "bytes"]
    bench.write_csv(
        "scale",
        ["against", "scene", "setting", *[f"{k}_ns" if k in (*KINDS, "all") else k for k in keys]],
        [[what, name, s,
          *[f"{p[k]:.5g}" if isinstance(p.get(k), float) else p.get(k, "") for k in keys]]
         for what, name, s, p in rows])
    draw(bench, growth, threads, sizes, depths)

    bench.section(tell(growth, threads))


def tell(growth, threads):
    last_balls, last_mount = max(growth["balls"]), max(growth["mount"])
    fits = (("balls", 3, last_balls), ("mount", 3, last_mount), ("mount", 7, last_mount))
    rows = [[f"{name} {low} to {high}",
             *(f"{exponent(growth[name], k, low, high):.2f}"
               for k in (*KINDS, "all", "build", "load"))]
            for name, low, high in fits]
    most = max(threads["balls 4"])
    both = ", ".join(f"{name} {p[1]['render'] / p[most]['render']:.2f}"
                     for name, p in threads.items())
    return f"""## How time grows

![time against primitives, threads, pixels and depth](images/scale.svg)

Pictures of {SIDE} x {SIDE}, paths of at most 5 rays, one thread of a virtual {cpu_name()},
{date.today():%B %Y}, the least of several runs ([numbers](scale.csv)). Times are those of tracing,
without shading; bytes are geometry and grids together. Fitted exponents e of time = c N^e:

{table(["", "camera", "bounce", "shadow", "all rays", "build", "load"], rows)}

{most} threads over one, whole render: {both} times.
`./run perf scale --keep` makes all of this.
"""


if __name__ == "__main__":
    main()
