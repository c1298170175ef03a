#!/usr/bin/python3
"""Has VTK read the pictures of short runs and compares them with their histories.

usage: tests/scenes/pictures.py PROGRAM SCENES PAGE OUTPUT [MPIRUN]

Needs Debian's python3-vtk9; without it the exit code is 77. PAGE is
doc/output.md, which has the names of all that may be in the files.
"""

import csv
import fnmatch
import json
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

try:
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as error:
    print(f"{error}: left out; it needs python3-vtk9")
    sys.exit(77)

STEPS = [
    "Output/Steps between pictures=2",
    "Output/Time between pictures=0",
    "Time/Largest number of steps=4",
    "Output/Pictures=true",
]
ALL_FIELDS = (
    "position, velocity, cauchy_stress, kirchhoff_stress, von_mises_stress, pressure, "
    "equivalent_plastic_strain, damage, opening, preconsolidation_pressure, "
    "deformation_gradient, volume, body, parent, temperature, internal_energy"
)

# Scene, number of ranks, further entries, and what the scene is here for.
RUNS = {
    "plane": ("disks.prm", 1, [], {"free", "same points", "inertia"}),
    "plane_2_ranks": ("disks.prm", 2, [], {"free", "same points", "inertia"}),
    "explicit": (
        "disks.prm",
        1,
        ["Time/Integrator=explicit", "Time/Time step=0.02"],
        {"free", "same points", "inertia"},
    ),
    "axisymmetric": ("upsetting.prm", 1, [f"Output/Point fields={ALL_FIELDS}"], {"top"}),
    "axisymmetric_3_ranks": (
        "upsetting.prm",
        3,
        ["Grid/Adaptation/Highest level=1"],
        {"top"},
    ),
    "quarter": (
        "upsetting_quarter.prm",
        2,
        ["Grid/Cells=6, 6, 4", "Time/Largest number of steps=2"],
        {"hanging"},
    ),
    "merging": (
        "wake.prm",
        1,
        ["Time/Largest number of steps=8"],
        {"hanging", "rigid", "merging"},
    ),
    "finite_elements": (
        "lagrangian_limit.prm",
        1,
        [],
        {"same points"},
    ),
    "finite_elements_2_ranks": ("lagrangian_limit.prm", 2, [], {"same points"}),
    "rigid": ("billet_dynamic.prm", 2, [], {"rigid", "same points", "inertia"}),
    "kept_motion": (
        "billet_dynamic.prm",
        1,
        ["Grid/Reset=interval", "Grid/Steps between resets=3"],
        {"rigid", "same points"},
    ),
    "contact": ("contact/two_rods.prm", 1, [], {"same points", "layers"}),
    "contact_3_ranks": ("contact/two_rods.prm", 3, [], {"same points", "layers"}),
    "free_body": ("contact/rolling_disc.prm", 1, ["Grid/Cells=48, 6"], {"free body"}),
    "units": ("cook.prm", 1, ["General/Units=mm, t, s"], set()),
    "heat": ("materials/hot_billet.prm", 1, [f"Output/Point fields={ALL_FIELDS}"], set()),
    "conduction": ("materials/conduction.prm", 1, [], set()),
    "failure": ("materials/failure.prm", 1, [f"Output/Point fields={ALL_FIELDS}"], set()),
    "loads": ("loads/tube.prm", 1, [], set()),
}


def names_on(page):
    """Of each section of the page, the names in its tables."""
    names, section = {}, None
    for line in page.read_text().splitlines():
        if line.startswith("## "):
            section = line[3:].strip()
        elif match := re.match(r"\| `([^`]+)` \|", line):
            names.setdefault(section, []).append(match[1])
    return names


class Errors:
    """What VTK complains of."""

    def __init__(self):
        self.texts = []

    def watch(self, reader):
        @vtk.calldata_type(vtk.VTK_STRING)
        def remember(_, event, text):
            self.texts.append(text)

        reader.AddObserver("ErrorEvent", remember)
        reader.AddObserver("WarningEvent", remember)


def read(path):
    reader = (
        vtk.vtkXMLPUnstructuredGridReader()
        if path.suffix == ".pvtu"
        else vtk.vtkXMLUnstructuredGridReader()
    )
    errors = Errors()
    errors.watch(reader)
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors.texts, errors.texts
    return reader.GetOutput()


def arrays(data):
    return {
        data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
        for i in range(data.GetNumberOfArrays())
    }


class Mesh:
    def __init__(self, path, time):
        grid = read(path)
        self.path, self.time, self.grid = path, time, grid
        self.places = vtk_to_numpy(grid.GetPoints().GetData()) if grid.GetNumberOfPoints() else numpy.zeros((0, 3))
        self.points, self.cells = arrays(grid.GetPointData()), arrays(grid.GetCellData())
        # Once each, of several ranks.
        self.owned = self.points.get("vtkGhostType", numpy.zeros(len(self.places))) == 0
        assert numpy.isfinite(self.places).all()
        for name, values in {**self.points, **self.cells}.items():
            assert numpy.isfinite(values).all(), f"{name} in {path}"

    def sum(self, name):
        """Over all layers of nodes."""
        return sum(
            values[self.owned].sum(axis=0)
            for key, values in self.points.items()
            if re.fullmatch(rf"{name}(_of_layer_\d+)?", key)
        )

    def momentum(self):
        total = 0
        for key, mass in self.points.items():
            if key.startswith("mass"):
                velocity = self.points[key.replace("mass", "velocity", 1)]
                total = total + (mass[:, None] * velocity)[self.owned].sum(axis=0)
        return total


def series(directory, name):
    records = ElementTree.parse(directory / f"{name}.pvd").findall(".//DataSet")
    return [Mesh(directory / r.get("file"), float(r.get("timestep"))) for r in records]


def distinct(places):
    return len(set(map(tuple, places)))


def check_grid(run, mesh, points, tags):
    unique = distinct(mesh.places[mesh.owned])
    assert unique == mesh.owned.sum(), f"{mesh.owned.sum() - unique} vertices twice"
    assert unique == distinct(mesh.places), "a vertex belongs to no rank"
    assert set(mesh.cells) == {"level", "rank", "points"}
    n_deformable = (points.points["id"] >= 0).sum()
    assert mesh.cells["points"].sum() == n_deformable
    # Cells the right way round, without gaps.
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(mesh.grid)
    sizes.Update()
    data = sizes.GetOutput().GetCellData()
    measure = vtk_to_numpy(data.GetArray("Area" if "z" not in tags else "Volume"))
    extent = mesh.places.max(axis=0) - mesh.places.min(axis=0)
    extent = extent[extent > 0]
    assert (measure > 0).all()
    if "displacement" not in mesh.points:
        assert abs(measure.sum() / extent.prod() - 1) < 1e-6
    if "hanging" in tags:
        assert len(set(mesh.cells["level"])) > 1, "no hanging nodes"


def check_points(mesh, tags):
    ids = mesh.points["id"]
    assert len(set(ids)) == len(ids), "an id twice"
    rigid = mesh.points.get("body", ids) < 0
    assert rigid.any() == ("rigid" in tags)
    assert ((ids < 0) == rigid).all()


def check_displacements(first, last):
    """Over the points that are in both pictures."""
    found = {number: i for i, number in enumerate(first.points["id"])}
    pairs = numpy.array([(found[n], i) for i, n in enumerate(last.points["id"])])
    moved = last.places[pairs[:, 1]] - first.places[pairs[:, 0]]
    told = last.points["displacement"][pairs[:, 1]] - first.points["displacement"][pairs[:, 0]]
    scale = abs(moved).max()
    assert scale > 0
    assert abs(moved - told).max() < 1e-5 * scale, abs(moved - told).max() / scale


def check(directory, tags, names):
    with open(directory / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    row_at = {float(row["time"]): row for row in rows}
    summary = json.loads((directory / "summary.json").read_text())
    if summary["dim"] == 3:
        tags = tags | {"z"}
    particles, grids = series(directory, "particles"), series(directory, "grid")
    assert [m.time for m in particles] == [m.time for m in grids]
    assert len(grids) >= 2
    for points, grid in zip(particles, grids):
        check_points(points, tags)
        check_grid(directory, grid, points, tags)
        row = next((r for t, r in row_at.items() if abs(t - grid.time) <= 1e-9 * t), None)
        assert (row is None) == (grid.time == 0)
        if "free body" not in tags:
            mass = float((row or rows[0])["mass"])
            assert abs(grid.sum("mass") / mass - 1) < 1e-6, grid.sum("mass") / mass
        if row and "inertia" in tags:
            axes = [a for a in "xyz" if f"momentum_{a}" in row]
            momentum = numpy.array([float(row[f"momentum_{a}"]) for a in axes])
            scale = numpy.abs(grid.points["mass"]).sum() * numpy.abs(grid.points["velocity"]).max()
            assert abs(grid.momentum()[: len(axes)] - momentum).max() < 1e-6 * scale
        if row and "top" in tags:
            force = grid.points["reaction_force"][grid.owned, 1]
            top = grid.places[grid.owned, 1] == grid.places[:, 1].max()
            load = -float(row["platen_load"])
            assert abs(force[top].sum() / load - 1) < 1e-5, force[top].sum() / load
        if row:
            assert int(row["points"]) == (points.points["id"] >= 0).sum()
        assert ("velocity_of_layer_1" in grid.points) == ("layers" in tags)
    before, gone = set(), set()
    for points in particles:
        now = set(points.points["id"])
        gone |= before - now
        assert not now & gone, "an id comes back"
        before = now
    if "merging" in tags:
        assert gone, "nothing merges"
    if "same points" in tags:
        check_displacements(particles[0], particles[-1])
    for meshes, section in (
        (particles, "Points"),
        (grids, "Grid"),
        (series(directory, "surfaces") if (directory / "surfaces.pvd").exists() else [], "Surfaces"),
    ):
        for mesh in meshes:
            for name in {**mesh.points, **mesh.cells}:
                plain = re.sub(r"_of_layer_\d+$", "", name)
                assert plain == "vtkGhostType" or plain in names[section], f"{name}: not on the page"
            assert set(mesh.points) == set(meshes[0].points), "other fields than at first"
    # The columns that only this scene has are probes and reactions.
    own = set(summary.get("figures", {}))
    for name in rows[0]:
        on_page = any(fnmatch.fnmatch(name, n) for n in names["history.csv"] if n != "*")
        assert on_page or name in own, f"column {name}: not on the page"
    for key, value in summary.items():
        inner = value[0] if key == "errors" and value else value
        nested = key in ("units", "points_per_cell", "errors") and isinstance(inner, dict)
        for name in [key] + [f"{key}/{k}" for k in (inner if nested else {})]:
            assert name in names["summary.json"], f"key {name}: not on the page"
    check_units(particles[-1], grids[-1], summary)


def check_units(particles, grids, summary):
    units = summary["units"]
    text = ", ".join(units[k] for k in ("length", "mass", "time"))
    for mesh in (particles, grids):
        if mesh.path.suffix == ".vtu":
            field = mesh.grid.GetFieldData()
            assert field.GetAbstractArray("units").GetValue(0) == text
            time = field.GetArray("TimeValue").GetValue(0)
            assert abs(time - mesh.time) <= 1e-9 * mesh.time
            array = mesh.grid.GetPointData().GetArray(
                "displacement" if mesh is particles else "mass"
            )
            unit = array.GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL())
            assert unit == (units["length"] if mesh is particles else units["mass"]), unit
    assert summary["column_units"]["time"] == units["time"]


def main(program, scenes, page, output, mpirun=None):
    names = names_on(Path(page))
    failed = 0
    for name, (scene, ranks, entries, tags) in RUNS.items():
        if ranks > 1 and not mpirun:
            continue
        directory = Path(output) / name
        command = [mpirun, "-np", str(ranks)] if ranks > 1 else []
        command += [program, f"{scenes}/{scene}", "--quiet", "--output", str(directory)]
        for entry in STEPS + entries:
            command += ["--set", entry]
        try:
            run = subprocess.run(command, capture_output=True, text=True)
            assert run.returncode == 0, run.stderr
            check(directory, tags, names)
            print(f"{name}: passed")
        except AssertionError as error:
            failed += 1
            line = error.__traceback__
            while line.tb_next:
                line = line.tb_next
            print(f"{name}: line {line.tb_lineno}: {error}")
    return failed


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    sys.exit(min(1, main(*sys.argv[1:])))
