#!/usr/bin/env python3
"""Errors of p on grids against closed forms: the tables of docs/liquid.md. Usage: liquid_errors.py build/moreau"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

PARABOLA = "(x - 0.2 - 0.3*y^2)"
S = 0.43206748182527804  # the edge in the rotating disc, y = p0/(rho omega^2 R^2) = 1/4


def scene(domain, free, velocity=None, force=None, walls=""):
    text = '[liquid]\ncoordinates = ["x", "y"]\ndensity = 1\ndomain = "%s"\n' % domain
    for key, value in (("velocity", velocity), ("force", force)):
        if value:
            text += "%s = %s\n" % (key, json.dumps(value))
    return text + "free = { all = { %s } }\nwalls = { %s }\n" % (free, walls)


def turn(x, y):
    angle = math.atan2(y, x)
    return angle + 2 * math.pi if angle < -1e-3 else angle


def in_disc(x, y):
    r = math.hypot(x, y)
    return 2 * (r * r - S * S) - 4 * S * S * math.log(r / S) if r > S else 0


def in_square(x, y):
    r = math.hypot(x, y)
    return r * r / 2 - math.log(r) - 0.5 if r > 1 else 0


A = 0.697965148223374  # where the hemisphere is touched: A^2 log(2/A) = 1 - A^2


def over_hemisphere(x, y):
    r = math.hypot(x, y)
    return 0 if r <= A else A * A / math.sqrt(1 - A * A) * math.log(2 / r) - (
        math.sqrt(1 - r * r) if r < 0.9 else math.sqrt(0.19) - 0.9 / math.sqrt(0.19) * (r - 0.9))


HEMISPHERE = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "problems", "liquid_hemisphere.toml")

# (name, scene, p, distance from the cavity's edge or None); parts are split where that keeps a disc off the radial solver.
SCENES = [
    ("rotating disc", scene("disc(center=[0, 0], radius=1)", 'where = "x < 7 or y < 0.3", pressure = 1', ["-2*y", "2*x"]),
     in_disc, lambda x, y: abs(math.hypot(x, y) - S)),
    ("square", scene("box(low=[-1.5, -1.5], high=[1.5, 1.5])",
                     'where = "true", pressure = "(x^2 + y^2)/2 - log(x^2 + y^2)/2 - 1/2"', ["-y", "x"]),
     in_square, lambda x, y: abs(math.hypot(x, y) - 1)),
    ("ellipse", scene("{x^2 + 3*y^2 <= 1}", 'where = "true", pressure = "max(0, %s)^2"' % PARABOLA,
                      force=["2*x + 0.72*y^2*x - 0.6*x^2 + 0.24*x + 0.36*y^2*x", "0"]),
     lambda x, y: max(0, x - 0.2 - 0.3 * y * y) ** 2, lambda x, y: abs(x - 0.2 - 0.3 * y * y)),
    ("hemisphere", open(HEMISPHERE).read().replace("[liquid.parameters]", "%s\n[liquid.parameters]"),
     over_hemisphere, lambda x, y: abs(math.hypot(x, y) - A)),
    ("re-entrant corner", scene("polygon(vertices=[[0,0],[1,0],[1,1],[-1,1],[-1,-1],[0,-1]])",
                                'where = "true", pressure = "2 + (x^2+y^2)^(1/3)*sin(2/3*(if(atan2(y,x) < -0.001, '
                                'atan2(y,x) + 2*pi, atan2(y,x))))"'),
     lambda x, y: 2 + math.hypot(x, y) ** (2 / 3) * math.sin(2 / 3 * turn(x, y)), None)]
SCENES.append(("h jumps between nodes", scene("box(low=[-1, -1], high=[1, 1])",
                                              'where = "true", pressure = "40 - 10*max(0.6*x + 0.8*y - 0.1, 0)^2"',
                                              force=["-20/0.6*max(0.6*x + 0.8*y - 0.1, 0)", "0"]),
               lambda x, y: 40 - 10 * max(0.6 * x + 0.8 * y - 0.1, 0) ** 2, None))
for low, name in (("-1", "junction at a node"), ("-0.9", "junction between nodes")):
    SCENES.append((name, scene("box(low=[%s, 0], high=[1, 1])" % low,
                               'where = "y > 1e-7 or x >= 0", pressure = "2 + sqrt(hypot(x,y))*sin(atan2(y,x)/2)"',
                               walls='floor = { where = "true", acceleration = 0 }'),
                   lambda x, y: 2 + math.sqrt(math.hypot(x, y)) * math.sin(math.atan2(y, x) / 2), None))


def main(program):
    print("%-24s %5s %9s %9s %9s %8s" % ("scene", "cells", "error", "far", "bound", "seconds"))
    for name, text, p, edge in SCENES:
        for cells in (64, 128, 256, 512):
            with tempfile.TemporaryDirectory() as folder:
                file, table = os.path.join(folder, "liquid.toml"), os.path.join(folder, "p.csv")
                with open(file, "w") as out:
                    said = "cells = %d\n" % cells
                    out.write(text % said if "%s" in text else text + said)
                run = subprocess.run([program, "solve", "--json", file, "--data", table], capture_output=True, text=True)
                if run.returncode not in (0, 3):  # 3: the bound, beside corners, is above the accuracy asked for
                    raise SystemExit(run.stderr)
                answer = json.loads(run.stdout)
                with open(table) as rows:
                    points = [(float(r["x"]), float(r["y"]), float(r["p"])) for r in csv.DictReader(rows)]
            step = max(x for x, _, _ in points) - min(x for x, _, _ in points)
            far = 8 * step / cells
            errors = [(abs(q - p(x, y)), edge is None or edge(x, y) > far) for x, y, q in points]
            print("%-24s %5d %9.1e %9.1e %9.1e %8.3f" % (name, cells, max(e for e, _ in errors),
                  max((e for e, is_far in errors if is_far), default=math.nan),
                  answer["certificate"]["error_bound"], answer["seconds"]))


main(sys.argv[1])
