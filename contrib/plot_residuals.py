#!/usr/bin/python3
"""Draws how Newton's method converged: residual over iteration of the steps that
took the most iterations in every one of the logs, which are runs of one scene with
--verbose; a diagram for each log (Sulsky & Kaul 2004, figure 5). The dotted line
falls quadratically.

    impm_dealii SCENE --verbose > h_1e-5.log
    contrib/plot_residuals.py diagram.png h_1e-5.log h_1e-4.log
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt


def read(path):
    """Residuals by the number of the step, last try of each."""
    steps, residuals = {}, []
    with open(path) as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "residuals:":
                residuals = [float(word) for word in words[1:] if is_number(word)]
            elif residuals and words[0].isdigit():
                steps[int(words[0])] = residuals
                residuals = []
    return steps


def is_number(word):
    try:
        float(word)
        return True
    except ValueError:
        return False


def main(picture, *paths):
    logs = {Path(path).stem: read(path) for path in paths}
    common = set.intersection(*(set(steps) for steps in logs.values()))
    if not common:
        raise results.Refusal("the logs have no step with residuals in common")
    shortest = {n: min(len(steps[n]) for steps in logs.values()) for n in common}
    chosen = sorted(sorted(common, key=lambda n: (-shortest[n], n))[:5])
    columns = min(3, len(logs))
    rows = -(-len(logs) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(3.5 * columns, 3 * rows), sharey=True, squeeze=False
    )
    for ax, (name, steps) in zip(axes.flat, logs.items()):
        for n in chosen:
            ax.semilogy(
                range(1, len(steps[n]) + 1), steps[n], "o-", label=f"step {n}"
            )
        ax.semilogy(range(1, 6), [10 ** -(0.5 * 2**k) for k in range(5)], "k:")
        ax.set_title(name, fontsize=9)
        ax.set_xlabel("iteration")
        ax.grid(True, linewidth=0.4)
    axes[0][0].set_ylim(1e-15, 10)
    axes[0][0].set_ylabel("residual")
    axes[0][0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(picture, dpi=80)


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("picture", type=results.picture_file, metavar="FILE.png")
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG")
    arguments = parser.parse_args()
    main(arguments.picture, *arguments.logs)
