#!/usr/bin/python3
"""Draws what heat does in prm/materials: a strip of two metals, a slab, two billets.

    build/release/impm_dealii prm/materials/bimetal.prm
    build/release/impm_dealii prm/materials/conduction.prm
    build/release/impm_dealii prm/materials/hot_billet.prm
    build/release/impm_dealii prm/materials/hot_billet.prm --output output/adiabatic_billet \\
        --set Materials/steel/Conductivity=0 --set Heat/top/Temperature=
    contrib/temperature_figure.py output doc/figures/temperature.png

Needs Debian's python3-vtk9 and python3-matplotlib.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def pictures(directory):
    """Times and files of the points."""
    path = Path(directory) / "particles.pvd"
    return [(float(entry.get("timestep")), path.parent / entry.get("file"))
            for entry in ElementTree.parse(path).iter("DataSet")]


def read(name):
    """Places of the points, and a function that gives a field of them."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(name))
    reader.Update()
    grid = reader.GetOutput()
    x = vtk_to_numpy(grid.GetPoints().GetData())
    return x, lambda field: vtk_to_numpy(grid.GetPointData().GetArray(field))


def main():
    output, picture = sys.argv[1:]
    figure, axes = plt.subplots(1, 4, figsize=(14, 3.6), constrained_layout=True)

    x, field = read(pictures(f"{output}/bimetal")[-1][1])
    stress = 1e-6 * field("von_mises_stress")
    dots = axes[0].scatter(1e3 * x[:, 0], 1e3 * x[:, 1], s=40, marker="s",
                           c=stress, cmap="viridis", linewidth=0,
                           vmax=np.percentile(stress, 99))  # but for the pin
    figure.colorbar(dots, ax=axes[0], label="von Mises stress (MPa)")
    axes[0].set(title="brass and steel, 100 K hotter", xlabel="x (mm)",
                ylabel="y (mm)")

    a, length = 400 / (8960 * 383), 0.1
    series = pictures(f"{output}/conduction")
    s = np.linspace(0, 1, 201)
    for time, name in (series[1], series[3], series[-1]):
        x, field = read(name)
        terms = (2 / (n * np.pi) * np.sin(n * np.pi * s)
                 * np.exp(-(n * np.pi) ** 2 * a * time / length**2)
                 for n in range(1, 60))
        axes[1].plot(1e3 * length * s, 293.15 + 100 * (1 - s - sum(terms)), "k",
                     lw=0.8)
        axes[1].plot(1e3 * x[:, 0], field("temperature"), ".", ms=4,
                     label=f"{time:.2g} s")
    axes[1].set(title="slab and its series", xlabel="x (mm)",
                ylabel="temperature (K)")
    axes[1].legend()

    billets = [("adiabatic_billet", "adiabatic"), ("hot_billet", "cold platens")]
    values = []
    for directory, _ in billets:
        x, field = read(pictures(f"{output}/{directory}")[-1][1])
        values.append((1e3 * x, field("temperature")))
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
