#!/usr/bin/python3
"""Draws what accuracy costs: error over run time and over size, log-log.

For each reference of a study a pair of diagrams with one line for each
combination of the lists that are not the order's, as PNG and SVG.

    contrib/plot_study.py output/column
    contrib/plot_study.py output/column --errors stress --out doc/column
"""

from collections import defaultdict
from pathlib import Path

import results
import matplotlib
import matplotlib.pyplot as plt
from matplotlib.ticker import (
    AutoLocator,
    FixedLocator,
    FuncFormatter,
    LogLocator,
    NullFormatter,
)

MARKERS = "osD^vP*X<>"


def lines_of(about, rows):
    """Rows by the labels of the lists that do not go along a line."""
    other = [
        entry["name"]
        for entry in about["lists"]
        if entry["name"] != about["order_along"]
        and not (about["paired"] and entry["has_sizes"])
    ]
    lines = defaultdict(list)
    for row in rows:
        name = ", ".join(
            f"{n} {row[n]}" if is_number(row[n]) else row[n] for n in other
        )
        lines[name].append(row)
    return lines


def is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


def points(rows, x, y):
    """Numbers above 0, along x: a log-log diagram has no place for others."""
    pairs = [
        (float(row[x]), float(row[y]))
        for row in rows
        if row["status"] == "done" and is_number(row[x]) and is_number(row[y])
    ]
    return [pair for pair in pairs if min(pair) > 0]


def tidy(axes):
    """Ticks that can be told apart however many decades are seen."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        if high / low < 5:
            axis.set_major_locator(AutoLocator())
        elif high / low < 100:
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_minor_formatter(NullFormatter())
        if high / low < 100:
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))
    axes.grid(alpha=0.3)


def mark_sizes(axes, sizes):
    """Ticks at the sizes themselves, if they stand far enough apart."""
    ticks = sorted(sizes)
    gaps = [high / low for low, high in zip(ticks, ticks[1:])]
    if gaps and min(gaps) > max((ticks[-1] / ticks[0]) ** (1 / 12), 1.05):
        axes.xaxis.set_major_locator(FixedLocator(ticks))
        axes.xaxis.set_minor_locator(FixedLocator([]))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.4g}"))


def draw_slopes(axes, all_points):
    """Lines of order 1 and 2 from below the best of the coarsest runs."""
    sizes = [x for x, _ in all_points]
    if len(set(sizes)) < 2:
        return
    right, left = max(sizes), min(sizes)
    foot = 0.6 * min(y for x, y in all_points if x == right)
    # They shall not stretch the diagram.
    lowest = min(0.6 * min(y for _, y in all_points), 0.2 * foot)
    for order, style in ((1, ":"), (2, "--")):
        end = max(left, right * (lowest / foot) ** (1 / order))
        axes.plot(
            [end, right],
            [foot * (end / right) ** order, foot],
            style,
            color="gray",
            linewidth=1,
            label=f"order {order}",
        )


def diagram(about, lines, error, title=None):
    """The pair of diagrams of a reference."""
    along = about["order_along"]
    has_sizes = bool(along)
    figure, both = plt.subplots(
        1, 1 + has_sizes, figsize=(6 + 5 * has_sizes, 4.8), squeeze=False, sharey=True
    )
    over_time = both[0][0]
    over_size = both[0][1] if has_sizes else None
    column = "error_" + error
    size_points = []
    for i, (name, rows) in enumerate(lines.items()):
        failed = sum(row["status"] != "done" for row in rows)
        label = name or error
        if failed:
            label += f" ({failed} of {len(rows)} failed)"
        style = {
            "marker": MARKERS[i % len(MARKERS)],
            "color": f"C{i % 10}",
            "linestyle": ("-", "-.")[i // 10 % 2],
            "markersize": 5,
        }
        # Along the sizes, since run times need not be in order.
        ordered = rows
        if has_sizes:
            ordered = sorted(rows, key=lambda row: -float(row[along + "_size"]))
        data = points(ordered, "wall_seconds", column)
        over_time.plot(*zip(*data) if data else ([], []), label=label, **style)
        if has_sizes:
            data = points(ordered, along + "_size", column)
            size_points += data
            over_size.plot(*zip(*data) if data else ([], []), **style)
    over_time.set_xlabel("run time (s)")
    over_time.set_ylabel(f"error of {error}")
    panels = [over_time]
    if has_sizes:
        draw_slopes(over_size, size_points)
        over_size.set_xlabel(
            next(e["size_name"] for e in about["lists"] if e["name"] == along)
        )
        panels.append(over_size)
    for axes in panels:
        axes.set_xscale("log")
        axes.set_yscale("log")
        tidy(axes)
    if has_sizes:
        mark_sizes(over_size, {x for x, _ in size_points})
    if title:
        figure.suptitle(title)
    handles, labels = [], []
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            handles.append(handle)
            labels.append(label)
    figure.tight_layout()
    # Beside the diagrams, where it hides none of them.
    figure.legend(
        handles, labels, loc="center left", bbox_to_anchor=(1, 0.5), frameon=False
    )
    return figure


def save(figure, out):
    for ending in ("png", "svg"):
        name = f"{out}.{ending}"
        # Without the date, the same study gives the same file.
        metadata = {"Date": None} if ending == "svg" else None
        figure.savefig(name, dpi=130, bbox_inches="tight", metadata=metadata)
        print(name)
    plt.close(figure)


def main():
    matplotlib.rcParams["svg.hashsalt"] = "impm_dealii"
    parser = results.Parser(__doc__)
    parser.add_argument("study", type=Path, help="output directory of a study")
    parser.add_argument("--errors", help="names of references, between commas")
    parser.add_argument("--out", help="what the names of the pictures begin with")
    arguments = parser.parse_args()
    study = results.Study(arguments.study)
    wanted = arguments.errors.split(",") if arguments.errors else study.errors
    for name in wanted:
        if name not in study.errors:
            parser.error(f"found error '{name}', allowed are: {', '.join(study.errors)}")
    if not wanted:
        parser.error("the scene of this study has no Reference, hence no error")
    lines = lines_of(study.about, study.rows)
    out = arguments.out or arguments.study / "error"
    for name in wanted:
        figure = diagram(study.about, lines, name, study.title)
        save(figure, f"{out}_{name.replace(' ', '_')}")


if __name__ == "__main__":
    main()
