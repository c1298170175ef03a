#!/usr/bin/python3
"""How far a column of sand has run out, by the last picture of each run.

    contrib/sand_runout.py output/sand_column     # of prm/materials/sand_column.prm

Prints, over the width of the sand at the start (--width, or that of the first picture), where the
straight part of the surface meets the floor: a line through the highest points, in columns of a
quarter of that width, between 15 and 75 % of the top. Beside it how far 98 % of the sand and its last point have come.
"""

from pathlib import Path

import results
import numpy

def surface(places, column):
    """Of columns of that width with points: middle and highest point."""
    index = (places[:, 0] / column).astype(int)
    columns = numpy.unique(index)
    return (
        (columns + 0.5) * column,
        numpy.array([places[index == i, 1].max() for i in columns]),
    )


def width_at_start(directory):
    """Of points that lie evenly, from x = 0 on."""
    x = numpy.unique(results.Data(results.pictures(directory)[0][1]).places[:, 0].round(9))
    return x[-1] + x[0]


def main(directories, given):
    print("run                   line  98 %  last")
    for directory in directories:
        places = results.last_picture(directory).places
        width = given or width_at_start(directory)
        x, top = surface(places, width / 4)
        straight = (top > 0.15 * top.max()) & (top < 0.75 * top.max())
        if straight.sum() < 2:
            raise results.Refusal(f"the sand of '{directory}' has no slope yet")
        slope, height = numpy.polyfit(x[straight], top[straight], 1)
        ways = [-height / slope, numpy.quantile(places[:, 0], 0.98), places[:, 0].max()]
        print(
            f"{directory.name:20}",
            *(f"{(way - width) / width:5.2f}" for way in ways),
        )


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="output directory")
    parser.add_argument("--width", type=float, help="of the sand at the start")
    arguments = parser.parse_args()
    main(arguments.runs, arguments.width)
