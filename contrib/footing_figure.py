#!/usr/bin/python3
"""Draws the plastic strain under the footing, with the slip lines of Prandtl.

    build/release/impm_dealii prm/extreme/footing.prm
    contrib/footing_figure.py output/footing doc/figures/footing.png

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
from matplotlib.collections import PatchCollection
from matplotlib.colors import LogNorm
from matplotlib.patches import Rectangle
from vtk.util.numpy_support import vtk_to_numpy

top = 5


def main(directory, picture):
    record = ElementTree.parse(directory / "particles.pvd").findall(".//DataSet")[-1]
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(directory / record.get("file")))
    reader.Update()
    points = reader.GetOutput()
    places = vtk_to_numpy(points.GetPoints().GetData())[:, :2] - [0, top]
    strain = vtk_to_numpy(points.GetPointData().GetArray("equivalent_plastic_strain"))
    size = vtk_to_numpy(points.GetPointData().GetArray("volume")) ** 0.5

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
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), sys.argv[2])
