#!/usr/bin/python3
"""Writes a Gmsh mesh of a quarter of a square plate, 4 x 4, with a hole of radius 1.

    contrib/plate_with_hole.py 40 10 > prm/mesh/plate_with_hole.msh

Takes the numbers of quadrilaterals around the hole and away from it.
"""

import math

import results

parser = results.Parser(__doc__)
parser.add_argument("around", type=int)
parser.add_argument("away", type=int)
arguments = parser.parse_args()
n_around, n_away = arguments.around, arguments.away
if n_around < 1 or n_away < 1:
    parser.error("both numbers are to be at least 1")


def place(i, j):
    angle = math.pi / 2 * i / n_around
    hole = (math.cos(angle), math.sin(angle))
    along = 8 * i / n_around  # the right side, then the top
    side = (min(4, 8 - along), min(4, along))
    share = (j / n_away) ** 1.5
    return [round(a + share * (b - a), 10) for a, b in zip(hole, side)]


def number(i, j):
    return 1 + i * (n_away + 1) + j


nodes = [place(i, j) for i in range(n_around + 1) for j in range(n_away + 1)]
cells = [
    (number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j))
    for i in range(n_around)
    for j in range(n_away)
]
print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes", len(nodes), sep="\n")
for n, (x, y) in enumerate(nodes, 1):
    print(f"{n} {x:.12g} {y:.12g} 0")
print("$EndNodes\n$Elements", len(cells), sep="\n")
for n, cell in enumerate(cells, 1):
    print(n, "3 2 1 1", *cell)
print("$EndElements")
