#!/usr/bin/python3
"""Draws the points of the last picture of each run, coloured by a field.

usage: contrib/plot_points.py OUTPUT_DIRECTORY... FIELD FILE.png

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


def main(*arguments):
    *directories, field, picture = arguments
    runs = []
    for directory in map(Path, directories):
        record = ElementTree.parse(directory / "particles.pvd").findall(".//DataSet")[-1]
        points = read(directory / record.get("file"))
        values = vtk_to_numpy(points.GetPointData().GetArray(field))
        if values.ndim > 1:
            values = (values**2).sum(axis=1) ** 0.5
        places = vtk_to_numpy(points.GetPoints().GetData())
        runs.append((directory.name, places, values, float(record.get("timestep"))))
    limits = min(run[2].min() for run in runs), max(run[2].max() for run in runs)
    figure, panels = plt.subplots(
        len(runs), figsize=(9, 3.4 * len(runs)), squeeze=False, constrained_layout=True
    )
    for axes, (name, places, values, time) in zip(panels[:, 0], runs):
        # The more points, the smaller.
        drawn = axes.scatter(
            places[:, 0],
            places[:, 1],
            c=values,
            s=max(1, 5400 / len(values)),
            cmap="viridis",
            vmin=limits[0],
            vmax=limits[1],
        )
        axes.set_aspect("equal")
        axes.set_xlabel("x or r (m)")
        axes.set_ylabel("y or z (m)")
        axes.set_title(f"{name}, t = {time:.5g} s")
    figure.colorbar(drawn, ax=panels, label=field)
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
