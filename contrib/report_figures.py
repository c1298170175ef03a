"""The figures of contrib/report: SVG that takes the colours of the page around it."""

import base64
import io

import results
import matplotlib
import matplotlib.pyplot as plt
import numpy
import plot_points

INK = "#123456"  # stands for the colour of the page's text
THEME = """<style>svg{color:#26323d}
@media screen and (prefers-color-scheme:dark){svg{color:#cfd8e1}}</style>"""
COLOURS = ["#2a7fca", "#e0762b", "#2f9e62", "#c2497d", "#8b6bd1", "#a68a1c", "#1aa3a8", "#7d8790"]
MOST_LABELS = 10

matplotlib.rcParams.update(
    {
        "axes.edgecolor": INK,
        "axes.grid": True,
        "axes.labelcolor": INK,
        "axes.labelsize": 9,
        "axes.linewidth": 0.6,
        "axes.prop_cycle": matplotlib.cycler(color=COLOURS),
        "axes.spines.right": False,
        "axes.spines.top": False,
        "axes.titlelocation": "left",
        "axes.titlesize": 10,
        "figure.constrained_layout.use": True,
        "grid.alpha": 0.15,
        "grid.color": INK,
        "legend.frameon": False,
        "legend.fontsize": 8,
        "lines.linewidth": 1.4,
        "savefig.transparent": True,
        "svg.fonttype": "none",
        "svg.hashsalt": "impm_dealii",
        "text.color": INK,
        "xtick.color": INK,
        "xtick.labelsize": 8,
        "ytick.color": INK,
        "ytick.labelsize": 8,
    }
)


def data_uri(figure, **options):
    """The figure, closed, as the address of an image that is its own content."""
    file = io.StringIO()
    figure.savefig(file, format="svg", dpi=160, metadata={"Date": None}, **options)
    plt.close(figure)
    text = file.getvalue().replace(INK, "currentColor")
    head, opening, rest = text.partition("<svg")
    tag, end, rest = rest.partition(">")
    text = head + opening + tag + end + THEME + rest
    return "data:image/svg+xml;base64," + base64.b64encode(text.encode()).decode()


def colour(index, count):
    """Of a run among others: apart if they are few, else along a map."""
    if count <= len(COLOURS):
        return COLOURS[index]
    return matplotlib.cm.get_cmap("turbo")(0.08 + 0.84 * index / (count - 1))


class Panel:
    """A diagram of lines (x, y, label, options)."""

    def __init__(self, title, x_label, y_label, lines, log=False):
        self.title, self.x_label, self.y_label = title, x_label, y_label
        self.lines, self.log = lines, log


def curves(panels):
    """A figure of panels, two in a row."""
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(10 if columns == 2 else 7, 3 * rows), squeeze=False
    )
    for axis in axes.flat[len(panels) :]:
        axis.set_visible(False)
    for axis, panel in zip(axes.flat, panels):
        for x, y, label, options in panel.lines:
            # what is not positive has no logarithm
            y = numpy.where(y > 0, y, numpy.nan) if panel.log else y
            marker = {"marker": "o", "markersize": 2.5} if len(x) < 12 else {}
            axis.plot(x, y, label=label, **{**marker, **options})
        if panel.log and any(numpy.nanmax(y, initial=0) > 0 for _, y, _, _ in panel.lines):
            axis.set_yscale("log")
        axis.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label)
        if sum(bool(label) for _, _, label, _ in panel.lines) in range(1, MOST_LABELS + 1):
            axis.legend()
    return data_uri(figure)


def bars(names, seconds_by_phase):
    """Run times of runs, by phase: a bar for each run."""
    figure, axis = plt.subplots(figsize=(10, 1.3 + 0.35 * len(names)))
    left = numpy.zeros(len(names))
    for i, (phase, seconds) in enumerate(seconds_by_phase.items()):
        axis.barh(names, seconds, left=left, label=phase, height=0.6, color=colour(i, len(seconds_by_phase)))
        left += seconds
    axis.invert_yaxis()
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("run time (s)")
    axis.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1))
    return data_uri(figure)


def errors_over_time(records):
    """Of runs (name, reference, seconds, error): a marker for each error."""
    figure, axis = plt.subplots(figsize=(7, 3.6))
    runs = list(dict.fromkeys(name for name, _, _, _ in records))
    references = list(dict.fromkeys(reference for _, reference, _, _ in records))
    for name, reference, seconds, error in records:
        i, j = runs.index(name), references.index(reference)
        axis.plot(
            seconds, error, "osD^vP*X"[j % 8], color=colour(i, len(runs)), markersize=7,
            label=f"{name}: {reference}",
        )
    axis.set(xscale="log", yscale="log", xlabel="run time (s)", ylabel="relative error")
    axis.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return data_uri(figure)


def choose(times):
    """First, middle and last of the pictures."""
    return sorted({0, (len(times) - 1) // 2 + (len(times) % 2 == 0), len(times) - 1})


def points(runs, field, only_last=False):
    """A row of pictures for each run: first, middle and last."""
    shown = []
    for run in runs:
        records = results.pictures(run.directory)
        grids = dict(results.pictures(run.directory, "grid")) if run.has("grid.pvd") else {}
        for i in [len(records) - 1] if only_last else choose(records):
            time, path = records[i]
            shown.append((run, time, results.Data(path), grids.get(time)))
    values = [data.size_of(field) for _, _, data, _ in shown]
    norm = plot_points.limits(values)
    columns = 1 if len(shown) == 1 else min(3, len(shown)) if not only_last else min(2, len(shown))
    rows = -(-len(shown) // columns)
    width = 10 / columns
    spans = [numpy.ptp(data.places[:, :2], axis=0) for _, _, data, _ in shown]
    tall = max(span[1] / span[0] for span in spans if span[0] > 0) if runs[0].dim == 2 else 0.9
    height = min(max(width * tall, 0.22 * width), 1.6 * width) + 0.7
    figure, axes = plt.subplots(
        rows, columns, figsize=(10, rows * height), squeeze=False, sharex=True, sharey=True
    )
    for axis in axes.flat[len(shown) :]:
        axis.set_visible(False)
    for axis, (run, time, data, grid), of_points in zip(axes.flat, shown, values):
        grid = grid and run.dim == 2 and results.Data(grid)
        plot_points.draw(axis, data, of_points, norm, run.dim, run.is_axisymmetric, grid or None)
        axis.grid(False)
        name = f"{run.name}, " if len(runs) > 1 else ""
        axis.set_title(f"{name}t = {time:.4g} {run.unit('time')}", fontsize=9)
    plot_points.colour_bar(figure, axes, norm, runs[0].label(field))
    return data_uri(figure)
