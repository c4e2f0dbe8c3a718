"""A chart as plain data, drawn as SVG by Matplotlib.

A chart is a dict: name, title, panels. A panel: title, x and y (dicts of label, and perhaps
log, span, ticks, names: words for 0, 1, 2, ...), series, and perhaps front (points of the Pareto
front), lines (dicts of x or y and label). A series: name, look (index into LOOKS), joined, points;
no two series of a chart have the same look. A point: x, y, label, command, and perhaps star (it is
marked).
"""
import dataclasses
import math
import re

from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from bench import plt


@dataclasses.dataclass(frozen=True)
class Look:
    """Colour, marker and dash say the same, for the colour-blind. No two share a marker."""
    colour: str
    marker: str  # Matplotlib's letter
    dash: str
    hollow: bool = False

    @property
    def fill(self):
        return "white" if self.hollow else self.colour


LOOKS = [
    Look("#999999", "o", ":"),
    Look("#E69F00", "s", "--"),
    Look("#D55E00", "v", "--"),
    Look("#CC79A7", "^", "-."),
    Look("#882255", "<", ":"),
    Look("#0072B2", "D", "-"),
    Look("#000000", "*", "-"),
    Look("#009E73", "P", "--"),
    Look("#56B4E9", "X", "--"),
    Look("#8C6D31", "o", "-.", hollow=True),
    Look("#666666", "s", "-", hollow=True),
    Look("#332288", "D", "--", hollow=True),
    Look("#AA4499", ">", "-.")
]
# For series whose points may be stars of their own
STARLESS = [i for i, look in enumerate(LOOKS) if look.marker != "*"]
FRONT = "#FFD92F"
STAR = "the kernel's choice"


def pareto_front(points):
    """Of points those that no other beats in both x and y, by ascending x; smaller is better."""
    front = []
    for p in sorted(points, key=lambda p: (p["x"], p["y"])):
        if not front or p["y"] < front[-1]["y"]:
            front.append(p)
    return front


def slope(points):
    """Of the straight line through log y over log x, least squares."""
    xs, ys = [math.log(p["x"]) for p in points], [math.log(p["y"]) for p in points]
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    spread = sum((x - mx) ** 2 for x in xs)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / spread if spread else math.nan


def plain(value, _=None):
    """0.01 and 200k rather than powers of ten."""
    for unit, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= 10 * unit or (unit > 1e3 and value >= unit):
            return f"{value / unit:g}{letter}"
    return f"{value:g}" if value >= 1e-3 else f"{value:.9f}".rstrip("0")


def set_axis(axis, low, high, how):
    """Returns a few legible ticks: powers of ten, with their halves and fifths if the axis spans
    little."""
    if "names" in how:
        axis.set_ticks(range(len(how["names"])), how["names"])
        return
    if not how.get("log"):
        return
    if "ticks" in how:
        axis.set_ticks(how["ticks"])
    else:
        decades = math.log10(high / low) if low > 0 else 1
        axis.set_major_locator(LogLocator(subs=(1,) if decades > 2 else (1, 2, 5), numticks=12))
    axis.set_major_formatter(plain)
    axis.set_minor_formatter(NullFormatter())


def draw_panel(axes, panel, ids, hints):
    axes.set(title=panel["title"], xlabel=panel["x"]["label"], ylabel=panel["y"].get("label", ""))
    for which in "xy":
        if panel[which].get("log"):
            getattr(axes, f"set_{which}scale")("log")
    if panel.get("front"):
        xs, ys = ([p[which] for p in panel["front"]] for which in "xy")
        axes.plot(xs, ys, color=FRONT, linewidth=7, alpha=.6, drawstyle="steps-post", zorder=1)
    for line in panel.get("lines", []):
        draw_line = axes.axhline if "y" in line else axes.axvline
        draw_line(line.get("y", line.get("x")), color="#009E73", linewidth=1,
                  linestyle=(0, (1, 3)))
    for series in panel["series"]:
        look, points = LOOKS[series["look"]], series["points"]
        if series["joined"]:
            joined = [p for p in points if not p.get("star")]
            axes.plot([p["x"] for p in joined], [p["y"] for p in joined],
                      look.dash,
                      color=look.colour,
                      linewidth=1.3,
                      zorder=2)
        for p in points:  # each on its own, so that each can tell its command
            name = f"point{next(ids)}"
            hints[name] = f"{series['name']} {p['label']}\n{p['command']}"
            star = {
                "marker": "*", "markersize": 13, "markeredgecolor": "black", "markeredgewidth": .7,
                "zorder": 4
            }
            mark = {
                "marker": look.marker, "markersize": 8 if look.marker == "*" else 5.5,
                "markeredgecolor": look.colour, "markeredgewidth": 1.2 if look.hollow else .7,
                "zorder": 3
            }
            axes.plot([p["x"]], [p["y"]],
                      color=look.colour,
                      markerfacecolor=look.fill,
                      gid=name,
                      **(star if p.get("star") else mark))
    for which, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        values = [p[which] for s in panel["series"] for p in s["points"]]
        set_axis(axis, min(values), max(values), panel[which])
    if "span" in panel["x"]:
        axes.set_xlim(*panel["x"]["span"])
    if "names" in panel["y"]:
        axes.set_ylim(len(panel["y"]["names"]) - .5, -.5)
    elif "span" in panel["y"]:
        axes.set_ylim(*panel["y"]["span"])
    axes.grid(which="major", alpha=.35)


def legend_of(chart):
    """One for all panels: every series' look, then what the other marks mean."""
    handles = {}
    for series in (s for panel in chart["panels"] for s in panel["series"]):
        look = LOOKS[series["look"]]
        handles.setdefault(
            series["name"],
            Line2D([], [],
                   color=look.colour,
                   marker=look.marker,
                   markerfacecolor=look.fill,
                   markersize=6,
                   linestyle=look.dash if series["joined"] else ""))
    if any(p.get("star")
           for panel in chart["panels"] for s in panel["series"] for p in s["points"]):
        handles[STAR] = Line2D([], [], color="#999999", marker="*", linestyle="", markersize=12,
                               markeredgecolor="black")
    if any(panel.get("front") for panel in chart["panels"]):
        handles["Pareto front: nothing else is both faster and better"] = Line2D(
            [], [], color=FRONT, linewidth=7, alpha=.6)
    for line in (line for panel in chart["panels"] for line in panel.get("lines", [])):
        handles.setdefault(line["label"],
                           Line2D([], [], color="#009E73", linewidth=1, linestyle=(0, (1, 3))))
    return handles


def add_hints(path, hints):
    """A browser shows a title when the mouse rests on its point."""
    def titled(match):
        text = hints[match[1]].replace("&", "&amp;").replace("<", "&lt;")
        return f"{match[0]}<title>{text}</title>"
    text = re.sub(r'<g id="(point\d+)">', titled, path.read_text())
    # Matplotlib names clip paths by the hash of places that a layout may give another last bit
    names = {
        name: f"clip{i}"
        for i, name in enumerate(dict.fromkeys(re.findall(r"p[0-9a-f]{10}(?=\)|\")", text)))
    }
    path.write_text(re.sub(r"(?<=[#\"])p[0-9a-f]{10}(?=\)|\")", lambda m: names[m[0]], text))


def legend_height(handles, columns):
    return .15 + .22 * -(-len(handles) // columns)  # inches


def legend_below(figure, handles, columns):
    """One legend for all panels of a constrained layout, in room of its own at the foot."""
    room = legend_height(handles, columns) / figure.get_size_inches()[1]
    figure.get_layout_engine().set(rect=(0, room, 1, 1 - room))
    figure.legend(handles, [h.get_label() for h in handles],
                  loc="lower center",
                  ncols=columns,
                  fontsize=9,
                  frameon=False)


def draw(chart, svg, png):
    panels, columns = chart["panels"], min(chart.get("columns", 2), len(chart["panels"]))
    rows = -(-len(panels) // columns)
    handles = legend_of(chart)
    width, height = chart.get("panel_size", (5.2, 3.7))
    across = max(1, int(width * columns / 3.4))  # columns of the legend
    figure = plt.figure(figsize=(width * columns,
                                 height * rows + legend_height(handles, across) + .35),
                        layout="constrained")
    ids, hints = iter(range(10 ** 6)), {}
    for i, panel in enumerate(panels):
        axes = figure.add_subplot(rows, columns, i + 1)
        draw_panel(axes, panel, ids, hints)
        if "names" in panel["y"] and i % columns:
            axes.set_yticklabels([])  # as in the first column
            axes.set_ylabel("")
    figure.suptitle(chart["title"], fontsize=12)
    for label, handle in handles.items():
        handle.set_label(label)
    legend_below(figure, list(handles.values()), across)
    figure.savefig(svg, metadata={"Date": None})
    figure.savefig(png, dpi=80)  # to look at
    plt.close(figure)
    add_hints(svg, hints)
