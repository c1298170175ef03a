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

Without a FILE.png at the end it only measures. Needs Debian's python3-vtk9 and
python3-matplotlib.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from vtk.util.numpy_support import vtk_to_numpy

from plot_points import read

FRAMES = (1.9, 4.8, 6.7)
TRANSIT = 1e-6  # of a longitudinal wave through a disk (s)
PER_CELL = 2  # points in each direction of a cell


class Frame:
    """The fields of the deformable points at a time, by rows and columns of points."""

    def __init__(self, directory, time):
        records = ElementTree.parse(directory / "particles.pvd").findall(".//DataSet")
        record = min(records, key=lambda r: abs(float(r.get("timestep")) - time))
        points = read(directory / record.get("file"))
        self.time = float(record.get("timestep"))
        self.data = {}
        field = lambda name: vtk_to_numpy(points.GetPointData().GetArray(name))
        taken = field("body") >= 0
        place = vtk_to_numpy(points.GetPoints().GetData())[taken, :2]
        place = place - field("displacement")[taken, :2]
        spacing = numpy.diff(numpy.unique(place[:, 0].round(6))).min()
        column, row = ((place - place.min(axis=0)) / spacing).round().astype(int).T
        for name in ("principal_stress_difference", "photoelastic_fringe"):
            self.data[name] = numpy.full((row.max() + 1, column.max() + 1), numpy.nan)
            self.data[name][row, column] = field(name)[taken]

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


def main(*arguments):
    picture = arguments[-1] if arguments[-1].endswith(".png") else None
    directories = [Path(name) for name in arguments[: len(arguments) - bool(picture)]]
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
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
