#!/usr/bin/python3
"""How far a column of sand has run out, by the last picture of each run.

    contrib/sand_runout.py output/sand_column     # of prm/materials/sand_column.prm

Prints, over the width of the column at the start, where the straight part of the surface meets
the floor: a line through the highest points, in columns 25 mm wide, between 15 and 75 % of the
top. Beside it how far 98 % of the sand and its last point have come.
"""

from pathlib import Path

import results
import numpy

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


def main(directories):
    print("run                   line  98 %  last")
    for directory in directories:
        places = results.last_picture(directory).places
        x, top = surface(places)
        straight = (top > 0.15 * top.max()) & (top < 0.75 * top.max())
        if straight.sum() < 2:
            raise results.Refusal(f"the sand of '{directory}' has no slope yet")
        slope, height = numpy.polyfit(x[straight], top[straight], 1)
        ways = [-height / slope, numpy.quantile(places[:, 0], 0.98), places[:, 0].max()]
        print(
            f"{directory.name:20}",
            *(f"{(way - WIDTH) / WIDTH:5.2f}" for way in ways),
        )


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="output directory")
    main(parser.parse_args().runs)
