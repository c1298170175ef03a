#!/usr/bin/python3
"""Draws a column of the history of several runs over another column.

usage: contrib/plot_history.py X Y FILE.png OUTPUT_DIRECTORY...

Needs Debian's python3-matplotlib.
"""

import csv
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def label_of(column, directories):
    """With its unit, if the runs agree on one."""
    units = set()
    for directory in directories:
        try:
            summary = json.loads((Path(directory) / "summary.json").read_text())
        except FileNotFoundError:
            summary = {}
        units.add(summary.get("column_units", {}).get(column, ""))
    unit = units.pop() if len(units) == 1 else ""
    return f"{column} ({unit})" if unit else column


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
    axes.set_xlabel(label_of(x, directories))
    axes.set_ylabel(label_of(y, directories))
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(picture, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
