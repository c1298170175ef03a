"""Shows the points of a run in ParaView as the boxes that they were, carried along by
their deformation gradients and coloured by a field; a body about an axis is mirrored.
Debian's paraview and python3-paraview.

    paraview --script=contrib/paraview_upsetting.py     # output/upsetting
    pvpython contrib/paraview_upsetting.py output/upsetting --picture strain.png

or, in ParaView, Macros > Import new macro: it then shows the run whose particles.pvd is
selected. Without a screen: xvfb-run -a pvpython ... Points that have split are drawn as
squares and cubes, too, which they need not be.
"""

import argparse
import re
import sys
from pathlib import Path

from paraview import simple

# Columns of the deformation gradient times the side that the box had: what a tensor
# glyph takes for its axes. About an axis a point is a ring of length 2 pi r.
SIDE_OF = {
    "axisymmetric": "(volume / det(F) * F[:, 2, 2] / (2 * numpy.pi * x)) ** (1 / 2)",
    "plane": "(volume / det(F)) ** (1 / 2)",
    "3D": "(volume / det(F)) ** (1 / 3)",
}
