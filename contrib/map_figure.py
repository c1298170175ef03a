#!/usr/bin/python3
"""Draws what a map does to a grid: the box, the ring that it becomes, and what a run finds.

    build/release/impm_dealii prm/annulus.prm
    contrib/map_figure.py doc/figures/map.png output/annulus

Needs Debian's python3-vtk9 and python3-matplotlib.
"""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import results
import matplotlib.pyplot as plt
import numpy as np
import vtk
from matplotlib.collections import LineCollection
from vtk.util.numpy_support import vtk_to_numpy

INNER, OUTER, YOUNG, POISSON, PRESSURE = 0.1, 0.2, 1e9, 0.3, 1e5  # of the scene
COLOURS = {"left": "tab:red", "right": "tab:blue", "bottom": "tab:green", "top": "tab:orange"}


def picture(directory, kind, which):
    record = ElementTree.parse(directory / f"{kind}.pvd").findall(".//DataSet")[which]
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(directory / record.get("file")))
    reader.Update()
    return reader.GetOutput()


def cells_of(grid):
    """Corners of each cell, in order around it."""
    places = vtk_to_numpy(grid.GetPoints().GetData())[:, :2]
    for c in range(grid.GetNumberOfCells()):
        ids = grid.GetCell(c).GetPointIds()
        yield places[[ids.GetId(i) for i in range(4)]]


def box_of(corners):
    """The same before the map."""
    radius = np.hypot(corners[:, 0], corners[:, 1])
    angle = np.arctan2(corners[:, 1], corners[:, 0])
    return np.column_stack([(radius - INNER) / (OUTER - INNER), angle / (np.pi / 2)])


def draw_grid(axes, cells, box_cells):
    on_face = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1)}
    lines, colours = [], []
    for corners, box in zip(cells, box_cells):
        for i in range(4):
            ends = [i, (i + 1) % 4]
            colour = "lightgrey"
            for face, (axis, value) in on_face.items():
                if np.all(np.abs(box[ends, axis] - value) < 1e-6):
                    colour = COLOURS[face]
            lines.append(corners[ends])
            colours.append(colour)
    order = np.argsort([c != "lightgrey" for c in colours], kind="stable")
    axes.add_collection(LineCollection(
        [lines[i] for i in order], colors=[colours[i] for i in order],
        linewidths=[1 if colours[i] == "lightgrey" else 3 for i in order]))
    axes.autoscale()
    axes.set_aspect("equal")


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("picture", type=results.picture_file, help="FILE.png, .svg or .pdf")
    parser.add_argument("run", type=Path, help="output directory")
    arguments = parser.parse_args()
    directory = arguments.run
    start = picture(directory, "grid", 0)
    cells = list(cells_of(start))
    boxes = [box_of(corners) for corners in cells]
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 4), constrained_layout=True)

    draw_grid(left, boxes, boxes)
    left.set(title="the box: x, y of 'Map'", xlabel="x", ylabel="y")
    for face, place, turn in (("left", (-0.07, 0.5), 90), ("right", (1.07, 0.5), 90),
                              ("bottom", (0.5, -0.06), 0), ("top", (0.5, 1.06), 0)):
        left.text(*place, face, color=COLOURS[face], ha="center", va="center", rotation=turn)
    left.margins(0.15)

    draw_grid(middle, cells, boxes)
    middle.set(title="where it is: x, y of all other entries", xlabel="x (m)", ylabel="y (m)")
    middle.text(0.055, 0.055, "left", color=COLOURS["left"], ha="center")
    middle.text(0.155, 0.155, "right", color=COLOURS["right"], ha="center")
    middle.text(0.15, -0.012, "bottom", color=COLOURS["bottom"], ha="center", va="center")
    middle.text(-0.012, 0.15, "top", color=COLOURS["top"], ha="center", va="center", rotation=90)
    middle.margins(0.12)

    points = picture(directory, "particles", -1)
    moved = vtk_to_numpy(points.GetPointData().GetArray("displacement"))[:, :2]
    places = vtk_to_numpy(points.GetPoints().GetData())[:, :2] - moved
    radius = np.hypot(places[:, 0], places[:, 1])
    right.plot(radius, 1e6 * np.sum(moved * places, axis=1) / radius, "k.", ms=4,
               label="points of the run")
    r = np.linspace(INNER, OUTER, 100)
    exact = ((1 + POISSON) * PRESSURE / YOUNG * INNER**2 / (OUTER**2 - INNER**2)
             * ((1 - 2 * POISSON) * r + OUTER**2 / r))
    right.plot(r, 1e6 * exact, color="tab:red", lw=1, label="Lamé")
    right.set(title="what the run finds", xlabel="radius (m)",
              ylabel="radial displacement (µm)")
    right.legend()
    figure.savefig(arguments.picture, dpi=110)


if __name__ == "__main__":
    main()
