#!/usr/bin/python3
"""Draws the points of the last picture of each run, coloured by a field; of vectors and
tensors it is the size.

    contrib/plot_points.py output/upsetting equivalent_plastic_strain strain.png

With the field deformation_gradient in the pictures they are drawn as boxes that it
carries along: those of initial_domain or, without that field, squares and cubes of their
volume at the start; else as discs of their size.
"""

import itertools
from pathlib import Path

import results
import matplotlib.pyplot as plt
import numpy
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.colors import Normalize

CORNERS = {
    2: numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2,
    3: numpy.array(list(itertools.product((-1, 1), repeat=3))) / 2,
}
# Of a cube, counter-clockwise from outside.
FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
MOST_BOXES = 300_000
MAP = "viridis"


def is_rigid(points):
    """Of the points: those of rigid bodies carry nothing but their place."""
    return points["body"] < 0 if "body" in points else numpy.zeros(len(points.places), bool)


def values_of(points, field):
    """What points are coloured by, not a number where they have none."""
    return numpy.where(is_rigid(points), numpy.nan, points.size_of(field))


def initial_edges(points, F, dim, is_axisymmetric):
    """Of the boxes (points x 3), nothing if they are not known."""
    if "initial_domain" in points:
        return points["initial_domain"]
    if "volume" not in points:
        return None
    size = points["volume"] / numpy.linalg.det(F)
    if is_axisymmetric:  # of a ring, whose length was 2 pi times its radius
        size = size * F[:, 2, 2] / (2 * numpy.pi * points.places[:, 0])
    return numpy.repeat(numpy.abs(size)[:, None] ** (1 / dim), 3, axis=1)


def boxes(points, dim, is_axisymmetric):
    """Corners (points x 2^dim x dim) of the boxes, nothing if they are not known."""
    if "deformation_gradient" not in points:
        return None
    rigid = is_rigid(points)
    F = numpy.where(rigid[:, None, None], numpy.eye(3), points["deformation_gradient"])
    edges = initial_edges(points, F, dim, is_axisymmetric)
    if edges is None:
        return None
    if not rigid.all():
        edges = numpy.where(rigid[:, None], numpy.median(edges[~rigid], axis=0), edges)
    shapes = (CORNERS[dim] * edges[:, None, :dim]) @ F[:, :dim, :dim].transpose(0, 2, 1)
    return points.places[:, None, :dim] + shapes


def diameters(points, dim, is_axisymmetric):
    """Of discs and balls that are as large as the points."""
    if "volume" not in points:
        spans = numpy.ptp(points.places[:, :dim], axis=0)
        return numpy.full(len(points.places), (spans.prod() / len(points.places)) ** (1 / dim))
    volume = points["volume"]
    if is_axisymmetric:
        volume = volume / (2 * numpy.pi * points.places[:, 0])
    if (volume > 0).any():
        volume = numpy.where(volume > 0, volume, numpy.median(volume[volume > 0]))
    return 2 * (volume / numpy.pi) ** 0.5 if dim == 2 else (6 * volume / numpy.pi) ** (1 / 3)


def project(places):
    """Onto the plane of the picture, and the distance towards the eye."""
    eye = numpy.array([-0.45, -0.7, 0.55])
    right = numpy.cross([0, 0, 1], eye)
    up = numpy.cross(eye, right)
    axes = numpy.array([a / numpy.linalg.norm(a) for a in (right, up, eye)])
    places = places @ axes.T
    return places[..., :2], places[..., 2]


def visible_faces(corners):
    """Of boxes in space, from far to near: polygons, brightness, number of the box."""
    faces = corners[:, FACES]
    flat, depth = project(faces)
    normal = numpy.cross(faces[:, :, 2] - faces[:, :, 0], faces[:, :, 3] - faces[:, :, 1])
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=-1, keepdims=True), 1e-300)
    towards = project(normal)[1]
    box, face = numpy.nonzero(towards > 0)
    order = numpy.argsort(depth.mean(axis=-1)[box, face])
    box, face = box[order], face[order]
    brightness = 0.72 + 0.28 * normal[box, face, 2]
    return flat[box, face], brightness, box


def draw(axes, points, values, norm, dim=2, is_axisymmetric=False, grid=None):
    """Of points as results.Data; behind them the cells of a grid in the plane."""
    colours = plt.get_cmap(MAP)(norm(values))
    colours[is_rigid(points)] = (0.5, 0.5, 0.5, 1)
    corners = boxes(points, dim, is_axisymmetric) if len(values) <= MOST_BOXES else None
    if grid is not None and dim == 2:
        cells = PolyCollection(
            grid.cells()[:, :, :2], facecolor="none", edgecolor="gray", linewidth=0.3,
            alpha=0.6, rasterized=True,
        )
        axes.add_collection(cells, autolim=False)
    if corners is None:
        places, order = points.places[:, :2], slice(None)
        if dim == 3:
            places, depth = project(points.places)
            order = numpy.argsort(depth)
        size = diameters(points, dim, is_axisymmetric)[order]
        drawn = EllipseCollection(
            size, size, 0, units="xy", offsets=places[order], transOffset=axes.transData,
            facecolor=colours[order], rasterized=True, linewidth=0.3 * (dim == 3),
            edgecolor=(0, 0, 0, 0.3),
        )
        margin = size.max() / 2
        axes.update_datalim([places.min(axis=0) - margin, places.max(axis=0) + margin])
        axes.add_collection(drawn, autolim=False)
    else:
        polygons = corners
        if dim == 3:
            polygons, brightness, box = visible_faces(corners)
            colours = colours[box]
            colours[:, :3] *= brightness[:, None]
        # edges of their own colour close the seams
        drawn = PolyCollection(
            polygons, facecolor=colours, edgecolor=colours, linewidth=0.2, rasterized=True
        )
        axes.add_collection(drawn)
    axes.autoscale_view()
    axes.set_aspect("equal")
    if dim == 3:
        axes.set_axis_off()


def colour_bar(figure, axes, norm, label, **options):
    figure.colorbar(ScalarMappable(norm, MAP), ax=axes, label=label, panchor=False, **options)


def limits(all_values):
    """A common scale; what is not finite does not count."""
    values = numpy.concatenate(list(all_values))
    values = values[numpy.isfinite(values)]
    return Normalize(values.min(), values.max()) if len(values) else Normalize(0, 0)


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("runs", nargs="+", type=Path, help="output directories")
    parser.add_argument("field", help="of the points")
    parser.add_argument("picture", type=results.picture_file, help="FILE.png, .svg or .pdf")
    arguments = parser.parse_args()
    runs = []
    for directory in arguments.runs:
        run = results.Run(directory)
        time, path = results.pictures(directory)[-1]
        points = results.Data(path)
        runs.append((run, time, points, values_of(points, arguments.field)))
    norm = limits(values for _, _, _, values in runs)
    figure, panels = plt.subplots(
        len(runs), figsize=(9, 3.4 * len(runs)), squeeze=False, constrained_layout=True
    )
    for axes, (run, time, points, values) in zip(panels[:, 0], runs):
        draw(axes, points, values, norm, run.dim, run.is_axisymmetric)
        axes.set_xlabel(run.label("position", "r" if run.is_axisymmetric else "x"))
        axes.set_ylabel(run.label("position", "z" if run.is_axisymmetric else "y"))
        axes.set_title(f"{run.name}, t = {time:.5g} {run.unit('time')}")
    colour_bar(figure, panels, norm, runs[0][0].label(arguments.field))
    figure.savefig(arguments.picture, dpi=90)


if __name__ == "__main__":
    main()
