#!/usr/bin/python3
"""Finite elements of another code for two scenes with friction: the ring of
prm/contact/ring_compression.prm and the billet of prm/contact/upsetting.prm,
by CalculiX (Debian: calculix-ccx), quadratic axisymmetric elements.

    contrib/friction_by_calculix.py ring 0.1 > prm/references/ring_0.1.csv
    contrib/friction_by_calculix.py billet 0.1 > prm/references/upsetting_0.1.csv

The upper half is modelled; the platen is rigid. Where the step cannot be made shorter, as where a fold has
crushed an element, the curve ends early. Takes minutes. Units: mm, N, MPa; of
the curve: m, N.
"""

import pathlib
import subprocess
import tempfile

import results

# Inner and outer radius, half of the height, travel; elements across and up;
# Young's modulus, Poisson's ratio, yield stress, hardening; names of columns.
SCENES = {
    "ring": (1.5, 3, 1, 0.5, 24, 16, 70e3, 0.33, 100, 50,
             "travel,load,hole"),
    "billet": (0, 10, 15, 9, 16, 24, 200e3, 0.3, 700, 300,
               "platen_displacement,platen_load,largest_radius"),
}
CONTACT_STIFFNESS = 3e6  # per area, MPa/mm: a closed gap is under 1e-3 mm
N_STEPS = 100


def lines_of(numbers):
    for i in range(0, len(numbers), 8):
        yield ", ".join(map(str, numbers[i:i + 8])) + ","


def deck(scene, friction):
    inner, outer, height, travel, nr, nz, young, poisson, yields, hardening, _ \
        = SCENES[scene]
    lines, nodes, sets = ["*NODE"], {}, {}
    n = 0

    def add_node(r, z):
        nonlocal n
        n += 1
        lines.append(f"{n}, {r:.10g}, {z:.10g}, 0")
        return n

    for j in range(2 * nz + 1):
        for i in range(2 * nr + 1):
            if i % 2 == 0 or j % 2 == 0:
                nodes[i, j] = add_node(inner + (outer - inner) * i / (2 * nr),
                                       height * j / (2 * nz))
    left, right = 0.5 * inner, 2 * outer
    n_platen = 24
    platen = [[add_node(left + (right - left) * i / n_platen, z)
               for i in range(n_platen + 1)]
              for z in (height, 1.1 * height)]

    lines.append("*ELEMENT, TYPE=CAX8R, ELSET=BODY")
    corners = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    surface = []
    for j in range(nz):
        for i in range(nr):
            element = j * nr + i + 1
            lines.append(f"{element}, " + ", ".join(
                str(nodes[2 * i + a, 2 * j + b]) for a, b in corners))
            # Sides may fold onto the platen, the upper half of them.
            if j == nz - 1:
                surface.append(f"{element}, S3")
            if i == nr - 1 and j >= nz // 2:
                surface.append(f"{element}, S2")
            if i == 0 and inner > 0 and j >= nz // 2:
                surface.append(f"{element}, S4")
    lines.append("*ELEMENT, TYPE=CAX4, ELSET=TOOL")
    below = []
    for i in range(n_platen):
        element = nr * nz + i + 1
        lines.append(f"{element}, {platen[0][i]}, {platen[0][i + 1]}, "
                     f"{platen[1][i + 1]}, {platen[1][i]}")
        below.append(f"{element}, S1")

    sets["MIDDLE"] = [v for (i, j), v in nodes.items() if j == 0]
    sets["PLATEN"] = platen[0] + platen[1]
    sets["SIDE"] = [v for (i, j), v in nodes.items()
                    if i == (0 if inner > 0 else 2 * nr)]
    fixed = ["MIDDLE, 2, 2", "PLATEN, 1, 1"]
    if inner == 0:
        sets["AXIS"] = [v for (i, j), v in nodes.items() if i == 0]
        fixed.append("AXIS, 1, 1")
    for name, numbers in sets.items():
        lines += [f"*NSET, NSET={name}", *lines_of(numbers)]
    strain = 5
    elastic = ["*ELASTIC", f"{young}, {poisson}"]
    return "\n".join(lines + [
        "*SURFACE, NAME=BODY, TYPE=ELEMENT", *surface,
        "*SURFACE, NAME=TOOL, TYPE=ELEMENT", *below,
        "*MATERIAL, NAME=BODY", *elastic,
        "*PLASTIC", f"{yields}, 0", f"{yields + strain * hardening}, {strain}",
        "*SOLID SECTION, ELSET=BODY, MATERIAL=BODY",
        "*MATERIAL, NAME=TOOL", *elastic,
        "*SOLID SECTION, ELSET=TOOL, MATERIAL=TOOL",
        "*SURFACE INTERACTION, NAME=CONTACT",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{CONTACT_STIFFNESS}",
        *(["*FRICTION", f"{friction}, {CONTACT_STIFFNESS / 10}"]
          if friction > 0 else []),
        "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE",
        "BODY, TOOL",
        "*BOUNDARY", *fixed,
        "*TIME POINTS, NAME=ALL, GENERATE", f"0, 1, {1 / N_STEPS}",
        "*STEP, NLGEOM, INC=100000",
        "*STATIC", f"{0.2 / N_STEPS}, 1, 1e-7, {1 / N_STEPS}",
        "*CONTROLS, PARAMETERS=TIME INCREMENTATION",
        "10, 16, 9, 40, 16, 4, , 15, , ",
        "*BOUNDARY", f"PLATEN, 2, 2, {-travel}",
        "*NODE PRINT, NSET=PLATEN, TOTALS=ONLY, TIME POINTS=ALL", "RF",
        "*NODE PRINT, NSET=SIDE, TIME POINTS=ALL", "U",
        "*END STEP", ""])


def curve(scene, text):
    """Rows of travel, load and the radius of the side, smallest of a hole."""
    inner, outer, _, travel = SCENES[scene][:4]
    time, rows, is_force = 0, {}, False
    for line in text.splitlines():
        words = line.split()
        if " for set " in line:
            time, is_force = float(words[-1]), "force" in line
            rows.setdefault(time, [travel * time, 0, []])
        elif words and is_force:
            # Axisymmetric elements are a wedge of two degrees.
            rows[time][1] = 180 * abs(float(words[1]))
        elif words:
            rows[time][2].append(float(words[1]))
    for way, load, radial in rows.values():
        radius = inner + min(radial) if inner > 0 else outer + max(radial)
        yield f"{way / 1e3:.6g},{load:.6g},{radius / 1e3:.6g}"


def main():
    parser = results.Parser(__doc__)
    parser.add_argument("scene", choices=SCENES)
    parser.add_argument("friction", type=float, help="coefficient")
    arguments = parser.parse_args()
    scene, friction = arguments.scene, arguments.friction
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory) / "run"
        path.with_suffix(".inp").write_text(deck(scene, friction))
        subprocess.run(["ccx", "-i", str(path)], stdout=subprocess.DEVNULL)
        print(SCENES[scene][-1])
        print("\n".join(curve(scene, path.with_suffix(".dat").read_text())))


if __name__ == "__main__":
    main()
