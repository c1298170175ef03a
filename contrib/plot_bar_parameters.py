#!/usr/bin/python3
"""Draws what prm/studies/bar_plastic_parameters.prm found: evaluations of the
stress at a point over epsilon, a curve for each gamma, a row of diagrams for each
time step and a column for each h (Sulsky & Kaul 2004, figures 6 to 8).

    contrib/plot_bar_parameters.py output/bar_plastic_parameters diagram.png
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt


def main(study, picture):
    rows = results.Study(study).rows

    def labels(name):
        return list(dict.fromkeys(row[name] for row in rows))

    steps, quotients = labels("step"), labels("h")
    figure, axes = plt.subplots(
        len(steps), len(quotients), figsize=(10, 8), sharex=True, sharey="row"
    )
    for i, step in enumerate(steps):
        for j, quotient in enumerate(quotients):
            ax = axes[i][j]
            for gamma, marker in zip(labels("gamma"), "osD^v"):
                line = [
                    (
                        float(row["epsilon"]),
                        float(row["stress_evaluations"]) / float(row["points"]),
                    )
                    for row in rows
                    if (row["step"], row["h"], row["gamma"]) == (step, quotient, gamma)
                    and row["exit_code"] == "0"
                ]
                ax.loglog(*zip(*line), marker + "-", label=f"gamma {gamma}")
            ax.set_title(f"step {step}, h {quotient}", fontsize=9)
            ax.grid(True, which="major", linewidth=0.4)
            if i == len(steps) - 1:
                ax.set_xlabel("epsilon")
            if j == 0:
                ax.set_ylabel("evaluations a point")
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=80)


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("study", type=Path, help="output directory of the study")
    parser.add_argument("picture", type=results.picture_file, metavar="FILE.png")
    arguments = parser.parse_args()
    main(arguments.study, arguments.picture)
