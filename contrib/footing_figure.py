#!/usr/bin/python3
"""Draws the plastic strain under the footing, with the slip lines of Prandtl.

    build/release/impm_dealii prm/extreme/footing.prm
    contrib/footing_figure.py output/footing doc/figures/footing.png
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.colors import LogNorm
from matplotlib.patches import Rectangle

top = 5


def main(directory, picture):
    points = results.last_picture(directory)
    places = points.places[:, :2] - [0, top]
    strain = points["equivalent_plastic_strain"]
    size = points["volume"] ** 0.5

    figure, axes = plt.subplots(figsize=(9, 4.4), constrained_layout=True)
    drawn = PatchCollection(
        [Rectangle(place - s / 2, s, s) for place, s in zip(places, size)],
        cmap="viridis",
        norm=LogNorm(1e-5, 1e-2),
        linewidth=0,
    )
    drawn.set_array(np.maximum(strain, 1e-5))
    axes.add_collection(drawn)
    axes.add_patch(Rectangle((0, 0), 1, 0.1, color="black"))
    angle = np.linspace(-3 * np.pi / 4, -np.pi / 4)
    lines = [
        ([0, 1, 2], [-1, 0, -1]),
        (1 + 2**0.5 * np.cos(angle), 2**0.5 * np.sin(angle)),
        ([2, 3], [-1, 0]),
    ]
    for line in lines:
        axes.plot(*line, color="white", linewidth=1)
    axes.set(xlim=(0, 4), ylim=(-2, 0.1), aspect="equal", xlabel="x / B", ylabel="y / B")
    figure.colorbar(drawn, ax=axes, label="equivalent plastic strain")
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("run", type=Path, help="output directory")
    parser.add_argument("picture", type=results.picture_file, metavar="FILE.png")
    arguments = parser.parse_args()
    main(arguments.run, arguments.picture)
