#!/usr/bin/python3
"""Draws rings that were pressed with different friction: plastic strain, and the surface.

    build/release/impm_dealii --study prm/contact/studies/ring_compression.prm
    contrib/ring_figure.py doc/figures/ring_compression.png output/ring_compression/none \\
        output/ring_compression/0.1 output/ring_compression/0.2
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt


def main(picture, directories):
    figure, all_axes = plt.subplots(
        len(directories), 1, figsize=(8, 1.5 * len(directories)), sharex=True,
        constrained_layout=True, squeeze=False)
    all_axes = all_axes[:, 0]
    for axes, directory in zip(all_axes, directories):
        points = results.last_picture(directory)
        places, strain = 1e3 * points.places, points["equivalent_plastic_strain"]
        drawn = axes.scatter(places[:, 0], places[:, 1], c=strain, s=4, vmin=0, vmax=1.4)
        places = 1e3 * results.last_picture(directory, "surfaces").places
        axes.scatter(places[:, 0], places[:, 1], c="red", s=2)
        axes.set(aspect="equal", xlim=(0, 5), ylim=(0, 0.55), ylabel="z (mm)")
        axes.set_title(f"friction: {directory.name}", fontsize="medium")
    all_axes[-1].set_xlabel("r (mm)")
    figure.colorbar(drawn, ax=all_axes, label="equivalent plastic strain")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("picture", type=results.picture_file, metavar="FILE.png")
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="output directory")
    arguments = parser.parse_args()
    main(arguments.picture, arguments.runs)
