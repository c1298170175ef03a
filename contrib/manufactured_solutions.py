#!/usr/bin/python3
"""Manufactured solutions of prm/vortex.prm and prm/axis_aligned.prm.

Prints the expressions as they stand in these files (and the force of the vortex
in current coordinates, and a third direction of the other), and checks them: the
derivation with sympy, the expressions against finite differences of the motion
alone (with many digits), and that the files have them.

    contrib/manufactured_solutions.py

The law is the neo-Hookean one, P = G (F - F^-T) + lambda ln J F^-T, and the
force per mass is b = d2x/dt2 - Div P / rho, all per initial volume.

Vortex: x = Q(alpha) X with the rotation Q and alpha = A sin(pi t) q^2,
q = 1 - 16 (R-1)^2, so that q^2 = 1 - 32 (R-1)^2 + 256 (R-1)^4; q vanishes at
the edges R = 0.75 and 1.25 of the ring, and with it both alpha and its slope,
which leaves the edges free of traction. J = 1 and the shear is
s = R dalpha/dR, hence tau_rr = 0, tau_rt = G s, tau_tt = G s^2, and in polar
coordinates of the current position (Div is that of the current one, too)

    b_r = -R alpha_t^2 + G/rho R alpha_R^2           = R f
    b_t =  R alpha_tt  - G/rho (3 alpha_R + R alpha_RR) = R g

With alpha_R = -64 (R-1) q A sin(pi t) and (R-1)^2 = (1-q)/16,

    f = A^2 q^2 (256 G/rho sin(pi t)^2 (1-q) - pi^2 cos(pi t)^2 q^2)
    g = -A sin(pi t) (pi^2 q^2 + G/rho (128 - 384 q + 192 q/R))

Axis-aligned: u_i = +-A sin(k X_i) sin(c pi t), with minus (a phase of pi) for y;
other phases would need a deformed start. F is diagonal, so

    b_i = u_i (k^2/rho (G + (G + lambda (1 - ln J)) / F_i^2) - c^2 pi^2)
"""

import random
import re
import sys
import textwrap
from pathlib import Path

import results

results.Parser(__doc__).parse_args()  # before modules that few have

import mpmath
import sympy

mpmath.mp.dps = 50
root = Path(__file__).resolve().parent.parent
names = "x", "y", "z"


def vortex():
    r = "sqrt(x^2+y^2)"
    q = f"(1-16*({r}-1)^2)"
    a = f"A*sin(pi*t)*{q}^2"
    f = (f"A^2*{q}^2*(4096*G/rho*sin(pi*t)^2*({r}-1)^2"
         f" - pi^2*cos(pi*t)^2*{q}^2)")
    minus_g = (f"A*sin(pi*t)*(pi^2*{q}^2"
               f" + G/rho*(128 - 384*{q} + 192*{q}/{r}))")
    angle = f"(atan2(y, x) + {a})"
    s = f"(-64*A*sin(pi*t)*{r}*({r}-1)*{q})"
    velocity = f"A*pi*{q}^2"
    return {
        "motion": [f"x*cos({a}) - y*sin({a})", f"x*sin({a}) + y*cos({a})"],
        "Velocity": [f"-{velocity}*y", f"{velocity}*x"],
        "Body force, current coordinates": [f"{f}*x + {minus_g}*y",
                                            f"{f}*y - {minus_g}*x"],
        "Body force": [
            f"{f}*(x*cos({a}) - y*sin({a}))"
            f" + {minus_g}*(x*sin({a}) + y*cos({a}))",
            f"{f}*(x*sin({a}) + y*cos({a}))"
            f" - {minus_g}*(x*cos({a}) - y*sin({a}))"],
        "displacement": [f"x*(cos({a}) - 1) - y*sin({a})",
                         f"x*sin({a}) + y*(cos({a}) - 1)"],
        "cauchy_stress 0, 1, 4": [
            f"G*{s}*sin{angle}*({s}*sin{angle} - 2*cos{angle})",
            f"G*{s}*(cos{angle}^2 - sin{angle}^2 - {s}*sin{angle}*cos{angle})",
            f"G*{s}*cos{angle}*({s}*cos{angle} + 2*sin{angle})"],
    }


def axis_aligned(signs):
    dim = len(signs)
    u = [f"{sign}A*sin(k*{x})*sin(c*pi*t)" for x, sign in zip(names, signs)]
    F = [f"(1 {sign or '+'} k*A*cos(k*{x})*sin(c*pi*t))"
         for x, sign in zip(names, signs)]
    J = "*".join(F)
    return {
        "motion": [f"{x} + {u}" for x, u in zip(names, u)],
        "Velocity": [f"{sign}A*c*pi*sin(k*{x})"
                     for x, sign in zip(names, signs)],
        "Body force": [
            f"{u}*(k^2/rho*(G + (G + lambda*(1 - ln({J})))/{F}^2) - c^2*pi^2)"
            for u, F in zip(u, F)],
        "displacement": u,
        "cauchy_stress 0, 4, 8": [
            f"(G*({F}^2 - 1) + lambda*ln({J}))/({J})" for F in F] + [
            f"lambda*ln({J})/({J})"] * (3 - dim),
    }


def derivations_hold():
    """The formulas above, by sympy."""
    R, t, G, rho, A = sympy.symbols("R t G rho A", positive=True)
    q = 1 - 16 * (R - 1)**2
    alpha = A * sympy.sin(sympy.pi * t) * q**2
    f = A**2 * q**2 * (256 * G / rho * sympy.sin(sympy.pi * t)**2 * (1 - q) -
                       sympy.pi**2 * sympy.cos(sympy.pi * t)**2 * q**2)
    g = -A * sympy.sin(sympy.pi * t) * (
        sympy.pi**2 * q**2 + G / rho * (128 - 384 * q + 192 * q / R))
    s = R * alpha.diff(R)
    # Div tau of tau_rr = 0, tau_rt = G s, tau_tt = G s^2
    radial = -R * alpha.diff(t)**2 + G * s**2 / R / rho
    hoop = R * alpha.diff(t, 2) - G * (s.diff(R) + 2 * s / R) / rho

    X, T, k, c, rest, lame = sympy.symbols("X T k c rest lame", positive=True)
    u = A * sympy.sin(k * X) * T  # T'' = -(c pi)^2 T; J = F rest
    F = 1 + u.diff(X)
    log_J = sympy.log(F) + sympy.log(rest)
    P = G * (F - 1 / F) + lame * log_J / F
    b = u * (k**2 / rho * (G + (G + lame * (1 - log_J)) / F**2)
             - c**2 * sympy.pi**2)
    waves = -(c * sympy.pi)**2 * u - P.diff(X) / rho - b
    return all(sympy.simplify(e) == 0 for e in (
        radial - R * f, hoop - R * g, q.subs(R, sympy.Rational(3, 4)),
        q.subs(R, sympy.Rational(5, 4)), waves))


def evaluate(expression, constants, at):
    """What the program's parser makes of it at (x, ..., t)."""
    text = expression.replace("^", "**").replace("lambda", "lame")
    text = re.sub(r"\b(\d+)", r"mpf(\1)", text)
    return eval(text, {"mpf": mpmath.mpf, "pi": mpmath.pi, "sin": mpmath.sin,
                       "cos": mpmath.cos, "ln": mpmath.log,
                       "sqrt": mpmath.sqrt, "atan2": mpmath.atan2, **constants,
                       **dict(zip(names, at[:-1])), "t": at[-1]})


def errors(solution, constants, place):
    """Of the expressions at random times and places, over their size, from
    differences of the motion."""
    dim = len(solution["motion"])
    h = mpmath.mpf(10)**-8

    def value(what, at):
        return mpmath.matrix([evaluate(e, constants, at)
                              for e in solution[what]])

    def slope(f, at, d):
        def g(n):
            return f([a + n * h if i == d else a for i, a in enumerate(at)])
        return (8 * (g(1) - g(-1)) - (g(2) - g(-2))) / (12 * h)

    def motion(at):
        return value("motion", at)

    def gradient(at):
        F = mpmath.eye(3)
        for j in range(dim):
            column = slope(motion, at, j)
            for i in range(dim):
                F[i, j] = column[i]
        return F

    def piola(at):
        F = gradient(at)
        inverse = (F**-1).T
        return (constants["G"] * (F - inverse) +
                constants["lame"] * mpmath.log(mpmath.det(F)) * inverse)

    worst = {}

    def compare(what, found, expected):
        error = mpmath.norm(found - expected) / mpmath.norm(expected)
        worst[what] = max(worst.get(what, 0), error)

    for _ in range(5):
        at = [*place(), mpmath.mpf(random.uniform(0.1, 0.9))]
        now = motion(at)
        rest = [*at[:dim], mpmath.mpf(0)]
        force = slope(lambda a: slope(motion, a, dim), at, dim)
        for j in range(dim):
            change = slope(piola, at, j)
            for i in range(dim):
                force[i] -= change[i, j] / constants["rho"]
        F = gradient(at)
        sigma = piola(at) * F.T / mpmath.det(F)
        for what in solution:
            if what == "Body force":
                compare(what, value(what, at), force)
            elif what.startswith("Body force"):
                compare(what, value(what, [*now, at[-1]]), force)
            elif what == "displacement":
                compare(what, value(what, at), now - mpmath.matrix(at[:dim]))
            elif what == "Velocity":
                compare(what, value(what, rest), slope(motion, rest, dim))
            elif what.startswith("cauchy_stress"):
                parts = [int(c) for c in re.findall(r"\d", what)]
                compare(what, value(what, at), mpmath.matrix(
                    [sigma[c // 3, c % 3] for c in parts]))
    return worst


def printed(expressions):
    """As lines of a parameter file."""
    lines = []
    for expression in expressions:
        lines += textwrap.wrap(expression, 70, break_long_words=False,
                               break_on_hyphens=False)
        lines[-1] += ";"
    return " \\\n".join("      " + line for line in lines)[:-1]


def is_in(file_name, expressions):
    text = re.sub(r"[\s\\#]", "", (root / "prm" / file_name).read_text())
    return re.sub(r"\s", "", ";".join(expressions)) in text


def main():
    random.seed(1)

    def in_ring():
        r, angle = random.uniform(0.76, 1.24), random.uniform(-3, 3)
        return [mpmath.mpf(r) * mpmath.cos(angle),
                mpmath.mpf(r) * mpmath.sin(angle)]

    def in_cube(dim):
        return lambda: [mpmath.mpf(random.random()) for _ in range(dim)]

    def lame_constants(young, poisson):
        return {"G": mpmath.mpf(young) / (2 * (1 + poisson)),
                "lame": young * poisson / ((1 + poisson) * (1 - 2 * poisson))}

    nu = mpmath.mpf(3) / 10
    waves = dict(A=mpmath.mpf(5) / 100, k=2 * mpmath.pi, c=1, rho=1000,
                 **lame_constants(1000, nu))
    good = derivations_hold()
    print(f"sympy: the derivations {'hold' if good else 'DO NOT HOLD'}\n")
    for title, file_name, solution, constants, place in (
            ("Vortex", "vortex.prm", vortex(),
             dict(A=mpmath.mpf(3) / 10, rho=1000, **lame_constants(1000, nu)),
             in_ring),
            ("Axis-aligned", "axis_aligned.prm", axis_aligned(["", "-"]),
             waves, in_cube(2)),
            ("Axis-aligned, 3D", None,
             axis_aligned(["", "-", ""]), waves, in_cube(3))):
        worst = errors(solution, constants, place)
        good = good and max(worst.values()) < 1e-20
        print(f"{title}\n")
        for what, error in worst.items():
            there = (file_name is None or what.endswith("current coordinates")
                     or is_in(file_name, solution[what]))
            good = good and there
            print(f"  {what}: error {mpmath.nstr(error, 2)}"
                  f"{'' if there else f', NOT IN {file_name}'}")
            print(printed(solution[what]) + "\n")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
