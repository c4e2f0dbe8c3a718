#!/usr/bin/env python3
"""What `./run charts` computes, on known answers; a small run of it; its commands, typed again.

    charts_test.py PROGRAM

Exit status 77: a package the charts need is missing.
"""
import csv
import html
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "perf" / name) for name in ("", "lib", "charts")]
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
try:
    import matplotlib.text
    import numpy as np
    import chart
    import charts
    import features
    import grid
    import image_error
    import picture
    import bench
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def points(*pairs):
    return [{"x": x, "y": y} for x, y in pairs]


class Curves(unittest.TestCase):
    def test_the_front_holds_what_nothing_beats(self):
        front = chart.pareto_front(points((1, 9), (2, 4), (2, 5), (3, 4), (4, 1), (5, 2)))
        self.assertEqual(front, points((1, 9), (2, 4), (4, 1)))

    def test_a_power_law_has_its_exponent_as_slope(self):
        self.assertAlmostEqual(chart.slope(points(*[(x, 3 * x**-.75) for x in (1, 2, 5, 40)])),
                               -.75)

    def test_time_to_an_error_lies_on_the_line_between(self):
        curve = [{"rmse": t ** -.5, "seconds": t} for t in (1, 4, 64)]
        self.assertAlmostEqual(image_error.time_to_reach(curve, .25), 16)
        self.assertIsNone(image_error.time_to_reach(curve, .01))

    def test_speed_up_tells_of_what_never_arrives_and_of_what_was_there(self):
        goal = {"rmse": .1, "seconds": 8}
        self.assertEqual(
            picture.speed_up([{"rmse": .2, "seconds": 1}, {"rmse": .05, "seconds": 4}], goal), "4")
        self.assertEqual(
            picture.speed_up([{"rmse": .3, "seconds": 1}, {"rmse": .2, "seconds": 9}], goal), "–")
        self.assertEqual(picture.speed_up([{"rmse": .05, "seconds": 2}], goal), "> 4")

    def test_rounds_end_with_the_time_they_are_given(self):
        plan = types.SimpleNamespace(rounds=3, seconds=10)
        for cost, expected in ((1, 10), (100, 3), (.01, 12)):
            spent = 0
            for turn in image_error.turns(plan, lambda: spent):
                spent += cost
            self.assertEqual(turn + 1, expected, cost)


class Pictures(unittest.TestCase):
    def test_ssim_of_even_pictures_is_its_first_factor(self):
        a, b = np.full((16, 16, 3), .5), np.full((16, 16, 3), .25)
        self.assertAlmostEqual(image_error.ssim(a, a), 1)
        self.assertAlmostEqual(image_error.ssim(a, b), (2 * .125 + 1e-4) / (.25 + .0625 + 1e-4), 6)

    def test_ssim_of_a_negative_is_below_zero(self):
        noise = np.random.default_rng(1).random((24, 24, 1)).repeat(3, axis=2)
        self.assertLess(image_error.ssim(noise, 1 - noise), -.9)

    def test_an_option_given_twice_counts_once(self):
        both = picture.joined(["--shadows", "random:2", "--lens", "4"], ["--shadows", "area:2,4"])
        self.assertEqual(both, ["--shadows", "area:2,4", "--lens", "4"])


class Twins(unittest.TestCase):
    needs = {name: name == "spheres" for name in features.NAMES.values()}
    bounds = {"min": [0, 0, 0], "max": [1, 1, 1]}

    def tail(self, wanted):
        return features.tail_of(wanted, self.needs, self.bounds)

    def test_geometry_does_not_depend_on_materials(self):
        shapes = lambda lines: [line for line in lines if not line.startswith("f ")]
        kinds = {"triangles", "cones", "smooth normals"}
        self.assertEqual(shapes(self.tail(kinds)), shapes(self.tail(features.EVERYTHING)))
        self.assertEqual(len(shapes(self.tail(set()))), 3)
        self.assertEqual(len(shapes(self.tail(kinds))), 6)

    def test_every_feature_left_out_is_not_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            shop = image_error.Workshop(PROGRAM, folder, 16)
            scene = shop.scene(("tetra", 2))
            for title, out in [("everything", set()), *features.LEFT_OUT]:
                told = shop.info(scene)
                twin = scene.with_name("twin.nff")
                wanted = features.EVERYTHING - out
                twin.write_text(scene.read_text()
                                + "\n".join(features.tail_of(wanted, told["needs"], told["bounds"]))
                                + "\n")
                needs = shop.info(twin)["needs"]
                asks = {f for f, name in features.NAMES.items() if needs[name]}
                asks |= set(features.OPTIONS)
                self.assertEqual(asks, wanted | {"triangles"} | set(features.OPTIONS), title)


class Kept(unittest.TestCase):
    """Charts of docs/ come from its CSVs."""
    modules = {"picture": picture, "grid": grid, "features": features}

    def test_what_is_read_back_is_what_was_written(self):
        for name, module in self.modules.items():
            rows = bench.read_csv(f"charts-{name}")
            header, written = module.csv(module.from_csv(rows))
            again = [dict(zip(header, map(str, row))) for row in written]
            for row in again + rows:
                row.pop("over_everything", None)  # a ratio of columns, which are rounded
            self.assertEqual(again, rows, name)

    def test_the_charts_shown_are_of_these_numbers(self):
        for name, module in self.modules.items():
            for drawn in module.charts(module.from_csv(bench.read_csv(f"charts-{name}"))):
                shown = (ROOT / f"docs/images/charts-{drawn['name']}.svg").read_text()
                points = [
                    p for panel in drawn["panels"] for s in panel["series"] for p in s["points"]
                ]
                self.assertEqual(shown.count("<title>"), len(points), drawn["name"])
                for panel in drawn["panels"]:
                    for words in (panel["title"], panel["x"]["label"], panel["y"]["label"]):
                        self.assertTrue(words and html.escape(words, quote=False) in shown,
                                        f"{drawn['name']}: {words}")


class Saved:
    """Takes the place of a benchmark's folder and keeps the figure."""
    def save(self, figure, name):
        self.figure = figure


def script(name):
    """A script of perf/ as a module; `trace` is one of Python's own."""
    spec = importlib.util.spec_from_file_location(f"perf_{name}", ROOT / f"perf/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def figure_of(name):
    """The chart of docs/images/ of that name, drawn from its CSV."""
    module, saved = script(name), Saved()
    if hasattr(module, "write_csv"):  # trace, build
        known = module.cells_from_csv() if name == "trace" else module.rows_from_csv()
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch(
                "matplotlib.pyplot.close") as close:
            module.draw(known, pathlib.Path(folder) / "chart.svg")
        return close.call_args[0][0]
    rows = {"frame": "frame-profile", "report": "report"}[name]
    module.draw(saved, module.from_csv(bench.read_csv(rows)))
    return saved.figure


def words_of(figure):
    """All that a figure says in letters."""
    found = (t.get_text() for t in figure.findobj(matplotlib.text.Text))
    return {line for text in found for line in text.split("\n") if re.search("[A-Za-z]{2}", line)}


class Benchmarks(unittest.TestCase):
    """The other charts of docs/."""
    names = ("trace", "build", "frame", "report")

    @classmethod
    def setUpClass(cls):
        cls.figures = {name: figure_of(name) for name in cls.names}

    @classmethod
    def tearDownClass(cls):
        bench.plt.close("all")

    def test_each_is_of_its_csv(self):
        for name, figure in self.figures.items():
            shown = html.unescape((ROOT / f"docs/images/{name}.svg").read_text())
            self.assertEqual({words
                              for words in words_of(figure)
                              if words not in shown}, set(), name)
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "chart.svg"
                figure.savefig(path)
                marks = re.compile("<use ")
                self.assertEqual(len(marks.findall(path.read_text())), len(marks.findall(shown)),
                                 name)

    def test_axes_say_what_they_count(self):
        for name, figure in self.figures.items():
            for axes in figure.axes:
                if not axes.axison:
                    continue  # the place of a legend
                ticks = " ".join(t.get_text() for t in axes.get_xticklabels())
                self.assertTrue(axes.get_xlabel() or re.search("[a-z]", ticks), name)
            self.assertTrue(any(axes.get_ylabel() for axes in figure.axes), name)
            self.assertFalse(
                {words
                 for words in words_of(figure)
                 if re.search(r"\btargets?\b", words)}, name)

    def test_no_two_series_share_a_marker(self):
        for name, figure in self.figures.items():
            for axes in figure.axes:
                looks = {}
                for line in axes.get_lines():
                    if not line.get_label().startswith("_") and line.get_marker() not in ("None",
                                                                                          "", None):
                        looks.setdefault((line.get_marker(), line.get_markerfacecolor() == "none"),
                                         []).append(line.get_label())
                self.assertFalse(
                    {look: labels
                     for look, labels in looks.items()
                     if len(labels) > 1}, name)


class Smoke(unittest.TestCase):
    """All charts of tiny pictures; then commands of their tables, as a reader types them."""

    @classmethod
    def setUpClass(cls):
        subprocess.run([sys.executable, ROOT / "perf/charts.py", "--program", PROGRAM, "--smoke"],
                       check=True, stdout=subprocess.DEVNULL)
        cls.folder = PROGRAM.parent / "charts-smoke"

    def rows(self, name):
        with open(self.folder / f"charts-{name}.csv") as f:
            return list(csv.DictReader(f))

    def type(self, command, folder):
        subprocess.run(command.replace("./run", str(PROGRAM)), shell=True, check=True, cwd=folder,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def picture(self, command):
        with tempfile.TemporaryDirectory() as folder:
            self.type(command, folder)
            return image_error.read_pfm(pathlib.Path(folder) / "p.pfm")

    def test_every_row_has_a_command_and_every_point_a_title(self):
        for name in ("picture", "grid", "features"):
            rows = self.rows(name)
            self.assertGreater(len(rows), 5)
            self.assertTrue(all("./run render" in row["command"] for row in rows), name)
            titles = re.findall(r"<title>[^<]*\./run",
                                (self.folder / f"images/charts-{name}.svg").read_text())
            self.assertGreaterEqual(len(titles), len(rows) // 2, name)

    def test_commands_repeat_the_pictures_errors(self):
        rows = self.rows("picture")
        reference = next(row for row in rows if row["method"].startswith("reference"))
        halves = [self.picture(command) for command in reference["command"].split("; ")]
        sobol = next(row for row in rows
                     if row["method"].startswith("sobol") and row["setting"] == "16")
        error = image_error.rmse(self.picture(sobol["command"]), (halves[0] + halves[1]) / 2)
        self.assertEqual(f"{error:.4g}", sobol["rmse"])

    def test_a_twins_command_makes_the_twin(self):
        row = next(row for row in self.rows("features") if row["features"] == features.ALL)
        scene = re.search(r"render (\S+)", row["command"])[1]
        with tempfile.TemporaryDirectory() as folder:
            self.type(row["command"], folder)
            made = (pathlib.Path(folder) / scene).read_text()
        self.assertEqual(made, (self.folder / f"{pathlib.Path(scene).stem}-twin-0.nff").read_text())


if __name__ == "__main__":
    unittest.main()
