#!/usr/bin/env python3
"""Puts figures of the CSVs in docs/ into prose, and says under tables when and where they are from.

    perf/figures.py [--check]

In a page `<!-- NAME -->figure<!-- / -->` holds one of FIGURES, or with NAME `measured CSV` the row
of docs/measured.csv, which benchmarks write when they write the CSV. A section that a benchmark
made gets such a line at its end where it names no commit itself. --check: exit status 1 if a page
would change, or a CSV has no row.
"""
import csv
import math
import pathlib
import re
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "lib"))
import doc_tables

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
SECTIONS = {  # what a section's maker measures, by its marks
    "frame, profile": "frame-profile", "frame, povray": "frame-povray", "report": "report",
    "stability": "stability", "error_suite": "error-suite",
    "exact": "exact",
}


def rows_of(name):
    lines = (DOCS / f"{name}.csv").read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def measured():
    return {row["csv"]: f"at commit {row['commit']} on {row['machine']}, {row['date']}"
            for row in rows_of("measured")}


def povray_ratios():
    """POV-Ray's CPU seconds over Grelha's, one thread, by scene and case."""
    cpu = {(r["scene"], r["case"], r["program"]): float(r["render_cpu_seconds"])
           for r in rows_of("frame-povray") if r["threads"] == "1"}
    return {(scene, case): cpu[scene, case, "POV-Ray"] / cpu[scene, case, "Grelha"]
            for scene, case, who in cpu if who == "Grelha"}


def span(values):
    return f"{min(values):.1f} to {max(values):.1f}"


def mean(values):
    return f"{math.exp(statistics.fmean(map(math.log, values))):.2f}"


def ratios(column):
    return [float(r[column]) for r in rows_of("trace") if r[column]]


def bytes_of(spheres):
    """Bytes of a World a primitive, from least to most."""
    found = [float(r["grelha_bytes"]) for r in rows_of("build")
             if r["scene"].startswith("balls") == spheres]
    return f"{min(found):.0f} to {max(found):.0f}"


def lost():
    """Rays that were sent and lost, by tracer and where they aim."""
    rows = rows_of("lost")

    def count(*tracers, aims=("vertices", "edges", "random"), column="lost"):
        return sum(int(r[column]) for r in rows if r["tracer"] in tracers and r["aim"] in aims)
    sent = {aims: count("Grelha", aims=aims, column="rays") // 10**6
            for aims in (("vertices",), ("edges", "random"))}
    return {"sent-at-vertices": f"{sent['vertices',]} million",
            "sent-elsewhere": f"{sent['edges', 'random']} million",
            "lost": doc_tables.lost(rows), "lost-by-grelha": f"{count('Grelha'):,}",
            "robust-at-vertices": f"{count('Embree robust', aims=['vertices']):,}",
            "robust-elsewhere": f"{count('Embree robust', aims=['edges', 'random']):,}"}


def python_time():
    rows = rows_of("python-time")
    return {"python-streams": mean([float(r["ratio"]) for r in rows]),
            "python-calls": span([float(r["one_python_us"]) for r in rows])}


def programs():
    rows = [r for r in rows_of("programs") if r["ratio"]]
    lines = {r["program"]: (r["lines"], r["embree_lines"]) for r in rows}
    own, other = zip(*lines.values())
    return {"programs": span([float(r["ratio"]) for r in rows]),
            "program-lines": f"{', '.join(own)} beside {', '.join(other)}"}


def figures():
    calls = ratios("ratio_of_calls")
    told = {"povray": span(povray_ratios().values()),
            "ladder": doc_tables.ladder(rows_of("ladder")),
            "build": doc_tables.build(rows_of("build")),
            "trace": doc_tables.trace(rows_of("trace")),
            "distance": doc_tables.distance(rows_of("distance")),
            "distances": doc_tables.distances(rows_of("distance")),
            "bytes-of-spheres": bytes_of(True), "bytes-of-triangles": bytes_of(False),
            "builds": span([float(r["grelha_1_least_ms"]) / float(r["embree_medium_1_least_ms"])
                            for r in rows_of("build")]),
            "embree": span([1 / r for r in ratios("ratio")]), "calls": span(calls),
            "calls-mean": mean(calls), "streams": span(ratios("ratio")),
            "streams-mean": mean(ratios("ratio"))}
    told |= lost() | python_time() | programs()
    return told | {f"measured {name}": text for name, text in measured().items()}


def with_places(text):
    """Ends each section with the place of its figure, where it names no commit."""
    for name, numbers in SECTIONS.items():
        end = f"<!-- end of {name} -->"
        at = text.find(end)
        section = text[text.rfind("<!-- made by", 0, at):at] if at >= 0 else "commit"
        if "commit" not in section and f"measured {numbers}" not in section:
            text = text[:at] + f"\nMeasured <!-- measured {numbers} --><!-- / -->.\n" + text[at:]
    return text


def renewed(text, told):
    for name, figure in told.items():
        text = re.sub(rf"(<!-- {re.escape(name)} -->).*?(<!-- / -->)",
                      lambda m: m[1] + figure + m[2], text, flags=re.S)
    return text


def main():
    told, wrong = figures(), []
    for page in PAGES:
        text = page.read_text()
        new = renewed(with_places(text), told)
        unknown = set(re.findall(r"<!-- ([^>]*?) -->[^<]*<!-- / -->", new)) - set(told)
        wrong += [f"{page.name}: no figure \"{name}\"" for name in unknown]
        if new != text and sys.argv[1:] == ["--check"]:
            wrong.append(f"{page.name}: its figures are not those of the CSVs: perf/figures.py")
        elif new != text:
            page.write_text(new)
    known = measured()
    wrong += [f"docs/{file.name}: no row in docs/measured.csv"
              for file in sorted(DOCS.glob("*.csv"))
              if file.stem != "measured" and file.stem not in known]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
