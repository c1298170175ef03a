#!/usr/bin/python3
"""Finite elements of another code for prm/extreme/necking_bar.prm, the round bar
that necks, by CalculiX (Debian: calculix-ccx), quadratic axisymmetric elements.

    contrib/necking_by_calculix.py 16 > prm/references/necking.csv

Half of the bar, its end held in its plane; elements are low at the neck, as many
across as the argument says. Takes two minutes. Units: mm, N, MPa; of the curve:
m, N.
"""

import math
import pathlib
import subprocess
import tempfile

import results

RADIUS, LENGTH, ELONGATION = 6.413, 26.667, 7.0
N_STEPS = 140


def yield_stress(strain):
    return 450 + 129.24 * strain + (715 - 450) * (1 - math.exp(-16.93 * strain))


def lines_of(numbers):
    for i in range(0, len(numbers), 8):
        yield ", ".join(map(str, numbers[i:i + 8])) + ","


def deck(nr):
    nz = 4 * nr
    lines, nodes = ["*NODE"], {}
    for j in range(2 * nz + 1):
        s = j / (2 * nz)
        z = LENGTH * (0.4 * s + 0.6 * s * s)
        for i in range(2 * nr + 1):
            if i % 2 == 0 or j % 2 == 0:
                nodes[i, j] = len(nodes) + 1
                lines.append(f"{nodes[i, j]}, {RADIUS * i / (2 * nr):.10g}, "
                             f"{z:.10g}, 0")
    lines.append("*ELEMENT, TYPE=CAX8R, ELSET=BODY")
    corners = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    for j in range(nz):
        for i in range(nr):
            lines.append(f"{j * nr + i + 1}, " + ", ".join(
                str(nodes[2 * i + a, 2 * j + b]) for a, b in corners))
    sets = {"MIDDLE": [v for (i, j), v in nodes.items() if j == 0],
            "TOP": [v for (i, j), v in nodes.items() if j == 2 * nz],
            "AXIS": [v for (i, j), v in nodes.items() if i == 0],
            "NECK": [nodes[2 * nr, 0]]}
    for name, numbers in sets.items():
        lines += [f"*NSET, NSET={name}", *lines_of(numbers)]
    # closer where the stress saturates
    strains = [0.005 * k for k in range(60)] + [0.3 + 0.1 * k for k in range(48)]
    return "\n".join(lines + [
        "*MATERIAL, NAME=BODY", "*ELASTIC", "206.9e3, 0.29",
        "*PLASTIC", *(f"{yield_stress(e):.8g}, {e:.6g}" for e in strains),
        "*SOLID SECTION, ELSET=BODY, MATERIAL=BODY",
        "*BOUNDARY", "MIDDLE, 2, 2", "AXIS, 1, 1", "TOP, 1, 1",
        "*TIME POINTS, NAME=ALL, GENERATE", f"0, 1, {1 / N_STEPS}",
        "*STEP, NLGEOM, INC=100000",
        "*STATIC", f"{0.2 / N_STEPS}, 1, 1e-7, {1 / N_STEPS}",
        "*BOUNDARY", f"TOP, 2, 2, {ELONGATION}",
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY, TIME POINTS=ALL", "RF",
        "*NODE PRINT, NSET=NECK, TIME POINTS=ALL", "U",
        "*END STEP", ""])


def curve(text):
    """Rows of elongation, load and radial displacement of the neck."""
    time, rows, is_force = 0, {}, False
    for line in text.splitlines():
        words = line.split()
        if " for set " in line:
            time, is_force = float(words[-1]), "force" in line
            rows.setdefault(time, [ELONGATION * time, 0, 0])
        elif words and is_force:
            # Axisymmetric elements are a wedge of two degrees.
            rows[time][1] = 180 * abs(float(words[1]))
        elif words:
            rows[time][2] = float(words[1])
    for way, load, radial in rows.values():
        yield f"{way / 1e3:.6g},{load:.6g},{radial / 1e3:.6g}"


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("elements", type=int, help="across the bar")
    n_across = parser.parse_args().elements
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory) / "run"
        path.with_suffix(".inp").write_text(deck(n_across))
        subprocess.run(["ccx", "-i", str(path)], stdout=subprocess.DEVNULL)
        print("elongation,load,neck")
        print("\n".join(curve(path.with_suffix(".dat").read_text())))


if __name__ == "__main__":
    main()
