#!/usr/bin/python3
"""Draws figures 2 and 3 of Sulsky & Kaul (2004): the two disks and their energies.

    build/release/impm_dealii prm/disks.prm
    build/release/impm_dealii --study prm/studies/disks_newton_cg.prm
    contrib/disks_figures.py output/disks output/disks_newton_cg doc/figures/disks

writes doc/figures/disks_motion.png from the pictures of the first directory and
doc/figures/disks_energy.png from the histories of four runs of the study.
Needs Debian's python3-vtk9 and python3-matplotlib.
"""

import csv
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import MultipleLocator
from vtk.util.numpy_support import vtk_to_numpy

from plot_points import read

CASES = {
    "explicit": "explicit (momentum)",
    "0.02438": "implicit, the same step",
    "0.2438a": "10 times the step",
    "2.438a": "100 times the step",
}
ENERGIES = {
    "kinetic_energy": ("kinetic", "C0", "--"),
    "strain_energy": ("strain", "C1", "-."),
    "total_energy": ("total", "black", "-"),
}


def draw_motion(directory, out):
    records = ElementTree.parse(directory / "particles.pvd").findall(".//DataSet")
    figure, panels = plt.subplots(1, 4, figsize=(13, 3.6), sharey=True)
    for axes, time, letter in zip(panels, (25, 75, 100, 150), "abcd"):
        record = min(records, key=lambda r: abs(float(r.get("timestep")) - time))
        points = read(directory / record.get("file"))
        x = vtk_to_numpy(points.GetPoints().GetData())
        body = vtk_to_numpy(points.GetPointData().GetArray("body"))
        axes.scatter(x[:, 0], x[:, 1], c=body, s=3, cmap="coolwarm")
        axes.set_title(f"({letter}) t = {float(record.get('timestep')):.4g} s")
        axes.set_aspect("equal")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MultipleLocator(0.5))
            axis.set_minor_locator(MultipleLocator(0.05))
        axes.set(xlim=(0, 1), ylim=(0, 1))
        axes.grid(which="both", linewidth=0.4, alpha=0.5)
    figure.tight_layout()
    figure.savefig(f"{out}_motion.png", dpi=110)


def draw_energy(study, out):
    figure, panels = plt.subplots(2, 2, figsize=(10, 7), sharex=True, sharey=True)
    for axes, (case, title), letter in zip(panels.flat, CASES.items(), "abcd"):
        with open(study / case / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        time = [float(row["time"]) for row in rows]
        for column, (label, color, line) in ENERGIES.items():
            values = [1e6 * float(row[column]) for row in rows]
            axes.plot(time, values, line, color=color, label=label, linewidth=1.2)
        axes.set_title(f"({letter}) {title}")
        axes.grid(alpha=0.3)
    for axes in panels[1]:
        axes.set_xlabel("time (s)")
    for axes in panels[:, 0]:
        axes.set_ylabel(r"energy ($\mu$J/m)")
    panels[0][0].legend(loc="center left")
    figure.tight_layout()
    figure.savefig(f"{out}_energy.png", dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    draw_motion(Path(sys.argv[1]), sys.argv[3])
    draw_energy(Path(sys.argv[2]), sys.argv[3])
