#!/usr/bin/python3
"""How far a column of sand has run out, by the last picture of each run.

usage: contrib/sand_runout.py OUTPUT_DIRECTORY... (of prm/materials/sand_column.prm or its study)

Prints, over the width of the column at the start, where the straight part of the surface meets
the floor: a line through the highest points, in columns 25 mm wide, between 15 and 75 % of the
top. Beside it how far 98 % of the sand and its last point have come. Needs Debian's
python3-vtk9 and python3-matplotlib.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy
from plot_points import read
from vtk.util.numpy_support import vtk_to_numpy

WIDTH = 0.1  # of the column (m)
COLUMN = 0.025  # (m)


def surface(places):
    """Of columns with points: middle and highest point."""
    index = (places[:, 0] / COLUMN).astype(int)
    columns = numpy.unique(index)
    return (
        (columns + 0.5) * COLUMN,
        numpy.array([places[index == i, 1].max() for i in columns]),
    )


def main(*directories):
    print("run                   line  98 %  last")
    for directory in map(Path, directories):
        record = ElementTree.parse(directory / "particles.pvd").findall(".//DataSet")[-1]
        points = read(directory / record.get("file"))
        places = vtk_to_numpy(points.GetPoints().GetData())
        x, top = surface(places)
        straight = (top > 0.15 * top.max()) & (top < 0.75 * top.max())
        slope, height = numpy.polyfit(x[straight], top[straight], 1)
        ways = [-height / slope, numpy.quantile(places[:, 0], 0.98), places[:, 0].max()]
        print(
            f"{directory.name:20}",
            *(f"{(way - WIDTH) / WIDTH:5.2f}" for way in ways),
        )


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
