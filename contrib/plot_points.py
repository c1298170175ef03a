#!/usr/bin/python3
"""Draws the points of the last picture of a run, coloured by a field.

usage: contrib/plot_points.py OUTPUT_DIRECTORY FIELD FILE.png

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


def read(path):
    reader = (
        vtk.vtkXMLPUnstructuredGridReader()
        if path.suffix == ".pvtu"
        else vtk.vtkXMLUnstructuredGridReader()
    )
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def main(directory, field, picture):
    directory = Path(directory)
    record = ElementTree.parse(directory / "particles.pvd").findall(".//DataSet")[-1]
    points = read(directory / record.get("file"))
    x = vtk_to_numpy(points.GetPoints().GetData())
    values = vtk_to_numpy(points.GetPointData().GetArray(field))
    if values.ndim > 1:
        values = (values**2).sum(axis=1) ** 0.5
    figure, axes = plt.subplots(figsize=(9, 6))
    drawn = axes.scatter(x[:, 0], x[:, 1], c=values, s=9, cmap="viridis")
    axes.set_aspect("equal")
    axes.set_xlabel("x or r (m)")
    axes.set_ylabel("y or z (m)")
    figure.colorbar(drawn, label=field)
    axes.set_title(f"t = {float(record.get('timestep')):.5g} s")
    figure.savefig(picture, dpi=120, bbox_inches="tight")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
