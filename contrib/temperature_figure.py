#!/usr/bin/python3
"""Draws what heat does in prm/materials: a strip of two metals, a slab, two billets.

    build/release/impm_dealii prm/materials/bimetal.prm
    build/release/impm_dealii prm/materials/conduction.prm
    build/release/impm_dealii prm/materials/hot_billet.prm
    build/release/impm_dealii prm/materials/hot_billet.prm --output output/adiabatic_billet \\
        --set Materials/steel/Conductivity=0 --set Heat/top/Temperature=
    contrib/temperature_figure.py output doc/figures/temperature.png
"""

from pathlib import Path

import results
import matplotlib.pyplot as plt
import numpy as np


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("output", type=Path, help="where the directories of the runs are")
    parser.add_argument("picture", type=results.picture_file, metavar="FILE.png")
    arguments = parser.parse_args()
    output, picture = arguments.output, arguments.picture
    figure, axes = plt.subplots(1, 4, figsize=(14, 3.6), constrained_layout=True)

    points = results.last_picture(output / "bimetal")
    x, stress = points.places, 1e-6 * points["von_mises_stress"]
    dots = axes[0].scatter(1e3 * x[:, 0], 1e3 * x[:, 1], s=40, marker="s",
                           c=stress, cmap="viridis", linewidth=0,
                           vmax=np.percentile(stress, 99))  # but for the pin
    figure.colorbar(dots, ax=axes[0], label="von Mises stress (MPa)")
    axes[0].set(title="brass and steel, 100 K hotter", xlabel="x (mm)",
                ylabel="y (mm)")

    a, length = 400 / (8960 * 383), 0.1
    series = results.pictures(output / "conduction")
    if len(series) < 4:
        raise results.Refusal(f"'{output}/conduction' has fewer than 4 pictures: let it run on")
    s = np.linspace(0, 1, 201)
    for time, name in (series[1], series[3], series[-1]):
        points = results.Data(name)
        terms = (2 / (n * np.pi) * np.sin(n * np.pi * s)
                 * np.exp(-(n * np.pi) ** 2 * a * time / length**2)
                 for n in range(1, 60))
        axes[1].plot(1e3 * length * s, 293.15 + 100 * (1 - s - sum(terms)), "k",
                     lw=0.8)
        axes[1].plot(1e3 * points.places[:, 0], points["temperature"], ".", ms=4,
                     label=f"{time:.2g} s")
    axes[1].set(title="slab and its series", xlabel="x (mm)",
                ylabel="temperature (K)")
    axes[1].legend()

    billets = [("adiabatic_billet", "adiabatic"), ("hot_billet", "cold platens")]
    values = []
    for directory, _ in billets:
        points = results.last_picture(output / directory)
        values.append((1e3 * points.places, points["temperature"]))
    highest = max(value.max() for _, value in values)
    for axis, (x, value), (_, title) in zip(axes[2:], values, billets):
        for sign in (-1, 1):
            dots = axis.scatter(sign * x[:, 0], x[:, 1], s=4, c=value,
                                cmap="inferno", vmin=300, vmax=highest)
        axis.set(title="billet, " + title, xlabel="r (mm)", ylabel="z (mm)")
        axis.set_aspect("equal")
    figure.colorbar(dots, ax=axes[2:], label="temperature (K)")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main()
