#!/usr/bin/python3
"""Draws rings that were pressed with different friction: plastic strain, and the surface.

    build/release/impm_dealii --study prm/contact/studies/ring_compression.prm
    contrib/ring_figure.py doc/figures/ring_compression.png output/ring_compression/none \\
        output/ring_compression/0.1 output/ring_compression/0.2

Needs Debian's python3-vtk9 and python3-matplotlib.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def last_picture(directory, kind):
    record = ElementTree.parse(directory / f"{kind}.pvd").findall(".//DataSet")[-1]
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(directory / record.get("file")))
    reader.Update()
    points = reader.GetOutput()
    return 1e3 * vtk_to_numpy(points.GetPoints().GetData()), points.GetPointData()


def main(picture, directories):
    figure, all_axes = plt.subplots(
        len(directories), 1, figsize=(8, 1.5 * len(directories)), sharex=True,
        constrained_layout=True)
    for axes, directory in zip(all_axes, directories):
        places, data = last_picture(directory, "particles")
        strain = vtk_to_numpy(data.GetArray("equivalent_plastic_strain"))
        drawn = axes.scatter(places[:, 0], places[:, 1], c=strain, s=4, vmin=0, vmax=1.4)
        places, data = last_picture(directory, "surfaces")
        axes.scatter(places[:, 0], places[:, 1], c="red", s=2)
        axes.set(aspect="equal", xlim=(0, 5), ylim=(0, 0.55), ylabel="z (mm)")
        axes.set_title(f"friction: {directory.name}", fontsize="medium")
    all_axes[-1].set_xlabel("r (mm)")
    figure.colorbar(drawn, ax=all_axes, label="equivalent plastic strain")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1], [Path(directory) for directory in sys.argv[2:]])
