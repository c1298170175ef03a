#!/usr/bin/python3
"""Draws figure 4 of Guilkey & Weiss (2003), fringes in four disks, and measures noise.

    build/release/impm_dealii --study prm/studies/hopkinson_disks.prm
    contrib/hopkinson_disks.py output/hopkinson_disks/{implicit,explicit} fringes.png

draws a strip for each directory at each of the times 1.9, 4.8 and 6.7 (transits of a
disk, 1 microsecond), and prints for each strip its time and, of s1 - s2, the largest
value and the noise: what is left at a point when the mean over its neighbours, up to
one cell away in x and y, is taken out, as root mean square over points over that of
s1 - s2 itself. "Inside" counts the points that have all 24 neighbours, where a field
that is linear leaves nothing, "everywhere" those at edges and contacts, too. Then
comes the largest difference of s1 - s2 from its mirror image in the axis, over the
largest value, and the root mean square of its difference from that of the first
directory, over that of s1 - s2.

    contrib/hopkinson_disks.py --difference UNIFORM OTHER... fringes.png

compares runs whose points need not be those of the first, on adaptive grids: for each
time and run the difference of s1 - s2 from the first run, L2, relative. "Points": at the
points of the first run, linear between those of the other; "cells": of the means over the
cells of the first run, which leaves out what oscillates within a cell; "fringes": of the
pattern itself, a cosine of s1 - s2, cell by cell. The picture has the fringes and the
grids in the upper halves of the disks, and the differences of s1 - s2 in the lower ones.

Without a FILE.png at the end it only measures.
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import LineCollection
from matplotlib.tri import LinearTriInterpolator, Triangulation

FRAMES = (1.9, 4.8, 6.7)
TRANSIT = 1e-6  # of a longitudinal wave through a disk (s)
PER_CELL = 2  # points in each direction of a cell
CELL = 2e-4  # extent of the cells of the uniform grid, which begin at the origin (m)
FRINGES = 7  # the scene's 'Fringe number'


class Frame:
    """The fields of the deformable points at a time, by rows and columns of points."""

    def __init__(self, directory, time):
        self.time, points = results.nearest_picture(directory, time)
        self.data = {}
        taken = points["body"] >= 0
        place = (points.places - points["displacement"])[taken, :2]
        spacing = numpy.diff(numpy.unique(place[:, 0].round(6))).min()
        column, row = ((place - place.min(axis=0)) / spacing).round().astype(int).T
        for name in ("principal_stress_difference", "photoelastic_fringe"):
            self.data[name] = numpy.full((row.max() + 1, column.max() + 1), numpy.nan)
            self.data[name][row, column] = points[name][taken]

    def noise(self):
        """Of s1 - s2, relative: inside, everywhere."""
        values = self.data["principal_stress_difference"]
        n = 2 * PER_CELL + 1
        padded = numpy.pad(values, PER_CELL, constant_values=numpy.nan)
        windows = numpy.lib.stride_tricks.sliding_window_view(padded, (n, n))
        neighbours = numpy.isfinite(windows).sum(axis=(2, 3)) - 1
        mean = (numpy.nansum(windows, axis=(2, 3)) - values) / neighbours
        result = []
        for taken in (neighbours == n * n - 1, neighbours >= 0):
            taken = taken & numpy.isfinite(values)
            rest = (values - mean)[taken]
            result.append((numpy.mean(rest**2) / numpy.mean(values[taken] ** 2)) ** 0.5)
        return result


class Field:
    """s1 - s2 at the deformable points of a run, wherever they are."""

    def __init__(self, directory, time):
        self.time, points = results.nearest_picture(directory, time)
        taken = points["body"] >= 0
        self.place = (points.places - points["displacement"])[taken, :2].astype(float)
        self.value = points["principal_stress_difference"][taken].astype(float)

    def at(self, places):
        """Linear between the points, of the nearest one beyond them."""
        # Triangulations do not like numbers as small as millimetres in metres, and get lost
        # where rows of points are straight but for the digits of pictures.
        net = Triangulation(*(self.place.T / CELL).round(3))
        values = LinearTriInterpolator(net, self.value)(*(places.T / CELL))
        values = numpy.ma.filled(values, numpy.nan)
        for i in numpy.flatnonzero(~numpy.isfinite(values)):
            distance = ((self.place - places[i]) ** 2).sum(axis=1)
            values[i] = self.value[distance.argmin()]
        return values

    def cells(self):
        """Of the uniform grid's cells that hold points: index, number, mean."""
        index = numpy.floor(self.place / CELL).astype(int)
        cells, inverse = numpy.unique(index, axis=0, return_inverse=True)
        number = numpy.bincount(inverse.ravel())
        return cells, number, numpy.bincount(inverse.ravel(), self.value) / number

    def at_cells(self, cells):
        values = self.at((cells + 0.5) * CELL)
        where = {tuple(cell): i for i, cell in enumerate(cells)}
        for cell, _, mean in zip(*self.cells()):
            if tuple(cell) in where:
                values[where[tuple(cell)]] = mean
        return values


def relative(difference, reference, weight=1.0):
    """Root mean square of a difference over that of a reference."""
    return (
        numpy.sum(weight * difference**2) / numpy.sum(weight * reference**2)
    ) ** 0.5


def edges_of(directory, time):
    """The edges of the cells of the grid."""
    cells = results.nearest_picture(directory, time, "grid")[1].cells()[:, :, :2]
    return list(cells[:, [0, 1, 2, 3, 0]])


def differences(picture, first, *others):
    panels = []
    print(
        f"{'run':20} {'time':>6} {'points':>8} {'largest (MPa)':>14}"
        f" {'points':>8} {'cells':>8} {'fringes':>8}"
    )
    for time in FRAMES:
        uniform = Field(first, time * TRANSIT)
        cells, number, mean = uniform.cells()
        largest = uniform.value.max()
        fringes = lambda values: numpy.cos(2 * numpy.pi * FRINGES * values / largest)
        panels.append((first, time, cells, fringes(mean), 0 * mean))
        for directory in others:
            field = Field(directory, time * TRANSIT)
            if abs(field.time / TRANSIT - time) > 0.05:
                continue
            other = field.at_cells(cells)
            print(
                f"{directory.name:20} {field.time / TRANSIT:6.3f} {len(field.value):8}"
                f" {field.value.max() / 1e6:14.1f}"
                f" {relative(field.at(uniform.place) - uniform.value, uniform.value):8.4f}"
                f" {relative(other - mean, mean, number):8.4f}"
                f" {relative(fringes(other) - fringes(mean), fringes(mean), number):8.4f}"
            )
            rms = numpy.mean(mean**2) ** 0.5
            panels.append((directory, time, cells, fringes(other), (other - mean) / rms))
    if not picture:
        return
    figure, axes = plt.subplots(
        len(panels), figsize=(12, 3.1 * len(panels)), constrained_layout=True
    )
    for axis, (directory, time, cells, pattern, difference) in zip(axes, panels):
        low = cells.min(axis=0)
        shape = (cells.max(axis=0) - low + 1)[::-1]
        extent = [
            CELL * k
            for k in (low[0], low[0] + shape[1], low[1], low[1] + shape[0])
        ]
        for half, values, style in (
            ("upper", pattern, {"cmap": "gray", "vmin": -1, "vmax": 1}),
            ("lower", difference, {"cmap": "RdBu", "vmin": -0.1, "vmax": 0.1}),
        ):
            image = numpy.full(shape, numpy.nan)
            taken = (cells[:, 1] >= 0) == (half == "upper")
            image[tuple((cells - low)[taken, ::-1].T)] = values[taken]
            drawn = axis.imshow(
                image, origin="lower", interpolation="nearest", extent=extent, **style
            )
        if directory != first:
            figure.colorbar(drawn, ax=axis, label="difference / rms", shrink=0.8)
            lines = [e for e in edges_of(directory, time * TRANSIT) if min(e[:, 1]) >= 0]
            axis.add_collection(LineCollection(lines, colors="C1", linewidths=0.25))
        axis.set(xlim=extent[:2], ylim=extent[2:], xticks=[], yticks=[])
        axis.set_facecolor("lightsteelblue")
        axis.set_title(f"{directory.name}, time {time}", fontsize=9)
    figure.savefig(picture, dpi=100)


def compare(picture, *directories):
    strips = [(d, Frame(d, t * TRANSIT), t) for t in FRAMES for d in directories]
    # a run that ends early has no picture near the later times
    strips = [(d, f) for d, f, t in strips if abs(f.time / TRANSIT - t) < 0.1]
    print(
        f"{'run':20} {'time':>6} {'largest (MPa)':>14} {'inside':>8} {'everywhere':>11}"
        f" {'asymmetry':>10} {'from first':>11}"
    )
    for directory, frame in strips:
        if directory == directories[0]:
            first = frame.data["principal_stress_difference"]
        inside, everywhere = frame.noise()
        values = frame.data["principal_stress_difference"]
        largest = numpy.nanmax(values)
        asymmetry = numpy.nanmax(abs(values - values[::-1])) / largest
        difference = numpy.nanmean((values - first) ** 2) / numpy.nanmean(first**2)
        print(
            f"{directory.name:20} {frame.time / TRANSIT:6.3f} {largest / 1e6:14.1f}"
            f" {inside:8.4f} {everywhere:11.4f} {asymmetry:10.1e} {difference**0.5:11.4f}"
        )
    if not picture:
        return
    figure, panels = plt.subplots(
        len(strips), figsize=(9, 2.35 * len(strips)), constrained_layout=True
    )
    for axes, (directory, frame) in zip(numpy.atleast_1d(panels), strips):
        axes.imshow(
            frame.data["photoelastic_fringe"],
            cmap="gray",
            vmin=-1,
            vmax=1,
            origin="lower",
            interpolation="nearest",
        )
        axes.set_facecolor("lightsteelblue")
        axes.set(xticks=[], yticks=[])
        axes.set_title(f"{directory.name}, time {frame.time / TRANSIT:.3g}", fontsize=9)
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("--difference", action="store_true", help="from the first run")
    parser.add_argument("runs", nargs="+", metavar="RUN", help="output directory")
    parser.add_argument("picture", nargs="?", metavar="FILE.png")
    arguments = parser.parse_args()
    names = arguments.runs
    picture = names.pop() if names[-1].endswith(".png") else None
    if not names:
        parser.error("no run is named")
    (differences if arguments.difference else compare)(picture, *map(Path, names))
