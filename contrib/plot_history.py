#!/usr/bin/python3
"""Draws a column of the history of several runs over another column.

    contrib/plot_history.py platen_displacement platen_load load.png output/upsetting
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("x", help="column of history.csv")
    parser.add_argument("y", help="column of history.csv")
    parser.add_argument("picture", type=results.picture_file, help="FILE.png, .svg or .pdf")
    parser.add_argument("runs", nargs="+", type=Path, help="output directories")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(figsize=(8, 5))
    for directory in arguments.runs:
        history = results.history(directory)
        axes.plot(history[arguments.x], history[arguments.y], label=directory.name)
    axes.set_xlabel(arguments.x)
    axes.set_ylabel(arguments.y)
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(arguments.picture, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main()
