#!/usr/bin/env python3
"""How time grows: with primitives, threads, the picture's size and the depth of paths.

    ./run perf scale [--rounds N] [--quick] [--keep]

Whole runs of the program on scenes of its own generators; times a ray from the phases that --stats keeps, one thread.
The largest scenes are files of up to a gigabyte and take up to 4 GB of memory; each is deleted once measured. --quick leaves them out.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
from bench import Bench, COLOURS, arguments, cores, cpu_name, plt, seconds, table, times

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
    return {"primary": r["primary"], "bounce": r["reflection"] + r["refraction"], "shadow": r["shadow"]}


def point(stats):
    """Nanoseconds a ray by kind and of all, and what a build takes."""
    rays = ray_counts(stats)
    # a busy machine stretches the clock's time, not the processor's
    idle = min(1, stats["seconds"]["render_cpu"] / stats["seconds"]["render"]) if stats["threads"] == 1 else 1
    spent = {k: stats["phases"][k] * idle for k in KINDS}
    out = {k: spent[k] / rays[k] * 1e9 for k in KINDS if rays[k]}
    out["all"] = sum(spent.values()) / sum(rays.values()) * 1e9
    scene = stats["scene"]
    out |= {"primitives": scene["s"] + scene["p"], "rays": sum(rays.values()), "build": stats["seconds"]["build"], "load": stats["seconds"]["load"],
            "render": stats["seconds"]["render"], "write": stats["seconds"]["write"],
            "bytes": (stats["bytes"]["geometry"] + stats["bytes"]["grids"]) / (scene["s"] + scene["p"])}
    return out


def exponent(points, key, low, high):
    """Slope of the straight line through log time over log primitives, least squares."""
    chosen = [(math.log(p["primitives"]), math.log(p[key])) for size, p in points.items() if low <= size <= high]
    mx, my = (sum(c) / len(chosen) for c in zip(*chosen))
    return sum((x - mx) * (y - my) for x, y in chosen) / sum((x - mx) ** 2 for x, _ in chosen)


def by_primitives(bench, name, sizes):
    points = {}
    for size in sizes:
        scene = bench.scene(name, size)
        rounds = bench.rounds if size < sizes[-1] - 1 else max(2, bench.rounds // 2)
        for _ in range(rounds):
            points[size] = least(points.get(size), point(bench.render(scene, "--size", f"{SIDE}x{SIDE}", "--threads", 1)))
        scene.unlink()
        p = points[size]
        print(f"{name} {size}: {p['primitives']} primitives, {p['all']:.1f} ns a ray, build {p['build']:.4f} s", flush=True)
    return points


def by_option(bench, scenes, settings, options, more=1):
    """points[scene][setting], all taking turns."""
    points = {name: {} for name in scenes}
    for _ in range(more * bench.rounds):
        for name, path in scenes.items():
            for setting in settings:
                points[name][setting] = least(points[name].get(setting), point(bench.render(path, *options(setting))))
    return points


def draw(bench, growth, threads, sizes, depths):
    figure, panels = plt.subplots(2, 3, figsize=(12, 7.2), layout="constrained")
    colour = {"balls": COLOURS[0], "mount": COLOURS[1], "balls 4": COLOURS[0], "mount 7": COLOURS[1]}
    first = panels[0][0]
    for name, points in growth.items():
        n = [p["primitives"] for p in points.values()]
        first.plot(n, [p["all"] for p in points.values()], "o-", color=colour[name], label=f"{name}, all rays")
        first.plot(n, [p["primary"] for p in points.values()], "s:", color=colour[name], label=f"{name}, camera rays")
        panels[0][1].plot(n, [p["build"] for p in points.values()], "o-", color=colour[name], label=f"{name}, build")
        panels[0][1].plot(n, [p["load"] for p in points.values()], "s:", color=colour[name], label=f"{name}, load")
    points = growth["balls"]
    ends = [p for s, p in points.items() if s >= 3]
    n0, t0 = ends[0]["primitives"], ends[0]["all"]
    n1 = ends[-1]["primitives"]
    first.plot([n0, n1], [t0, t0 * (n1 / n0) ** .25], "--", color="#555555", linewidth=1, label="$N^{1/4}$")
    panels[0][1].plot([1e4, 1e6], [2e-4, 2e-2], "--", color="#555555", linewidth=1, label="$N$")
    first.set(title="time a ray, one thread", xlabel="primitives", ylabel="ns")
    panels[0][1].set(title="build and load", xlabel="primitives", ylabel="s")
    for name in threads:
        t = threads[name]
        panels[0][2].plot(list(t), [t[1]["render"] / p["render"] for p in t.values()], "o-", color=colour[name], label=name)
        s = sizes[name]
        panels[1][0].plot([side * side for side in s], [p["render"] for p in s.values()], "o-", color=colour[name], label=f"{name}, render")
        panels[1][0].plot([side * side for side in s], [p["write"] for p in s.values()], "s:", color=colour[name], label=f"{name}, write PNG")
        panels[1][1].plot([side * side for side in s], [p["all"] for p in s.values()], "o-", color=colour[name], label=name)
        d = depths[name]
        panels[1][2].plot(list(d), [p["render"] for p in d.values()], "o-", color=colour[name], label=f"{name}, render")
        panels[1][2].plot(list(d), [p["rays"] * 1e-7 for p in d.values()], "s:", color=colour[name], label=f"{name}, rays / 10 million")
    most = max(threads["balls 4"])
    panels[0][2].plot([1, most], [1, most], "--", color="#555555", linewidth=1, label="as many times as threads")
    panels[0][2].set(title="threads, a 512 x 512 picture", xlabel="threads", ylabel="times as fast as one")
    panels[1][0].set(title="size of the picture", xlabel="pixels", ylabel="s")
    panels[1][1].set(title="time a ray by size", xlabel="pixels", ylabel="ns")
    panels[1][2].set(title="longest path", xlabel="--depth", ylabel="s")
    for panel in panels.flat:
        panel.set(xscale="log", yscale="log")
        panel.grid(alpha=.4)
        panel.legend(frameon=False, fontsize=8)
    ticks = sorted(threads["balls 4"])
    for axis in (panels[0][2].xaxis, panels[0][2].yaxis):
        axis.set_ticks(ticks, [str(t) for t in ticks])
        axis.set_ticks([], minor=True)
    panels[1][2].set_xticks(DEPTHS, [str(d) for d in DEPTHS])
    panels[1][2].set_xticks([], minor=True)
    bench.save(figure, "scale")


def main():
    parser = arguments(__doc__, rounds=5)
    parser.add_argument("--quick", action="store_true", help="no scene of a million primitives or more")
    asked = parser.parse_args()
    bench = Bench("scale", asked)
    growth = {"balls": by_primitives(bench, "balls", range(1, 7 if asked.quick else 8)),
              "mount": by_primitives(bench, "mount", range(3, 10 if asked.quick else 12))}
    scenes = {"balls 4": bench.scene("balls", 4), "mount 7": bench.scene("mount", 7)}
    square = f"{SIDE}x{SIDE}"
    counts = sorted({1, *(2 ** k for k in range(10) if 2 ** k <= cores()), cores()})
    threads = by_option(bench, scenes, counts, lambda n: ("--size", square, "--threads", n), more=8)  # what other programs disturb most
    sizes = by_option(bench, scenes, SIDES[:-1] if asked.quick else SIDES, lambda n: ("--size", f"{n}x{n}", "--threads", 1))
    depths = by_option(bench, scenes, DEPTHS, lambda n: ("--size", square, "--threads", 1, "--depth", n))

    rows = [["primitives", name, s, p] for name, points in growth.items() for s, p in points.items()]
    rows += [[what, name, s, p] for what, all_points in (("threads", threads), ("side", sizes), ("depth", depths))
             for name, points in all_points.items() for s, p in points.items()]
    keys = ["primitives", "rays", "primary", "bounce", "shadow", "all", "load", "build", "render", "write", "bytes"]
    bench.write_csv("scale", ["against", "scene", "setting", *[f"{k}_ns" if k in (*KINDS, "all") else k for k in keys]],
                    [[what, name, s, *[f"{p[k]:.5g}" if isinstance(p.get(k), float) else p.get(k, "") for k in keys]] for what, name, s, p in rows])
    draw(bench, growth, threads, sizes, depths)

    last_balls, last_mount = max(growth["balls"]), max(growth["mount"])
    fit = [[name, f"{low} to {high}", *[f"{exponent(growth[name], k, low, high):.2f}" for k in (*KINDS, "all", "build", "load")]]
           for name, low, high in (("balls", 3, last_balls), ("mount", 3, last_mount), ("mount", 7, last_mount))]
    size_rows = [[f"{name} {s}", f"{p['primitives']:,}", *[f"{p[k]:.0f}" if k in p else "–" for k in (*KINDS, "all")], seconds(p["load"]),
                  seconds(p["build"]), f"{p['build'] / p['primitives'] * 1e9:.0f}", f"{p['bytes']:.0f}"]
                 for name, points in growth.items() for s, p in points.items()]
    both = ", ".join(f"{name} {times(threads[name][1]['render'] / threads[name][max(counts)]['render'])}" if max(counts) >= 20 else
                     f"{name} {threads[name][1]['render'] / threads[name][max(counts)]['render']:.2f}" for name in threads)
    bench.section(f"""## How time grows

Pictures of {SIDE} x {SIDE}, paths of at most 5 rays, one thread, on a virtual {cpu_name()}; nanoseconds of tracing a ray by kind, without
shading; the least of several runs. Bytes are geometry and grids together.

{table(["", "primitives", "camera", "bounce", "shadow", "all rays, ns", "load, s", "build, s", "build, ns a primitive", "bytes a primitive"], size_rows)}

Fitted exponents e of time = c N^e:

{table(["", "sizes", "camera", "bounce", "shadow", "all rays", "build", "load"], fit)}

![time against primitives, threads, pixels and depth](images/scale.svg)

{max(counts)} threads over one, whole render: {both} times.

`./run perf scale --keep` makes table, chart and [scale.csv](scale.csv).
""")


if __name__ == "__main__":
    main()
