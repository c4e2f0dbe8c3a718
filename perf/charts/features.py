"""No more than needed: the time of scenes beside that of twins, which ask for more but show none.

The kernel looks at what a scene holds and computes nothing else. A twin has three more primitives,
too small to be seen: dull ones where a feature is out, of glass, mirroring, glowing where it is in;
and a ball, triangle, cone where the scene has none; a lens and area lights so narrow that they
change nothing. Time is CPU seconds of rendering on one thread, the least of several renders that
take turns.
"""
import math

from image_error import read_pfm, rmse, turns
from kept import by_scene, size_in

NAME, TITLE = "features", "What is not needed is not computed"
SAMPLES = 4
UNSEEN = 2e-3  # a picture of a twin may differ by this RMSE: no more than a pixel or two
SCENES = [("star", 36), ("tetra", 8), ("tree", 11), ("distant", 3), ("balls", 4), ("mount", 7),
          ("boat", 10), ("rings", 7)]

DULL = "f .5 .5 .5 1 0 0 0 1"
# Three unseen primitives, and what each is made of: of the first material whose features are all
# asked for
MATERIALS = [[({"Fresnel"}, "f .5 .5 .5 .5 0 0 0 0 10 .5 1.5"),
              ({"glass"}, "f .5 .5 .5 .5 0 10 .5 1.5"), (set(), DULL)],
             [({"rough mirrors"}, "f .5 .5 .5 .5 .5 .5 .5 .5 10 0 1 .3"),
              ({"mirrors"}, "f .5 .5 .5 .5 .5 10 0 1"), (set(), DULL)],
             [({"glow"}, "f .5 .5 .5 1 0 0 0 0 0 0 1 1 1 1"), (set(), DULL)]]
NAMES = {
    "mirrors": "reflection", "glass": "refraction", "Fresnel": "fresnel",
    "rough mirrors": "roughness", "glow": "emission", "smooth normals": "smooth_normals",
    "balls": "spheres", "triangles": "triangles", "cones": "cones", "lens": "lens",
    "area lights": "area_lights"}  # as `grelha info` calls them
KINDS = ("triangles", "balls", "cones")
OPTIONS = {"lens": ["--lens", "1e-6"], "area lights": ["--shadows", "random:1e-6"]}
NORMALS = "smooth normals"
EVERYTHING = set(NAMES)
# Features disabled together, because the others would require them all the same: title, features
LEFT_OUT = [("Fresnel", {"Fresnel"}), ("glass", {"glass", "Fresnel"}),
            ("rough mirrors", {"rough mirrors"}),
            ("mirrors, glass: all bounces", {"mirrors", "glass", "Fresnel", "rough mirrors"}),
            ("glow", {"glow"}), ("smooth normals", {NORMALS}), ("area lights", {"area lights"}),
            ("lens", {"lens"}), ("balls", {"balls"}),
            ("triangles and their normals", {"triangles", NORMALS}), ("cones", {"cones"})]
ALL, UNSEEN_ALONE = "everything asked for", "nothing asked for, unseen things alone"
PLAIN = "the scene as it is"


def number(value):
    return f"{value:.9g}"


def shape(kind, at, size):
    """A primitive of that kind and about that size."""
    x, y, z = at
    corners = [(x, y, z), (x + size, y, z), (x, y + size, z)]
    words = {"balls": ["s", *at, size], "cones": ["c", x, y, z, size, x, y, z + size, size],
             "triangles": ["p 3", *[c for corner in corners for c in corner]],
             NORMALS: ["pp 3", *[c for corner in corners for c in (*corner, 0, 0, 1)]]}[kind]
    return " ".join(word if isinstance(word, str) else number(word) for word in words)


def tail_of(features, needs, bounds):
    """Lines that ask for the features: the three primitives are always there, one of each further
    kind where it is asked for."""
    low, high = bounds["min"], bounds["max"]
    size = 1e-5 * math.dist(low, high)
    places = iter([[a + (b - a) * (.5 + .003 * i) for a, b in zip(low, high)] for i in range(7)])
    own = next(kind for kind in KINDS if needs[NAMES[kind]])
    lines = []
    for choices in MATERIALS:
        lines += [
            next(material for wanted, material in choices if wanted <= features),
            shape(own, next(places), size)]
    lines.append(DULL)
    for kind in (*KINDS, NORMALS):
        place = next(places)
        if kind in features and not needs[NAMES[kind]]:
            lines.append(shape(kind, place, size))
    return lines


def twins(has):
    yield ALL, EVERYTHING
    for title, features in LEFT_OUT:
        if not features & has:
            yield "without " + title, EVERYTHING - features
    yield UNSEEN_ALONE, set()
    yield PLAIN, None


def measure_scene(shop, plan, source):
    scene = shop.scene(source)
    told = shop.info(scene)
    needs = told["needs"]
    has = {feature for feature, name in NAMES.items() if needs[name]}
    runs, points = [], {}
    for i, (title, features) in enumerate(twins(has)):
        tail, options, path = (), [], scene
        if features is not None:
            tail = tail_of(features, needs, told["bounds"])
            options = [
                word for feature, words in OPTIONS.items() if feature in features - has
                for word in words]
            path = shop.folder / f"{scene.stem}-twin-{i}.nff"
            path.write_text(scene.read_text() + "\n".join(tail) + "\n")
        options = ["--threads", "1", "--samples", SAMPLES, *options]
        runs.append((title, path, options))
        points[title] = {
            "label": title, "seconds": math.inf, "command": shop.command(source, options, tail)}
    plain, picture, spent = shop.folder / "plain.pfm", shop.folder / "twin.pfm", 0
    shop.render(scene, runs[-1][2], plain)
    for turn in turns(plan, lambda: spent):
        for title, path, options in runs:
            point = points[title]
            seconds = shop.render(path, options, picture)["seconds"]["render_cpu"]
            spent += seconds
            point["seconds"] = max(min(point["seconds"], seconds), 1e-6)
            if turn == 0:
                point["rmse"] = rmse(read_pfm(picture), read_pfm(plain))
                if point["rmse"] > UNSEEN:
                    print(
                        f"  {scene.stem}, {title}: not the same picture, RMSE {point['rmse']:.2g}",
                        flush=True)
    return {
        "scene": " ".join(map(str, source)), "has": sorted(has), "points": list(points.values())}


def measure(shop, plan):
    results = []
    for source in SCENES[:plan.scenes]:
        print(f"features: {source[0]} {source[1]}", flush=True)
        results.append(measure_scene(shop, plan, source))
    return {"size": shop.size[1], "scenes": results}


def share(scene, p):
    return p["seconds"] / scene["points"][0]["seconds"]


def csv(result):
    rows = [[s["scene"], p["label"], f"{p['seconds']:.4g}", f"{share(s, p):.3f}",
             f"{p['rmse']:.2g}", p["command"]]
            for s in result["scenes"] for p in s["points"]]
    return ["scene", "features", "cpu_seconds", "over_everything", "rmse_to_plain", "command"], rows


def from_csv(rows):
    """The measurements in the format of docs/charts-features.csv."""
    def point(row):
        return {
            "label": row["features"], "seconds": float(row["cpu_seconds"]),
            "rmse": float(row["rmse_to_plain"]), "command": row["command"]
        }

    return {"size": size_in(rows[0]["command"]), "scenes": by_scene(rows, point)}


def charts(result):
    names = [ALL, *["without " + title for title, _ in LEFT_OUT], UNSEEN_ALONE, PLAIN]
    shares = [share(scene, p) for scene in result["scenes"] for p in scene["points"]]
    span = [math.floor(20 * min(shares) - .5) / 20, math.ceil(20 * max(shares) + .5) / 20]
    panels = []
    for scene in result["scenes"]:
        points = [{
            "x": share(scene, p), "y": names.index(p["label"]), "label": p["label"],
            "command": p["command"]}
                  for p in scene["points"]]
        whole = scene["points"][0]["seconds"] * 1e3
        panels.append({
            "title": f"{scene['scene']}: {whole:.3g} ms with all",
            "x": {"label": "time / time with all",
                  "span": span}, "y": {"names": names, "label": "what is asked for"},
            "lines": [{"x": 1, "label": "with everything"}], "series": [{
                "name": "CPU time; no point: the scene needs it", "look": 5, "joined": False,
                "points": points
            }]
        })
    return [{
        "name": "features",
        "title": f"{TITLE}: time with a feature left out, {result['size']}, {SAMPLES} samples a "
                 "pixel",
        "columns": 4, "panel_size": (3.5, 3.3), "panels": panels
    }]


def tell(result, table):
    names = ["without " + title for title, _ in LEFT_OUT] + [UNSEEN_ALONE, PLAIN]
    cells = {
        s["scene"]: {p["label"]: f"{share(s, p):.2f}" for p in s["points"]}
        for s in result["scenes"]}
    rows = [[name, *[cells[s["scene"]].get(name, "needed") for s in result["scenes"]]]
            for name in names]
    times = [f"{s['points'][-1]['seconds'] * 1e3:.3g}" for s in result["scenes"]]
    rows.append(["the same, ms", *times])
    return f"""\
Time over that of the same picture with everything asked for; *needed*: the scene itself does.

{table(["", *[s["scene"] for s in result["scenes"]]], rows)}"""
