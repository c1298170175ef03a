#!/usr/bin/python3
"""Draws what one cell of each law answers: the scenes of one cell in prm/materials.

    contrib/materials_figure.py build/release/impm_dealii doc/figures/materials.png

Takes ten seconds.
"""

import subprocess
import tempfile
from pathlib import Path

import results
import matplotlib.pyplot as plt
import numpy as np

SCENES = Path(__file__).resolve().parent.parent / "prm/materials"


def probe(name, field, component, position):
    """Overrides that write a component of a field of the first point."""
    entries = {"Kind": "point", "Field": field, "Position": position}
    if component is not None:
        entries["Component"] = component
    return [f"Output/{name}/{entry}={value}" for entry, value in entries.items()]


def run(program, scene, overrides=(), plane=False):
    """The columns of history.csv, of a scene or of each run of a study, with the stress and
    stretch along y (along x in the plane)."""
    position = "0, 0" if plane else "0, 0, 0"
    along, across = (0, 4) if plane else (4, 0)
    sets = ["Output/Probes=along, across, stretch",
            *probe("along", "kirchhoff_stress", along, position),
            *probe("across", "kirchhoff_stress", across, position),
            *probe("stretch", "deformation_gradient", along, position),
            *overrides]
    is_study = "studies" in scene
    with tempfile.TemporaryDirectory() as directory:
        command = [program, "--quiet", "--output", directory]
        for entry in sets:
            command += ["--set", entry]
        subprocess.run(command + (["--study"] if is_study else []) +
                       [str(SCENES / scene)], check=True)
        files = (sorted(Path(directory).glob("*/history.csv")) if is_study else
                 [Path(directory) / "history.csv"])
        runs = {}
        for name in files:
            runs[name.parent.name] = results.history(name.parent)
        return runs if is_study else next(iter(runs.values()))


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("picture", type=results.picture_file, metavar="FILE.png")
    arguments = parser.parse_args()
    program, picture = arguments.program, arguments.picture
    figure, panels = plt.subplots(2, 3, figsize=(13, 7), constrained_layout=True)
    hardening, rubber, relaxation, failure, soil, lamina = panels.flat

    for name, h in run(program, "studies/hardening.prm").items():
        law, method = name.split("_")
        if method == "Lagrangian":
            hardening.plot(0.5 * h["time"], 1e-6 * h["along"], label=law)
    hardening.set(title="hardenings of steel", xlabel="plastic strain",
                  ylabel="stress (MPa)")
    hardening.legend(fontsize="small")

    for name, h in run(program, "studies/rubber.prm").items():
        rubber.plot(h["stretch"], 1e-6 * (h["along"] - h["across"]) / h["stretch"],
                    label=name)
    rubber.set(title="rubber", xlabel="stretch", ylabel="force / initial area (MPa)")
    rubber.legend(fontsize="small")

    for step in (0.1, 0.02):
        h = run(program, "relaxation.prm", [f"Time/Time step={step}"])
        relaxation.plot(h["time"], 1e-6 * h["along"], label=f"steps of {step} s")
    relaxation.set(title="relaxation", xlabel="time (s)", ylabel="stress (MPa)",
                   ylim=(0, None))
    relaxation.legend(fontsize="small")

    h = run(program, "failure.prm", ["Time/Time step=0.02"])
    failure.plot(np.log(h["stretch"]), 1e-6 * h["along"])
    failure.set(title="failure of steel", xlabel="logarithmic strain",
                ylabel="stress (MPa)")

    for name, h in run(program, "studies/triaxial.prm").items():
        soil.plot(1 - h["stretch"], 1e-3 * (h["across"] - h["along"]), label=name)
    soil.set(title="soils in a triaxial cell", xlabel="compression",
             ylabel="difference of stresses (kPa)")
    soil.legend(fontsize="small")

    stresses = {float(name): h["along"][-1] for name, h in
                run(program, "studies/lamina.prm", plane=True).items()}
    angles = sorted(stresses)
    lamina.plot(angles, [1e-9 * stresses[a] for a in angles], "o-")
    lamina.set(title="fibres in a stretched sheet", xlabel="angle (degrees)",
               ylabel="stress along the stretch (GPa)")
    figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    main()
