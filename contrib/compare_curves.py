#!/usr/bin/python3
"""Says where columns of a history differ most from those of a reference.

Both are interpolated linearly over an abscissa that only grows; relative
differences are taken at every row of the history that the reference covers.

    contrib/compare_curves.py output/upsetting/history.csv \\
        prm/references/upsetting.csv platen_displacement --from 5e-4
"""

import results
import numpy

parser = results.Parser(__doc__)
parser.add_argument("history")
parser.add_argument("reference")
parser.add_argument("abscissa", help="column of both")
parser.add_argument("--from", dest="start", type=float, default=-numpy.inf,
                    help="first abscissa that counts")
arguments = parser.parse_args()

history = results.read_numbers(arguments.history)
reference = results.read_numbers(arguments.reference)
x, known = history[arguments.abscissa], reference[arguments.abscissa]
counts = (x >= max(arguments.start, known[0]) * (1 - 1e-9)) & (
    x <= known[-1] * (1 + 1e-9))
for column in reference:
    if column == arguments.abscissa or column not in history:
        continue
    exact = numpy.interp(x, known, reference[column])
    errors = numpy.where(counts, numpy.abs(history[column] / exact - 1), 0)
    worst = numpy.argmax(errors)
    l2 = numpy.sqrt(numpy.trapz(((history[column] - exact)[counts])**2, x[counts])
                    / numpy.trapz(exact[counts]**2, x[counts]))
    print(f"{column}: worst {100 * errors[worst]:.3f} % at "
          f"{x[worst]:.6g}, L2 {100 * l2:.3f} %")
