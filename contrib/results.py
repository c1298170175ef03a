"""What the scripts of this folder share: how they are called, how they complain, and
how they read what a run leaves.

Import it before anything that may be missing. From then on, what a user may have got
wrong ends a script with one line and exit code 1: a file that cannot be read, a column
that is not there, a Python module whose Debian package is not installed.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "Agg")  # no window, on a screen neither

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/impm_dealii"

PACKAGES = {
    "jinja2": "python3-jinja2",
    "matplotlib": "python3-matplotlib",
    "mpmath": "python3-mpmath",
    "numpy": "python3-numpy",
    "sympy": "python3-sympy",
    "vtk": "python3-vtk9",
    "vtkmodules": "python3-vtk9",
    "vtkmodules.vtkIOXdmf2": "python3-paraview",
}


class Refusal(Exception):
    """What a user is told in one line."""


def one_line(error):
    """What to say of an error that is not the script's own, else nothing."""
    if isinstance(error, Refusal):
        return str(error)
    if isinstance(error, ModuleNotFoundError):
        name = error.name or ""
        package = PACKAGES.get(name) or PACKAGES.get(name.split(".")[0])
        return package and (
            f"{sys.executable} has no module '{error.name}': install Debian's {package}"
            " (contrib/install_packages does) and run /usr/bin/python3"
        )
    if isinstance(error, OSError):
        what = error.strerror or str(error)
        return f"{what}: '{error.filename}'" if error.filename else what
    if isinstance(error, subprocess.CalledProcessError):
        return f"{error.cmd[0]} ended with exit code {error.returncode}"
    return None


def complain(kind, error, traceback):
    text = one_line(error)
    if text:
        print(f"{Path(sys.argv[0]).name}: {text}", file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, traceback)


sys.excepthook = complain


class Parser(argparse.ArgumentParser):
    """The description is the script's own; what is wrong takes one line."""

    def __init__(self, description=None, **others):
        others["formatter_class"] = argparse.RawDescriptionHelpFormatter
        super().__init__(description=description, **others)

    def error(self, message):
        self.exit(1, f"{self.prog}: {message} (--help tells more)\n")


def picture_file(name):
    """An argument that matplotlib can write."""
    if Path(name).suffix not in (".png", ".svg", ".pdf"):
        raise argparse.ArgumentTypeError(f"'{name}' ends neither in .png, .svg nor .pdf")
    return name


class Table(dict):
    """Columns of a file, or what is in a row, by the names of the columns."""

    def __init__(self, path, columns):
        super().__init__(columns)
        self.path = path

    def __missing__(self, name):
        raise Refusal(f"'{self.path}' has no column '{name}', but {', '.join(self) or 'none'}")


def read_rows(path):
    """Of a CSV file, as texts by the names of the columns."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file, restval="")
            rows = [Table(path, row) for row in reader]
            return rows, list(reader.fieldnames or ())
    except (UnicodeDecodeError, csv.Error):
        raise Refusal(f"'{path}' is no CSV file") from None


def read_numbers(path, grows=False):
    """The columns of a CSV file as arrays; what is empty is not a number. Of a file that
    grows, the last row may not have been written to its end."""
    import numpy

    rows, names = read_rows(path)
    if grows and not Path(path).read_bytes().endswith(b"\n"):
        del rows[-1:]
    columns = {}
    for name in names:
        try:
            columns[name] = numpy.array([float(row[name] or "nan") for row in rows])
        except ValueError as error:
            raise Refusal(f"'{path}', column '{name}': {error}") from None
    return Table(path, columns)


def history(directory):
    return read_numbers(Path(directory) / "history.csv", grows=True)


def read_json(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except ValueError:
        raise Refusal(f"'{path}' is no JSON file") from None


def parameters(directory):
    """The resolved entries of a run, as 'Section/Entry'. The program writes an entry
    on one line."""
    entries, sections = {}, []
    for line in (Path(directory) / "parameters.prm").read_text().splitlines():
        word, _, rest = line.strip().partition(" ")
        if word == "subsection":
            sections.append(rest.strip())
        elif word == "end" and sections:
            sections.pop()
        elif word == "set":
            name, _, value = rest.partition("=")
            entries["/".join([*sections, name.strip()])] = value.strip()
    return entries


def read_vtu(path):
    from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

    parallel = path.suffix == ".pvtu"
    reader = (vtkXMLPUnstructuredGridReader if parallel else vtkXMLUnstructuredGridReader)()
    if not reader.CanReadFile(str(path)):
        raise Refusal(f"'{path}' is no picture of a run")
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def read_hdf5(path):
    """By the XDMF file of its series, which says what is where."""
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

    series = path.stem.rpartition("_")[0]
    times = [time for time, file in pictures(path.parent, series) if file == path]
    if not times:
        raise Refusal(f"'{path}' is no picture of '{path.with_name(series)}.xdmf'")
    reader = vtkXdmfReader()
    reader.SetFileName(str(path.with_name(f"{series}.xdmf")))
    reader.UpdateInformation()
    reader.UpdateTimeStep(times[0])
    return reader.GetOutputDataObject(0)


class Data:
    """The points of a picture, or the nodes of its grid: `places` (n x 3), and fields by
    name, (n), (n x 3) or (n x 3 x 3)."""

    def __init__(self, path):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkObject

        vtkObject.GlobalWarningDisplayOff()
        path = Path(path)
        if not path.is_file():
            raise Refusal(f"'{path}' is no picture of a run")
        self.path = path
        self.output = (read_hdf5 if path.suffix == ".h5" else read_vtu)(path)
        if self.output.GetPoints() is None:
            raise Refusal(f"'{path}' has no points")
        self.to_numpy = vtk_to_numpy
        self.places = vtk_to_numpy(self.output.GetPoints().GetData())
        fields = self.output.GetPointData()
        self.names = [fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays())]

    def __getitem__(self, name):
        if name not in self.names:
            raise Refusal(f"'{self.path}' has no field '{name}', but {', '.join(self.names) or 'none'}")
        values = self.to_numpy(self.output.GetPointData().GetArray(name))
        return values.reshape(-1, 3, 3) if values.shape[1:] == (9,) else values

    def __contains__(self, name):
        return name in self.names

    def size_of(self, name):
        """Of a scalar its value, of vectors and tensors the root of the sum of squares."""
        values = self[name]
        return values if values.ndim == 1 else (values.reshape(len(values), -1) ** 2).sum(1) ** 0.5

    def cells(self):
        """The corners of the cells as (n x corners x 3), in the order of VTK."""
        cells = self.output.GetCells()
        corners = self.to_numpy(cells.GetConnectivityArray())
        return self.places[corners.reshape(self.output.GetNumberOfCells(), -1)]


def list_of_pictures(directory, series="particles"):
    """The file that names them; of a run without pictures the one of VTU files, which is
    not there."""
    path = Path(directory) / f"{series}.pvd"
    xdmf = path.with_suffix(".xdmf")
    return xdmf if xdmf.exists() and not path.exists() else path


def pictures(directory, series="particles"):
    """Times and paths of the pictures, in their order."""
    path = list_of_pictures(directory, series)
    try:
        tree = ElementTree.parse(path)
    except ElementTree.ParseError:
        raise Refusal(f"'{path}' is no list of pictures") from None
    if path.suffix == ".xdmf":
        records = [(grid.find("Time").get("Value"), grid.find(".//DataItem").text.partition(":")[0])
                   for grid in tree.findall(".//Grid/Grid")]
    else:
        records = [(r.get("timestep"), r.get("file")) for r in tree.findall(".//DataSet")]
    if not records:
        raise Refusal(f"'{path}' names no picture")
    return [(float(time), path.parent / file.strip()) for time, file in records]


def last_picture(directory, series="particles"):
    return Data(pictures(directory, series)[-1][1])


def nearest_picture(directory, time, series="particles"):
    """The time of the picture that is nearest to one, and what it holds."""
    found, path = min(pictures(directory, series), key=lambda p: abs(p[0] - time))
    return found, Data(path)


QUANTITIES = {  # powers of length, mass and time
    "length": (1, 0, 0),
    "volume": (3, 0, 0),
    "time": (0, 0, 1),
    "mass": (0, 1, 0),
    "velocity": (1, 0, -1),
    "force": (1, 1, -2),
    "pressure": (-1, 1, -2),
    "energy": (2, 1, -2),
    "specific energy": (2, 0, -2),
}
OF_FIELDS = {
    "length": ("position", "displacement"),
    "velocity": ("velocity",),
    "volume": ("volume",),
    "specific energy": ("internal_energy",),
}
SI_NAMES = {"force": "N", "pressure": "Pa", "energy": "J", "specific energy": "J/kg"}


class Run:
    """An output directory, whatever there is of it: a run may have failed, or go on."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.name = self.directory.resolve().name
        if not self.directory.is_dir():
            raise Refusal(f"there is no directory '{directory}'")
        there = lambda file: (self.directory / file).is_file()
        self.summary = read_json(self.directory / "summary.json") if there("summary.json") else {}
        self.entries = parameters(self.directory) if there("parameters.prm") else {}
        kind = self.entries.get("Geometry/Kind", "")
        self.dim = 3 if kind == "3D" else 2
        self.is_axisymmetric = kind == "axisymmetric"
        self.title = self.entries.get("General/Title") or self.name
        names = [unit.strip() for unit in self.entries.get("General/Units", "m, kg, s").split(",")]
        self.units = dict(zip(("length", "mass", "time"), names)) | self.summary.get("units", {})

    def unit(self, quantity):
        """Of a quantity of QUANTITIES, in the units of the scene."""
        if quantity == "temperature":
            return "K"
        base = [self.units[name] for name in ("length", "mass", "time")]
        if base == ["m", "kg", "s"] and quantity in SI_NAMES:
            return SI_NAMES[quantity]
        length, mass, time = QUANTITIES[quantity]
        sides = {1: [], -1: []}
        for unit, power in ((base[1], mass), (base[0], length), (base[2], time)):
            if power != 0:
                exponent = f"^{abs(power)}" if abs(power) > 1 else ""
                sides[1 if power > 0 else -1].append(unit + exponent)
        above, below = " ".join(sides[1]) or "1", " ".join(sides[-1])
        if len(sides[-1]) > 1:
            below = f"({below})"
        return f"{above}/{below}" if below else above

    def quantity(self, name):
        """Of a field of points, nothing if it has no unit."""
        for quantity, names in OF_FIELDS.items():
            if name in names:
                return quantity
        if "stress" in name or "pressure" in name:
            return "pressure"
        return "temperature" if "temperature" in name else None

    def label(self, name, text=None):
        """What to write at an axis: a field and its unit."""
        quantity = self.quantity(name)
        text = text or name.replace("_", " ")
        return f"{text} ({self.unit(quantity)})" if quantity else text

    def has(self, file):
        return (self.directory / file).is_file()

    def status(self):
        """What became of it: 'done', why it failed, or that it has not ended."""
        return self.summary.get("status") or "not ended: it goes on, or was killed"

    def is_done(self):
        return self.summary.get("status") == "done"

    def has_failed(self):
        """Neither done nor to be gone on with."""
        return bool(self.summary) and self.summary.get("status") not in ("done", "stopped by a signal")


def as_file_name(label):
    """What a study makes of a label in the names of its directories."""
    name = ""
    for letter in label:
        if letter.isascii() and (letter.isalnum() or letter in ".+-"):
            name += letter
        elif name and name[-1] != "-":
            name += "-"
    name = name.rstrip("-")
    return "0" + name if name[:1] in ("", ".") else name


class Study:
    """The output directory of a study; `rows` of study.csv hold texts."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.about = read_json(self.directory / "study.json")
        self.title = self.about["title"] or self.about["study"]
        self.rows, self.names = read_rows(self.directory / "study.csv")
        self.n_runs = self.about.get("runs", len(self.rows))  # that there will be
        self.lists = [entry["name"] for entry in self.about["lists"]]
        self.errors = [name[6:] for name in self.names if name.startswith("error_")]

    def name_of(self, row):
        """The run of a row, and its directory in that of the study."""
        return "_".join(as_file_name(row[name]) for name in self.lists)
