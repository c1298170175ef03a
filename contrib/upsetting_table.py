#!/usr/bin/python3
"""Runs the upsetting on grids of 1, 0.5 and 0.25 mm and prints, as Markdown,
load and radius at 15, 30, 45 and 60 % beside what they cost.

    contrib/upsetting_table.py upsetting 24 15
    contrib/upsetting_table.py upsetting_rigid_points 24 18 "Time/Time step=1e-5"
"""

import subprocess

import results

root = results.ROOT
marks = {"15 %": 0.00225, "30 %": 0.0045, "45 %": 0.00675, "60 %": 0.009}


def interpolate(history, column, travel):
    """Linear in the travel of the platen; the last row if it is the end."""
    before = None
    for here in zip(history["platen_displacement"], history[column]):
        if here[0] >= travel * (1 - 1e-9):
            if before is None:
                return here[1]
            share = (travel - before[0]) / (here[0] - before[0])
            return before[1] + share * (here[1] - before[1])
        before = here
    return float("nan")


def main(scene, cells_r, cells_z, overrides):
    heads = [f"{mark}: kN, mm" for mark in marks]
    print("| grid | " + " | ".join(heads) + " | steps | Newton a step | cuts | seconds |")
    print("|---" * (len(heads) + 5) + "|")
    for factor, name in ((1, "1 mm"), (2, "0.5 mm"), (4, "0.25 mm")):
        output = root / "output" / f"table_{scene}_{factor}"
        cells = f"{cells_r * factor}, {cells_z * factor}"
        subprocess.run(
            [
                results.PROGRAM,
                root / f"prm/{scene}.prm",
                "--quiet",
                "--output",
                output,
                "--set",
                f"Grid/Cells={cells}",
                "--set",
                "Output/Pictures=false",
                *(part for override in overrides for part in ("--set", override)),
            ],
            check=True,
        )
        history = results.history(output)
        summary = results.Run(output).summary
        figures = [
            f"{interpolate(history, 'platen_load', travel) / 1e3:.1f}, "
            f"{interpolate(history, 'largest_radius', travel) * 1e3:.2f}"
            for travel in marks.values()
        ]
        print(
            f"| {name} | "
            + " | ".join(figures)
            + f" | {summary['steps']}"
            + f" | {summary['newton_iterations'] / summary['steps']:.1f}"
            + f" | {summary['step_cuts']} | {summary['wall_seconds']:.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    parser = results.Parser(__doc__)
    parser.add_argument("scene", nargs="?", default="upsetting", help="of prm, without .prm")
    parser.add_argument("cells_r", nargs="?", type=int, default=24, help="in r, of 1 mm")
    parser.add_argument("cells_z", nargs="?", type=int, default=15, help="in z, of 1 mm")
    parser.add_argument("overrides", nargs="*", metavar="OVERRIDE", help="as for --set")
    main(**vars(parser.parse_args()))
