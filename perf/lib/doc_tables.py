"""Tables of docs/performance.md that are made from a CSV, whenever perf/figures.py runs."""
import math
import statistics

SPHERES = ("balls", "rings", "distant")  # how names of scenes without triangles begin


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" + "|--:" * (len(header) - 1) + "|"]
    return "\n" + "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def ladder(rows):
    """How many times as fast as the plain grid each rung is, by scene and kind of ray."""
    cells = {(r["rung"], r["rays"], r["scene"]): r["times"] for r in rows}
    columns = list(dict.fromkeys((rays, scene) for _, rays, scene in cells))
    rungs = [rung for rung in dict.fromkeys(rung for rung, *_ in cells)
             if all((rung, *c) in cells for c in columns)]
    return table(["", *(f"{scene}, {rays} rays" for rays, scene in columns)],
                 [[rung, *(cells[(rung, *c)] for c in columns)] for rung in rungs])


def build(rows):
    """Least times of building over Embree's MEDIUM tree, and two threads over one."""
    out = []
    for r in rows:
        ms = {k: float(r[f"{k}_least_ms"]) for k in (
            "grelha_1", "grelha_2", "embree_medium_1", "embree_medium_2")}
        out.append([r["scene"], f"{ms['grelha_1'] / ms['embree_medium_1']:.2f}",
                    f"{ms['grelha_2'] / ms['embree_medium_2']:.2f}",
                    f"{ms['grelha_1'] / ms['grelha_2']:.2f}"])
    return table(["", "1 thread", "2 threads", "two threads over one"], out)


def mean(values):
    return f"{math.exp(statistics.fmean(map(math.log, values))):.2f}"


def trace(rows):
    """Geometric means of times over Embree's, by kind of ray: streams, the slowest, calls."""
    rows = [r for r in rows if r["ratio"]]

    def cells(of):
        def ratios(column, spheres):
            return [float(r[column]) for r in of
                    if r["scene"].startswith(SPHERES) == spheres]
        slowest = max(of, key=lambda r: float(r["ratio"]))
        return [mean(ratios("ratio", True)), mean(ratios("ratio", False)),
                f"{float(slowest['ratio']):.2f} ({slowest['scene']})",
                mean(ratios("ratio_of_calls", True)), mean(ratios("ratio_of_calls", False))]

    kinds = dict.fromkeys(r["kind"] for r in rows)
    return table(["rays", "streams, spheres", "streams, triangles", "slowest scene",
                  "calls, spheres", "calls, triangles"],
                 [[kind, *cells([r for r in rows if r["kind"] == kind])] for kind in kinds]
                 + [["all", *cells(rows)]])


def lost(rows):
    """Rays that were lost, and the mean time of a ray, by where rays aim."""
    tracers = list(dict.fromkeys(r["tracer"] for r in rows))
    lines = []
    for aim in dict.fromkeys(r["aim"] for r in rows):
        own = [[r for r in rows if r["aim"] == aim and r["tracer"] == t] for t in tracers]
        lines.append([f"{sum(int(r['rays']) for r in own[0]):,} at {aim}",
                      *(f"{sum(int(r['lost']) for r in of):,}; "
                        f"{mean([float(r['us_a_ray']) for r in of])} us" for of in own)])
    return table(["rays", *tracers], lines)


def over(rows, place, way, other):
    return mean([float(r[way]) / float(r[other]) for r in rows
                 if r["points"] == place and r[other] != "-"])


def distance(rows):
    """Geometric means of times over Embree's and CGAL's, by where the points lie."""
    places = dict.fromkeys(r["points"] for r in rows)
    return table(["points", "arrays over Embree", "calls over Embree", "arrays over CGAL"],
                 [[p, over(rows, p, "array", "Embree"), over(rows, p, "call", "Embree"),
                   over(rows, p, "array", "CGAL")] for p in places])


def distances(rows):
    """From the least to the largest mean over Embree's."""
    means = sorted(over(rows, p, "array", "Embree") for p in {r["points"] for r in rows})
    return f"{means[0]} to {means[-1]}"
