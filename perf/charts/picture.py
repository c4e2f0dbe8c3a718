"""Error of pictures against the time they take.

Each effect has a panel, each method a curve in it, with the Pareto front behind the curves.
Error is the RMSE, and 1 - SSIM, of the displayed values against a reference of other seeds made of
two halves. Time is the CPU seconds of rendering on one thread, the least of several renders that
take turns.
"""
import math

from chart import pareto_front, slope
from image_error import (REFERENCE_SEEDS, Refused, read_pfm, reference_settings, rmse, ssim,
                         time_to_reach)
from kept import size_in

NAME, TITLE = "picture", "Error of a picture against its time"
SEED = 1
REFERENCE = "reference: mean of two"  # its row in the CSV
LEAST_SSIM = 1e-5  # 1 - SSIM: the CSV has five digits
COUNTS = [1, 4, 16, 64, 256]
LONG = 3  # CPU seconds a point is given; at least one render, at most as many as rounds

BALLS = "scenes/data/balls.nff"
# name, title, scene, options of the effect
EFFECTS = [
    ("edges", "edges: star", ("star", 36), []),
    ("shadows", "area light: boat", ("boat", 10), ["--shadows", "random:2"]),
    ("awning", "area light of which pixels see a part: awning", ("awning", 64), []),
    ("lens", "lens: distant", ("distant", 8), ["--lens", "40"]),
    ("glossy", "rough mirrors: balls", BALLS, ["--glossy", ".1", "--depth", "3"]),
    ("all", "lens, area lights, rough mirrors: balls", BALLS,
     ["--shadows", "random:.5", "--lens", "12", "--glossy", ".08", "--depth", "3"]),
]


def fixed(sampler):
    return [(str(n), ["--sampler", sampler, "--samples", str(n)]) for n in COUNTS]


SOBOL, BY_ERROR = "sobol: N samples", "--error E"

# series, look, settings; only of effects named, where any are
METHODS = [
    ("random: N samples", 0, fixed("random"), None),
    ("jitter: N samples (--aa jitter:√N)", 1, [(str(n * n), ["--aa", f"jitter:{n}"])
                                               for n in (1, 2, 4, 8, 16)], None),
    ("adaptive:0.1,D", 3, [(f"0.1,{d}", ["--aa", f"adaptive:0.1,{d}"])
                           for d in (1, 2, 3, 4, 5)], None),
    ("adaptive:T,3", 4, [(f"{t},3", ["--aa", f"adaptive:{t},3"])
                         for t in (.8, .4, .2, .05, .025)], None),
    (SOBOL, 5, fixed("sobol"), None),
    (BY_ERROR, 6, [(str(e), ["--error", str(e)])
                   for e in (.08, .04, .02, .01, .005, .0025, .00125)], None),
    ("sobol, area:S,2√N: 4 points of each light a sample", 8,
     [(str(n), ["--samples", str(n), "--shadows", f"area:2,{m}"])
      for n, m in ((1, 2), (4, 4), (16, 8), (64, 16))], ("shadows", )),
    ("sobol, glossy:R,N: 4 samples, N rays beside the mirror's", 9,
     [(f".1,{n}", ["--samples", "4", "--glossy", f".1,{n}"]) for n in (1, 2, 4, 8)], ("glossy", )),
]


def joined(options, more):
    """Both, an option given twice taken from `more`."""
    pairs = {options[i]: options[i + 1] for i in range(0, len(options), 2)}
    pairs.update({more[i]: more[i + 1] for i in range(0, len(more), 2)})
    return [word for pair in pairs.items() for word in pair]


def settings_of(effect, plan):
    """Series, label and options of every point."""
    for series, _, settings, only in METHODS:
        if only is None or effect in only:
            for label, words in settings[:plan.settings]:
                yield series, label, words


def measure_effect(shop, plan, effect, source, options):
    scene = shop.scene(source)
    reference, floor = shop.reference(scene, options, plan.reference)
    picture = shop.folder / "point.pfm"
    points, refused = {}, set()
    for turn in range(plan.rounds):
        for series, label, words in settings_of(effect, plan):
            point = points.setdefault(
                (series, label),
                {"series": series, "label": label, "spent": 0, "seconds": math.inf})
            if series in refused or point["spent"] * (turn + 1) > LONG * max(turn, 1) and turn:
                continue
            told = ["--threads", "1", "--seed", SEED, *joined(options, words)]
            try:
                stats = shop.render(scene, told, picture)
            except Refused as why:
                print(f"  {effect}: {series} left out: {why}", flush=True)
                refused.add(series)
                del points[series, label]
                continue
            seconds = stats["seconds"]["render_cpu"]
            point["spent"] += seconds
            # of a clock that counts microseconds
            point["seconds"] = max(min(point["seconds"], seconds), 1e-5)
            if turn == 0:
                image = read_pfm(picture)
                point["rays"] = sum(stats["rays"].values())
                point["samples"] = stats["rays"]["primary"] / math.prod(stats["size"])
                point["rmse"], point["ssim"] = rmse(image, reference), ssim(image, reference)
                point["command"] = shop.command(source, told)
    halves = [
        shop.command(source, reference_settings(options, plan.reference, seed))
        for seed in REFERENCE_SEEDS]
    return {
        "effect": effect, "floor": floor, "reference": plan.reference, "halves": halves,
        "points": list(points.values())}


def measure(shop, plan):
    results = []
    for effect, title, source, options in EFFECTS[:plan.scenes]:
        print(f"picture: {title}", flush=True)
        results.append({"title": title, **measure_effect(shop, plan, effect, source, options)})
    return {"size": shop.size[1], "effects": results}


def csv(result):
    header = [
        "effect", "method", "setting", "samples_per_pixel", "rays", "cpu_seconds", "rmse", "ssim",
        "command"]
    rows = []
    for e in result["effects"]:
        rows += [[e["effect"], p["series"], p["label"], f"{p['samples']:.4g}", p["rays"],
                  f"{p['seconds']:.4g}", f"{p['rmse']:.4g}", f"{p['ssim']:.5f}", p["command"]]
                 for p in e["points"]]
        rows.append([
            e["effect"], REFERENCE, e["reference"], e["reference"], "", "", f"{e['floor']:.2g}", "",
            "; ".join(e["halves"])
        ])
    return header, rows


def from_csv(rows):
    """The measurements in the format of docs/charts-picture.csv."""
    titles, effects = {name: title for name, title, *_ in EFFECTS}, {}
    for row in rows:
        effect = effects.setdefault(
            row["effect"], {"title": titles[row["effect"]], "effect": row["effect"], "points": []})
        if row["method"] == REFERENCE:
            effect |= {
                "floor": float(row["rmse"]), "reference": int(row["setting"]),
                "halves": row["command"].split("; ")
            }
        else:
            effect["points"].append({
                "series": row["method"], "label": row["setting"],
                "samples": float(row["samples_per_pixel"]), "rays": int(row["rays"]),
                "seconds": float(row["cpu_seconds"]), "rmse": float(row["rmse"]),
                "ssim": float(row["ssim"]), "command": row["command"]
            })
    return {"size": size_in(rows[0]["command"]), "effects": list(effects.values())}


def panel_of(effect, key, label):
    series = []
    for name, look, _, _ in METHODS:
        points = [{
            "x": p["seconds"], "y": max(key(p), 1e-7),
            "label": p["label"], "command": p["command"]
        } for p in effect["points"] if p["series"] == name]
        if points:
            series.append({"name": name, "look": look, "joined": True, "points": points})
    panel = {
        "title": effect["title"], "x": {"label": "CPU seconds, one thread", "log": True},
        "y": {"label": label, "log": True}, "series": series,
        "front": [{"x": p["x"], "y": p["y"]}
                  for p in pareto_front([p for s in series for p in s["points"]])]}
    return panel


def charts(result):
    panels = [panel_of(e, lambda p: p["rmse"], "RMSE (white is 1)") for e in result["effects"]]
    for panel, e in zip(panels, result["effects"]):
        panel["lines"] = [{"y": e["floor"], "label": "error of the reference itself"}]
    alike = [
        panel_of(e, lambda p: max(1 - p["ssim"], LEAST_SSIM), "1 - SSIM (.00001: that or less)")
        for e in result["effects"]
    ]
    return [{
        "name": "picture", "title": f"{TITLE}, {result['size']}: down and left is better",
        "panels": panels}, {
            "name": "picture-ssim",
            "title": f"Structural error against time, {result['size']}: down and left is better",
            "panels": alike}]


def finest_slope(points):
    """Of the three finest settings: what more time buys."""
    chosen = [{"x": p["seconds"], "y": p["rmse"]} for p in points if p["rmse"] > 0][-3:]
    return slope(chosen) if len(chosen) == 3 else math.nan


def speed_up(points, goal):
    """How much sooner than `goal` its error is reached; '–' where it never is."""
    reached = time_to_reach(points, goal["rmse"])
    if reached:
        return f"{goal['seconds'] / reached:.2g}"
    first = points[0]
    return f"> {goal['seconds'] / first['seconds']:.2g}" if first["rmse"] < goal["rmse"] else "–"


def beside_samples(effect):
    """By E: time of --error E over that of plain samples, interpolated, to the same error; '–'
    where 256 samples do not get there."""
    of = {name: [p for p in effect["points"] if p["series"] == name] for name in (SOBOL, BY_ERROR)}
    reached = {p["label"]: time_to_reach(of[SOBOL], p["rmse"]) for p in of[BY_ERROR]}
    return {
        p["label"]: f"{p['seconds'] / reached[p['label']]:.2f}" if reached[p["label"]] else "–"
        for p in of[BY_ERROR]
    }


def tell(result, table):
    names = [
        name for name, *_ in METHODS
        if any(p["series"] == name for e in result["effects"] for p in e["points"])]
    slopes, gains, goals = [], [], []
    for e in result["effects"]:
        of = {name: [p for p in e["points"] if p["series"] == name] for name in names}
        goal = of[METHODS[0][0]][-1]
        goals.append(f"{goal['rmse']:.2g}")
        slopes.append([f"{finest_slope(of[n]):.2f}" if len(of[n]) >= 3 else "" for n in names])
        gains.append([
            ("1" if n == METHODS[0][0] else speed_up(of[n], goal)) if of[n] else "" for n in names])
    header = ["", *[e["effect"] for e in result["effects"]]]
    turned = lambda cells: [[n, *column] for n, column in zip(names, zip(*cells))]
    beside = [beside_samples(e) for e in result["effects"]]
    errors = [[f"--error {label}", *[b.get(label, "") for b in beside]] for label in beside[0]]
    return f"""\
Slope of the logarithm of the RMSE over that of time, at each method's three finest settings. At
-.5 half the error takes four times the time; at 0 more time buys nothing:

{table(header, turned(slopes))}

Times as fast as random samples to the error of the finest of them. –: never got there; >: its
coarsest setting already had:

{table(header, [["RMSE of that setting", *goals], *turned(gains)])}

Time of `--error E` over that of sobol samples to the same RMSE, whatever their number
(interpolated); –: 256 do not get there:

{table(header, errors)}"""
