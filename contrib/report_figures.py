"""The figures of contrib/report: SVG that takes the colours of the page around it."""

import base64
import io

import results
import matplotlib
import matplotlib.pyplot as plt
import numpy
import plot_points
import plot_study

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

    def __init__(self, title, x_label, lines, log=False):
        self.title, self.x_label, self.lines, self.log = title, x_label, lines, log


def curves(panels):
    """A figure of panels, two in a row."""
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(10, 2.9 * rows), squeeze=False
    )
    for axis in axes.flat[len(panels) :]:
        axis.set_visible(False)
    for axis, panel in zip(axes.flat, panels):
        positive = [y[y > 0] for _, y, _, _ in panel.lines]
        all_positive = numpy.concatenate(positive)
        # over less than a decade a logarithm is no help
        log = panel.log and len(all_positive) > 0 and numpy.ptp(numpy.log10(all_positive)) > 1
        for x, y, label, options in panel.lines:
            if log:
                y = numpy.where(y > 0, y, numpy.nan)
            marker = {"marker": "o", "markersize": 2.5} if len(x) < 12 else {}
            axis.plot(x, y, label=label, **{**marker, **options})
        if log:
            axis.set_yscale("log")
        else:
            axis.ticklabel_format(axis="y", scilimits=(-3, 5), useMathText=True)
        axis.set(title=panel.title, xlabel=panel.x_label)
        if 1 <= sum(bool(label) for _, _, label, _ in panel.lines) <= MOST_LABELS:
            axis.legend()
    return data_uri(figure)


def bars(names, seconds_by_phase):
    """Run times of runs, by phase: a bar for each run. Small phases are put together."""
    phases = sorted(seconds_by_phase, key=lambda phase: -seconds_by_phase[phase].sum())
    shown = {phase: seconds_by_phase[phase] for phase in phases[: len(COLOURS) - 1]}
    rest = sum(seconds_by_phase[phase] for phase in phases[len(COLOURS) - 1 :])
    figure, axis = plt.subplots(figsize=(10, 1.4 + 0.35 * len(names)))
    left = numpy.zeros(len(names))
    for (phase, seconds), shade in zip([*shown.items(), ("the rest", rest)], COLOURS):
        axis.barh(names, seconds, left=left, label=phase, height=0.6, color=shade)
        left += seconds
    axis.invert_yaxis()
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("run time (s)")
    axis.legend(ncols=4, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0)
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
    axis.set(xscale="log", yscale="log", xlabel="run time (s)", ylabel="error")
    plot_study.tidy(axis)
    axis.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return data_uri(figure)


def choose(records):
    """The first, the middle and the last picture, by their times."""
    half = (records[0][0] + records[-1][0]) / 2
    middle = min(records, key=lambda record: abs(record[0] - half))
    return sorted({time: path for time, path in (records[0], middle, records[-1])}.items())


def points(runs, field, only_last=False):
    """A row of pictures for each run: first, middle and last."""
    shown = []
    for run in runs:
        records = results.pictures(run.directory)
        has_grid = results.list_of_pictures(run.directory, "grid").exists()
        grids = dict(results.pictures(run.directory, "grid")) if has_grid else {}
        for time, path in records[-1:] if only_last else choose(records):
            shown.append((run, time, results.Data(path), grids.get(time)))
    values = [plot_points.values_of(data, field) if field else numpy.zeros(len(data.places))
              for _, _, data, _ in shown]
    norm = plot_points.limits(values)
    is_plane = all(run.dim == 2 for run in runs)
    spans = numpy.array([numpy.ptp(data.places[:, :2], axis=0) for _, _, data, _ in shown])
    wide, tall = spans.max(axis=0) if is_plane else (1, 0.9)
    # on one scale, unless one of them would be a dot
    shared = is_plane and bool(spans.max() < 5 * spans.max(axis=1).min())
    # slender bodies stand in one row, flat ones below each other
    columns = 1 if wide > 4 * tall else 3 if not only_last or tall > wide else 2
    columns = min(columns, len(shown))
    rows = -(-len(shown) // columns)
    height = min(max(9.4 / columns * tall / max(wide, 1e-300), 0.6), 7) + 0.6
    figure, axes = plt.subplots(
        rows, columns, figsize=(10, rows * height + 0.7), squeeze=False, sharex=shared,
        sharey=shared,
    )
    for axis in axes.flat[len(shown) :]:
        axis.set_visible(False)
    for axis, (run, time, data, grid), of_points in zip(axes.flat, shown, values):
        cells = results.Data(grid) if grid and run.dim == 2 else None
        plot_points.draw(axis, data, of_points, norm, run.dim, run.is_axisymmetric, cells)
        axis.grid(False)
        if run.dim == 2:
            axis.locator_params(nbins=4 if columns > 1 else 8)
            axis.ticklabel_format(scilimits=(-4, 5), useMathText=True)
        name = f"{run.name}, " if len(runs) > 1 else ""
        axis.set_title(f"{name}t = {time:.4g} {run.unit('time')}", fontsize=9)
    if norm.vmin < norm.vmax:
        plot_points.colour_bar(
            figure, axes, norm, runs[0].label(field), location="bottom", aspect=60, fraction=0.05
        )
    return data_uri(figure, bbox_inches="tight")
