"""Shows the points of a run in ParaView as the boxes that they were, carried along by
their deformation gradients and coloured by a field; a body about an axis is mirrored.

    paraview --script=contrib/paraview_upsetting.py     # output/upsetting
    pvpython contrib/paraview_upsetting.py output/upsetting --picture strain.png

or, in ParaView, Macros > Import new macro: it then shows the run whose particles.pvd is
selected. Without a screen: xvfb-run -s -noreset pvpython ... Needs Debian's paraview and
python3-paraview. Where pictures lack the field initial_domain, boxes are taken for squares
and cubes at the start, which those of points that have split were not.
"""

import argparse
import re
import sys
from pathlib import Path

try:
    from paraview import simple
except ModuleNotFoundError:
    simple = None

# The initial side of a box that is taken for a square or cube. About an axis a point is a
# ring, whose length was 2 pi times its radius.
F = "deformation_gradient"
SIDE = {
    "axisymmetric": f"(volume / det({F}) * {F}[:, 2, 2] / (2 * 3.14159265 * inputs[0].Points[:, 0])) ** (1 / 2)",
    "plane": f"(volume / det({F})) ** (1 / 2)",
    "3D": f"(volume / det({F})) ** (1 / 3)",
}


def geometry(directory):
    """Of the run: 'axisymmetric', 'plane' or '3D'."""
    text = (directory / "parameters.prm").read_text()
    kind = re.search(r"subsection Geometry.*?set Kind *= *(\w+)", text, re.DOTALL)[1]
    return kind if kind in SIDE else "plane"


def mirrored(source, name, kind):
    """In the axis, which is x = 0."""
    if kind != "axisymmetric":
        return source
    return simple.Reflect(
        registrationName=f"{name}, mirrored", Input=source, Plane="X", Center=0, CopyInput=1
    )


def without_rigid(points, view, kind):
    """Shows the points of rigid bodies, which have but their place; the others."""
    part = {"Input": points, "Scalars": ["POINTS", "body"], "LowerThreshold": -0.5}
    rigid = simple.Threshold(
        registrationName="rigid points", ThresholdMethod="Below Lower Threshold", **part
    )
    shown = simple.Show(mirrored(rigid, "rigid points", kind), view)
    shown.SetRepresentationType("Points")
    shown.ColorArrayName = ["POINTS", ""]
    shown.PointSize = 4
    shown.AmbientColor = shown.DiffuseColor = [0.5, 0.5, 0.5]
    return simple.Threshold(
        registrationName="deformable points", ThresholdMethod="Above Upper Threshold",
        **part, UpperThreshold=-0.5,
    )


def show(directory, field):
    """Makes the pipeline: boxes, cells of the grid, time, colour bar; the view."""
    kind = geometry(directory)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = int(kind == "3D")

    points = simple.PVDReader(registrationName="points", FileName=str(directory / "particles.pvd"))
    points.UpdatePipeline()
    if field not in points.PointData.keys():
        raise SystemExit(f"the points have no field '{field}', but {', '.join(points.PointData.keys())}")
    if "body" in points.PointData.keys() and points.PointData["body"].GetRange()[0] < 0:
        points = without_rigid(points, view, kind)
    is_known = "initial_domain" in points.PointData.keys()
    sides = "initial_domain[:, None, :]" if is_known else f"({SIDE[kind]})[:, None, None]"
    axes = simple.PythonCalculator(
        registrationName="axes of the boxes", Input=points, ArrayName="axes",
        Expression=f"{F}.transpose(0, 2, 1) * {sides}",  # it reads tensors by columns
    )
    boxes = simple.TensorGlyph(registrationName="boxes", Input=axes, GlyphType="Box")
    boxes.Tensors = ["POINTS", "axes"]
    boxes.ScaleFactor = 1
    boxes.ExtractEigenvalues = boxes.LimitScalingByEigenvalues = 0
    boxes.ColorGlyphs = 1
    boxes.Scalars = ["POINTS", field]
    boxes = mirrored(boxes, "boxes", kind)
    shown = simple.Show(boxes, view)
    simple.ColorBy(shown, ("POINTS", field))
    colours = simple.GetColorTransferFunction(field)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    if kind != "3D":
        shown.Ambient, shown.Diffuse = 1, 0  # colours as they are in the bar
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = field.replace("_", " "), ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    if kind != "3D":
        bar.Orientation, bar.WindowLocation = "Horizontal", "Lower Center"
    bar.ScalarBarLength, bar.AutomaticLabelFormat = 0.5, 0
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    shown.SetScalarBarVisibility(view, True)

    grid = simple.PVDReader(registrationName="grid", FileName=str(directory / "grid.pvd"))
    cells = simple.Show(mirrored(grid, "grid", kind), view)
    cells.SetRepresentationType("Outline" if kind == "3D" else "Wireframe")
    cells.ColorArrayName = ["POINTS", ""]
    cells.AmbientColor = cells.DiffuseColor = [0.6, 0.6, 0.6]
    cells.Opacity = 0.4

    label = simple.AnnotateTimeFilter(registrationName="time", Input=points, Format="t = {time:.5g}")
    simple.Show(label, view).Color = [0, 0, 0]
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    simple.GetAnimationScene().GoToLast()
    shown.RescaleTransferFunctionToDataRange(False, True)
    if kind == "3D":
        view.CameraPosition, view.CameraViewUp = [-0.45, -0.7, 0.55], [0, 0, 1]
        view.CameraFocalPoint = [0, 0, 0]
    else:
        view.InteractionMode = "2D"
        view.CameraParallelProjection = 1
    simple.ResetCamera(view)
    if kind != "3D":
        fit(view, boxes.GetDataInformation().GetBounds())
    simple.Render(view)
    return view


def fit(view, bounds):
    """Makes the view as wide or as high as what is in it."""
    left, right, low, high = bounds[:4]
    middle = [(left + right) / 2, (low + high) / 2]
    view.CameraFocalPoint, view.CameraPosition = [*middle, 0], [*middle, 1]
    aspect = view.ViewSize[0] / view.ViewSize[1]
    view.CameraParallelScale = 0.6 * max((right - left) / aspect, high - low)


def selected():
    """The run of the source that is selected in ParaView, else the one of the README."""
    source = simple.GetActiveSource()
    name = getattr(source, "FileName", None) or "output/upsetting/particles.pvd"
    return Path(name if isinstance(name, str) else name[0]).parent


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("run", nargs="?", type=Path, help="output directory")
    parser.add_argument("--field", default="equivalent_plastic_strain", help="of the points")
    parser.add_argument("--picture", metavar="FILE.png", help="is written, at the last time")
    # ParaView has arguments of its own.
    is_called = Path(sys.argv[0]).name == "paraview_upsetting.py"
    arguments = parser.parse_args(None if is_called else [])
    if simple is None:
        sys.exit("no ParaView here: run it with pvpython, of Debian's python3-paraview")
    directory = arguments.run or selected()
    if not (directory / "particles.pvd").is_file():
        sys.exit(f"No such file or directory: '{directory}/particles.pvd'")
    if arguments.picture:
        simple.GetActiveViewOrCreate("RenderView").ViewSize = [1200, 600]
    view = show(directory, arguments.field)
    if arguments.picture:
        simple.SaveScreenshot(arguments.picture, view)


main()
