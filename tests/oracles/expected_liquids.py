#!/usr/bin/python3
"""tests/cases/liquid_*.expected.json: closed forms of the liquids of docs/problems, without the product.

A disc in rigid rotation: p = rho omega^2 (r^2 - s^2)/2 - rho omega^2 s^2 log(r/s) outside of the cavity r < s, which
has p = p' = 0 at s; a ball with -lap p = -k: p = k (r^2 - s^2)/6 + k s^3/3 (1/r - 1/s). Roots by bisection in 40 digits
(mpmath). The column of slabs by Newton's law in fractions: all slabs that move together share p0/(n m)."""
import json
import os
from fractions import Fraction as F

from mpmath import findroot, log, mp, mpf, pi, sqrt

mp.dps = 40
CASES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cases")


def write(name, expected):
    with open(os.path.join(CASES, name + ".expected.json"), "w") as file:
        json.dump(expected, file, indent=1)
        file.write("\n")


def liquid(name, measure, extent, largest, probes, onset=None, parted=(), tolerance="1e-12"):
    write(name, {"kind": "liquid", "status": "solved", "measure": str(measure), "extent": None if extent is None else str(extent),
                 "max": str(largest), "parted_walls": list(parted), "tolerance": tolerance,
                 "probes": [{"at": at, "p": str(p), "growth": str(g)} for at, p, g in probes],
                 "onset": {k: str(v) for k, v in (onset or {}).items()}})


liquid("liquid_piston", 0, None, 5, [("x=0.5", mpf("3.75"), 0), ("x=1.9", mpf("0.25"), 0)], {"a": F(5, 6)}, ["piston"])
s = 1 - sqrt(2) / 2
liquid("liquid_tube", 2 * s, s, 1, [("x=0.1", 0, 4), ("x=0.7", 2 * (mpf("0.7") - s) ** 2, 0)], {"omega": sqrt(2)})
disc = lambda s: 2 * (1 - s**2) + 4 * s**2 * log(s) - mpf("1.6")
s = findroot(disc, (mpf("0.1"), mpf("0.5")), solver="anderson")
p = lambda r: 2 * (r**2 - s**2) - 4 * s**2 * log(r / s)
liquid("liquid_disc", pi * s**2, s, mpf("1.6"), [("x=0.1, y=0.1", 0, 8), ("x=0.57, y=0.76", p(mpf("0.95")), 0)], {"omega": sqrt(mpf("3.2"))})
ball = lambda s: 8 * (1 - s**2) / 6 + 8 * s**3 / 3 * (1 - 1 / s) - mpf("0.8")
s = findroot(ball, (mpf("0.2"), mpf("0.8")), solver="anderson")
p = lambda r: 8 * (r**2 - s**2) / 6 + 8 * s**3 / 3 * (1 / r - 1 / s)
liquid("liquid_ball", 4 * pi * s**3 / 3, s, mpf("0.8"), [("x=0, y=0.1, z=0", 0, 8), ("x=0.6, y=0.6, z=0.45", p(sqrt(mpf("0.9225"))), 0)], {"omega": sqrt(mpf("2.4"))})
p = lambda r: r**2 / 2 - log(r) - mpf(1) / 2
liquid("liquid_square", pi, 1, p(sqrt(mpf("4.5"))), [("x=0.5, y=0.5", 0, 2), ("x=1.25, y=0", p(mpf("1.25")), 0), ("x=-1.2, y=1.2", p(sqrt(mpf("2.88"))), 0)], tolerance="1e-3")
hemisphere = lambda a: a**2 * log(2 / a) - 1 + a**2
a = findroot(hemisphere, (mpf("0.5"), mpf("0.9")), solver="anderson")
top = lambda r: sqrt(1 - r**2) if r < mpf("0.9") else sqrt(mpf("0.19")) - mpf("0.9") / sqrt(mpf("0.19")) * (r - mpf("0.9"))
p = lambda r: a**2 / sqrt(1 - a**2) * log(2 / r) - top(r)
liquid("liquid_hemisphere", pi * a**2, a, p(sqrt(mpf(8))), [("x=0.3, y=0.4", 0, mpf("1.75") / mpf("0.75") ** mpf("1.5")), ("x=1.5, y=0", p(mpf("1.5")), 0), ("x=0.8, y=0", p(mpf("0.8")), 0)], tolerance="3e-3")
liquid("liquid_tank", 0, None, 1, [("x=0.3, y=0.5", mpf("0.25"), 0)], {"a": mpf("10.25")}, ["bed"], "1e-7")

n, p0, a, m = 20, F(5), F(5, 4), F(3) * 2 / 20
names = ["x[%d]" % (k + 1) for k in range(n)]
contacts = ["pressure[%d]" % (k + 1) for k in range(n - 1)] + ["piston"]
together = p0 / (n * m)
push = [p0 - m * (k + 1) * together for k in range(n - 1)] + [F(0)]
held = [p0 - m * (k + 1) * a for k in range(n)]
rows = {c: {names[k]: "-1", **({names[k + 1]: "1"} if k + 1 < n else {})} for k, c in enumerate(contacts)}
reaction = [(push[k - 1] if k else 0) - push[k] for k in range(n)]
text = lambda values, keys: {key: str(value) for key, value in zip(keys, values)}
write("liquid_column_of_slabs", {
    "status": "solved", "active": contacts[:-1], "contacts": contacts, "acceleration": text([together] * n, names),
    "multipliers": text(push, contacts), "multipliers_unique": True,
    "multiplier_ranges": {c: [str(v), str(v)] for c, v in zip(contacts, push)}, "reaction": text(reaction, names),
    "gauss": str(n * m * together**2 / 2 - p0 * together),
    "two_sided": {"consistent": True, "acceleration": text([a] * n, names), "multipliers": text(held, contacts)},
    "hypothesis": {"accepted": False, "drop_negative_is_right": False},
    "derive": {"A": [[str(m if i == j else 0) for j in range(n)] for i in range(n)],
               "z": text([p0] + [0] * (n - 1), names), "U": rows, "s": text([0] * (n - 1) + [-a], contacts)},
    "source": "Newton's law in fractions, tests/oracles/expected_liquids.py"})
