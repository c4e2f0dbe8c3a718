"""Error of intersection and traversal against nanoseconds a ray, from what the benchmark `precision` measures.

`./run perf precision --json FILE` writes {"cpu": name, "rows": [{"isa": "scalar|sse2|avx2|avx512|embree", "precision": "single|double",
"method": "moeller|watertight|robust|default|...", "fma": false, "scene": name, "rays": count, "max_ulp": E, "p999_ulp": E, "wrong": count,
"ns": T, "command": text}]}: the error of hit distances in units of the last place of a float (the largest, and the one that 99.9 % of the hits
do not exceed), rays that hit what they should miss, miss what they should hit or hit another primitive, and nanoseconds a ray. `command` may be left
out; then that of the whole benchmark stands beside the point.
"""
import json
import subprocess

from chart import pareto_front

NAME, TITLE = "rays", "Error of a ray against its time"
ISAS = ("scalar", "sse2", "avx2", "avx512", "embree")
LEAST_ULP = .1  # what is less, zero too, is drawn here
QUICK = ["--quick"]


def measure(shop, plan):
    tool, file = shop.program.parent / "precision", shop.folder / "precision.json"
    if not tool.exists():
        print("rays: LEFT OUT, there is no benchmark `precision` in this build", flush=True)
        return None
    print("rays: ./run perf precision", flush=True)
    subprocess.run([tool, "--json", file, *(QUICK if plan.quick else [])], check=True)
    return json.loads(file.read_text())


def command(row):
    return row.get("command", "./run perf precision --json precision.json")


def name_of(row):
    return f"{row['precision']} {row['method']}" + (" fma" if row["fma"] else "")


def csv(result):
    header = ["scene", "isa", "precision", "method", "fma", "rays", "max_ulp", "p999_ulp", "wrong", "ns_a_ray", "command"]
    return header, [[r["scene"], r["isa"], r["precision"], r["method"], int(r["fma"]), r["rays"], f"{r['max_ulp']:.4g}", f"{r['p999_ulp']:.4g}",
                     r["wrong"], f"{r['ns']:.4g}", command(r)] for r in result["rows"]]


def panel(rows, title, y, value):
    names = list(dict.fromkeys(("Embree " if r["isa"] == "embree" else "") + name_of(r) for r in rows))
    series = []
    for look, name in enumerate(names):
        own = [r for r in rows if ("Embree " if r["isa"] == "embree" else "") + name_of(r) == name]
        points = [{"x": r["ns"], "y": value(r), "label": r["isa"], "command": command(r),
                   "facts": f"{r['ns']:.3g} ns, 99.9 % {r['p999_ulp']:.3g} ulp, max {r['max_ulp']:.3g} ulp, {r['wrong']} of {r['rays']} wrong"}
                  for r in own]
        series.append({"name": name, "look": look, "joined": True, "points": points})
    return {"title": title, "x": {"label": "ns a ray", "log": True}, "y": {"label": y, "log": True}, "series": series,
            "front": [{"x": p["x"], "y": p["y"]} for p in pareto_front([p for s in series for p in s["points"]])]}


def charts(result):
    panels = []
    for scene in dict.fromkeys(r["scene"] for r in result["rows"]):
        rows = sorted((r for r in result["rows"] if r["scene"] == scene), key=lambda r: ISAS.index(r["isa"]))
        ulp = f"ulp of a float ({LEAST_ULP:g}: that or less)"
        panels += [panel(rows, f"{scene}: distance, 99.9 %", ulp, lambda r: max(r["p999_ulp"], LEAST_ULP)),
                   panel(rows, f"{scene}: distance, largest", ulp, lambda r: max(r["max_ulp"], LEAST_ULP)),
                   panel(rows, f"{scene}: wrong hits", "wrong a million rays (.1: none)", lambda r: max(1e6 * r["wrong"] / r["rays"], .1))]
    return [{"name": "rays", "title": f"{TITLE}: scalar to AVX-512 along each line", "columns": 3, "panel_size": (4.2, 3.4), "panels": panels,
             "note": "Along each line from scalar over SSE2 and AVX2 to AVX-512, as far as the processor has them."}]


def tell(result, table):
    rows = [[r["scene"], ("Embree" if r["isa"] == "embree" else r["isa"]), name_of(r), f"{r['max_ulp']:.3g}", f"{r['p999_ulp']:.3g}",
             f"{r['wrong']} of {r['rays']}", f"{r['ns']:.3g}"] for r in result["rows"]]
    header = ["", "lanes", "method", "max ulp", "99.9 % ulp", "wrong hits", "ns a ray"]
    return "![error of a ray against its time](images/charts-rays.svg)\n\n" + table(header, rows)
