"""Draws how the runs of perf/error_suite.py kept their word, and what that took."""
import math
import statistics

from bench import plt

COLOURS = {"hostile": "#D55E00", "ordinary": "#0072B2"}


def group_of(run):
    return "ordinary" if run["kind"] == "ordinary" else "hostile"


def corrected(run):
    """The true error, without that of the reference, or a tenth of E where nothing is left."""
    return max(float(run["true"]), .1 * float(run["error"]))


def draw_boxes(axes, runs, columns):
    """Boxes of quartiles; whiskers to the outermost runs."""
    errors = sorted({float(r["error"]) for r in runs}, reverse=True)
    places, labels = [], []
    for c, (name, column) in enumerate(columns.items()):
        for e, error in enumerate(errors):
            for g, group in enumerate(COLOURS):
                ratios = [float(r[column]) / corrected(r) for r in runs
                          if float(r["error"]) == error and group_of(r) == group]
                place = c * (2 * len(errors) + 1.5) + 2 * e + .75 * g
                boxes = axes.boxplot([ratios], positions=[place], widths=.55, whis=(0, 100),
                                     patch_artist=True, manage_ticks=False,
                                     medianprops={"color": "black"})
                boxes["boxes"][0].set_facecolor(COLOURS[group])
            places.append(place - .375)
            labels.append(f"{name}\nE {error:g}" if e == 1 else f"\nE {error:g}")
    axes.set_xticks(places, labels)


def draw_times(axes, runs):
    """CPU seconds over those of the best fixed number of samples, by E; the mean is joined."""
    errors = sorted({float(r["error"]) for r in runs}, reverse=True)
    for g, (group, colour) in enumerate(COLOURS.items()):
        means = []
        for e, error in enumerate(errors):
            times = [float(r["time"]) for r in runs if float(r["error"]) == error and
                     group_of(r) == group and r["time"] and math.isfinite(float(r["time"]))]
            if not times:
                continue
            place = e - .1 + .2 * g
            axes.plot([place] * len(times), times, "o", color=colour, markersize=3, alpha=.4)
            means.append((place, math.exp(statistics.fmean(map(math.log, times)))))
        axes.plot(*zip(*means), "D-", color=colour, label=f"{group}, and their geometric mean")
    axes.set_xticks(range(len(errors)), [f"E {error:g}" for error in errors])


def draw_error_charts(runs, svg):
    figure, (left, right) = plt.subplots(2, 1, figsize=(7, 7.4), layout="constrained")
    draw_boxes(left, runs, {"about": "claimed", "at most": "bound"})
    left.set(title="What a run says, over the true error", yscale="log",
             ylabel="said / true: above 1 is kept")
    draw_times(right, runs)
    right.set(title="CPU time over that of the best fixed number of samples", yscale="log",
              ylabel="time / time of --samples N\nof equal true error")
    right.legend()
    left.set_yticks([.3, .5, .7, 1, 1.5, 2, 3, 5])
    right.set_yticks([.2, .5, 1, 2, 5, 10])
    for axes in (left, right):
        axes.axhline(1, color="#009E73", linewidth=1, linestyle=(0, (1, 3)))
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.yaxis.set_minor_formatter(lambda *_: "")
    figure.savefig(svg, metadata={"Date": None})
    plt.close(figure)
