"""Error of intersection against nanoseconds a test, from what the benchmark `precision` measures.

Its JSON is Google Benchmark's: a benchmark is named isa[+fma]/precision/method, and its counters
are max_ulp and p999_ulp (error of hit distances in units of the last place of a float, the largest
and the one that 99.9 % do not exceed), rays, wrong (of these, hits of another triangle than the
true one), leaks (rays at edges and corners of a closed hull that meet nothing) and ns (of one
test). With --scenes it traces whole scenes, isa/precision/scene, Embree beside: ns is that of a ray
then.
"""
import json
import subprocess

from chart import pareto_front

NAME, TITLE = "rays", "Error of a ray against its time"
ISAS = ("scalar", "sse2", "avx2", "avx512", "embree")
TESTS = "bare tests"
METHODS = ("watertight", "moeller-trumbore")
LEAST_ULP = 1e-7  # what is less, zero too, is drawn here


def row_of(benchmark):
    isa, precision, method = benchmark["run_name"].split("/")
    isa, _, fused = isa.partition("+")
    counted = {
        key: benchmark[key] for key in ("max_ulp", "p999_ulp", "rays", "wrong", "leaks", "ns")}
    scene, method = (TESTS, method) if method in METHODS else (method, "trace")
    return {
        "isa": isa, "precision": precision, "method": method, "fma": bool(fused), "scene": scene,
        **counted}


def rows_of(told):
    """Of each test the least time; its errors are the same in all repetitions."""
    best = {}
    for benchmark in told["benchmarks"]:
        if benchmark.get("run_type", "iteration") == "iteration":
            name, row = benchmark["run_name"], row_of(benchmark)
            best[name] = min(best.get(name, row), row, key=lambda r: r["ns"])
    return list(best.values())


def measure(shop, plan):
    tool, file = shop.program.parent / "precision", shop.folder / "precision.json"
    if not tool.exists():
        tool = shop.program.parent / "perf" / "precision"
    if not tool.exists():
        print("rays: LEFT OUT, there is no benchmark `precision` in this build", flush=True)
        return None
    rows = []
    for words in ([], ["--scenes"]):
        print(" ".join(["rays: ./run perf precision", *words]), flush=True)
        command = [
            tool, *words, f"--benchmark_out={file}", "--benchmark_out_format=json",
            f"--benchmark_repetitions={plan.rounds}",
            f"--benchmark_min_time={.05 if plan.quick else .3}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        rows += rows_of(json.loads(file.read_text()))
    return {"rows": rows}


def command(row):
    fused = r"\+fma" if row["fma"] else ""
    scenes, last = ("", row["method"]) if row["scene"] == TESTS else (" --scenes", row["scene"])
    name = f"{row['isa']}{fused}/{row['precision']}/{last}"
    return f"./run perf precision{scenes} --benchmark_filter='^{name}$'"


def name_of(row):
    return f"{row['precision']} {row['method']}" + (" fma" if row["fma"] else "")


def csv(result):
    header = [
        "scene", "isa", "precision", "method", "fma", "rays", "max_ulp", "p999_ulp", "wrong",
        "leaks", "ns", "command"]
    rows = [[r["scene"], r["isa"], r["precision"], r["method"], int(r["fma"]), f"{r['rays']:.0f}",
             f"{r['max_ulp']:.4g}", f"{r['p999_ulp']:.4g}", f"{r['wrong']:.0f}",
             f"{r['leaks']:.0f}", f"{r['ns']:.4g}", command(r)]
            for r in result["rows"]]
    return header, rows


def from_csv(rows):
    """What was measured, as docs/charts-rays.csv keeps it."""
    numbers = ("rays", "max_ulp", "p999_ulp", "wrong", "leaks", "ns")
    return {
        "rows": [{**row, "fma": row["fma"] == "1", **{key: float(row[key])
                                                      for key in numbers}}
                 for row in rows]
    }


def series_of(row):
    return ("Embree " if row["isa"] == "embree" else "") + name_of(row)


def panel(rows, looks, title, y, value):
    series = []
    for name in dict.fromkeys(map(series_of, rows)):
        own = [r for r in rows if series_of(r) == name]
        points = [{
            "x": r["ns"], "y": value(r), "label": r["isa"], "command": command(r),
            "facts": f"{r['ns']:.3g} ns, 99.9 % {r['p999_ulp']:.3g} ulp, max {r['max_ulp']:.3g} "
                     f"ulp, {r['wrong']:.0f} of {r['rays']:.0f} wrong"
        } for r in own]
        series.append({"name": name, "look": looks[name], "joined": True, "points": points})
    x = "ns a test" if rows[0]["scene"] == TESTS else "ns a ray"
    return {
        "title": title, "x": {"label": x, "log": True}, "y": {"label": y, "log": True},
        "series": series,
        "front": [{"x": p["x"], "y": p["y"]}
                  for p in pareto_front([p for s in series for p in s["points"]])]}


def charts(result):
    names, panels = dict.fromkeys(map(series_of, result["rows"])), []
    looks = {name: look for look, name in enumerate(names)}
    for scene in dict.fromkeys(r["scene"] for r in result["rows"]):
        rows = sorted((r for r in result["rows"] if r["scene"] == scene),
                      key=lambda r: ISAS.index(r["isa"]))
        ulp = "ulp of a float (.0000001: that or less)"
        panels += [
            panel(rows, looks, f"{scene}: distance, 99.9 %", ulp,
                  lambda r: max(r["p999_ulp"], LEAST_ULP)),
            panel(rows, looks, f"{scene}: distance, largest", ulp,
                  lambda r: max(r["max_ulp"], LEAST_ULP)),
            panel(rows, looks, f"{scene}: wrong hits", "wrong a million rays (.1: none)",
                  lambda r: max(1e6 * r["wrong"] / r["rays"], .1))
        ]
    return [{
        "name": "rays", "title": f"{TITLE}: scalar to AVX-512 along each line", "columns": 3,
        "panel_size": (4.2, 3.4), "panels": panels,
        "note": "Along each line from scalar over SSE2 and AVX2 to AVX-512, as far as the "
                "processor has them."
    }]


def tell(result, table):
    rows = [[r["scene"], ("Embree" if r["isa"] == "embree" else r["isa"]), name_of(r),
             f"{r['max_ulp']:.3g}", f"{r['p999_ulp']:.3g}", f"{r['wrong']:.0f} of {r['rays']:.0f}",
             f"{r['leaks']:.0f}", f"{r['ns']:.3g}"]
            for r in result["rows"]]
    header = [
        "", "lanes", "method", "max ulp", "99.9 % ulp", "wrong hits", "leaks", "ns a test or ray"]
    return "![error of a ray against its time](images/charts-rays.svg)\n\n" + table(header, rows)
