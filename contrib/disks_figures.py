#!/usr/bin/python3
"""Draws figures 2 and 3 of Sulsky & Kaul (2004): the two disks and their energies.

    build/release/impm_dealii prm/disks.prm
    build/release/impm_dealii --study prm/studies/disks_newton_cg.prm
    contrib/disks_figures.py output/disks output/disks_newton_cg doc/figures/disks

writes doc/figures/disks_motion.png from the pictures of the first directory and
doc/figures/disks_energy.png from the histories of four runs of the study.
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt
from matplotlib.ticker import MultipleLocator

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
    figure, panels = plt.subplots(1, 4, figsize=(13, 3.6), sharey=True)
    for axes, time, letter in zip(panels, (25, 75, 100, 150), "abcd"):
        time, points = results.nearest_picture(directory, time)
        x = points.places
        axes.scatter(x[:, 0], x[:, 1], c=points["body"], s=3, cmap="coolwarm")
        axes.set_title(f"({letter}) t = {time:.4g} s")
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
        history = results.history(study / case)
        for column, (label, color, line) in ENERGIES.items():
            values = 1e6 * history[column]
            axes.plot(history["time"], values, line, color=color, label=label, linewidth=1.2)
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
    parser = results.Parser(__doc__)
    parser.add_argument("run", type=Path, help="output directory of prm/disks.prm")
    parser.add_argument("study", type=Path, help="that of prm/studies/disks_newton_cg.prm")
    parser.add_argument("out", help="what the names of the pictures begin with")
    arguments = parser.parse_args()
    draw_motion(arguments.run, arguments.out)
    draw_energy(arguments.study, arguments.out)
