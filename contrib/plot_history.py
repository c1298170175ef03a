#!/usr/bin/python3
"""Draws a column of the history of several runs over another column.

usage: contrib/plot_history.py X Y FILE.png OUTPUT_DIRECTORY...

Needs Debian's python3-matplotlib.
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(x, y, picture, *directories):
    figure, axes = plt.subplots(figsize=(8, 5))
    for directory in directories:
        with open(Path(directory) / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        axes.plot(
            [float(row[x]) for row in rows],
            [float(row[y]) for row in rows],
            label=Path(directory).name,
        )
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(picture, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
