"""The problem library: its truth is held against the conditions of optimality in Python's fractions."""

import csv
import json
import os
import pathlib
import re
import subprocess
import tempfile
import tomllib
import unittest
from fractions import Fraction

import numpy as np
import scipy.io

import moreau

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("MOREAU_BUILD", ROOT / "build")) / "moreau"
#: Thirty digits, and a few roundings of them.
NEARLY = Fraction(1, 10**28)


def numbers_of(projection):
    exact = lambda x: Fraction(x)
    z, s = [exact(x) for x in projection["z"]], [exact(x) for x in projection["s"]]
    A = projection["A"]
    if isinstance(A, dict):
        A = [[A["diagonal"][i] if i == j else 0 for j in range(len(z))] for i in range(len(z))]
    return [[exact(x) for x in row] for row in A], z, [[exact(x) for x in row] for row in projection["U"]], s


def dot(x, y):
    return sum((a * b for a, b in zip(x, y) if a and b), Fraction(0))


def size(x, y):
    return sum((abs(a * b) for a, b in zip(x, y)), Fraction(0))


def rank(rows):
    rows, found = [list(row) for row in rows], 0
    for column in range(len(rows[0]) if rows else 0):
        pivot = next((k for k in range(found, len(rows)) if rows[k][column]), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        for k in range(found + 1, len(rows)):
            factor = rows[k][column] / rows[found][column]
            if factor:
                rows[k] = [a - factor * b for a, b in zip(rows[k], rows[found])]
        found += 1
    return found


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.held = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.held.cleanup)
        cls.folder = pathlib.Path(cls.held.name) / "library"
        scenes = sorted((ROOT / "docs/problems").glob("*.toml"))
        subprocess.run([PROGRAM, "gallery", "--write", cls.folder, "--scenes", *scenes], check=True, capture_output=True)
        with open(cls.folder / "index.csv", encoding="utf-8") as stream:
            cls.index = list(csv.DictReader(stream))

    def read(self, line, ending):
        return (self.folder / line["class"] / (line["problem"] + ending)).read_text(encoding="utf-8")

    def test_every_family_every_scene_and_instants_of_motions_are_there(self):
        self.assertGreaterEqual(len(self.index), 300)
        families = {line["class"] for line in self.index if line["kind"] == "family"}
        self.assertEqual(len(families), 15)
        self.assertGreater(sum(line["kind"] == "motion" for line in self.index), 30)
        self.assertEqual(len({line["problem"] for line in self.index}), len(self.index))

    def test_the_truth_satisfies_the_conditions_of_optimality_in_fractions(self):
        for line in self.index:
            with self.subTest(line["problem"]):
                projection = json.loads(self.read(line, ".json"))["projection"]
                (A, z, U, s), truth = numbers_of(projection), json.loads(self.read(line, ".truth.json"))
                held = set(projection.get("two_sided", []))
                if truth["status"] == "infeasible":
                    w = [Fraction(x) for x in truth["farkas"]]
                    self.assertTrue(all(x >= 0 for a, x in enumerate(w) if a not in held))
                    self.assertTrue(all(dot(w, column) == 0 for column in zip(*U)) and dot(w, s) > 0)
                    continue
                fractions = truth["exact"]["acceleration"] and truth["exact"]["multipliers"]
                chosen = truth["exact"] if fractions else truth
                q, multipliers = ([Fraction(x) for x in chosen[key]] for key in ("acceleration", "multipliers"))
                slack_of_digits = 0 if fractions else NEARLY
                for a, row in enumerate(U):
                    slack, near = dot(row, q) - s[a], slack_of_digits * (size(row, q) + abs(s[a]))
                    is_active = a in truth["active"]
                    self.assertTrue(abs(slack) <= near if is_active else slack > 0, (a, float(slack)))
                    self.assertTrue(is_active or multipliers[a] == 0)
                    self.assertTrue(multipliers[a] >= 0 or a in held)
                    self.assertTrue(a not in truth["weak"] or multipliers[a] == 0)
                columns = list(zip(*U)) or [()] * len(z)
                for i, row in enumerate(A):
                    missing = dot(row, q) - z[i] - dot(columns[i], multipliers)
                    near = slack_of_digits * (size(row, q) + abs(z[i]) + size(columns[i], multipliers))
                    self.assertLessEqual(abs(missing), near)
                tight = [U[a] for a in truth["active"]]
                dependent = len(tight) - rank(tight) if len(tight) < 200 else int(line["dependent"])
                self.assertEqual(int(line["dependent"]), dependent)
                if dependent == 0:
                    self.assertTrue(truth["multipliers_unique"])

    def test_the_three_forms_hold_the_same_numbers(self):
        for line in self.index[::3]:
            as_json = json.loads(self.read(line, ".json"))["projection"]
            self.assertEqual(tomllib.loads(self.read(line, ".toml"))["projection"], as_json)
            A, z, U, s = numbers_of(as_json)
            folder = self.folder / line["class"] / line["problem"]
            for name, expected in (("A", A), ("U", U), ("z", [[x] for x in z]), ("s", [[x] for x in s])):
                read = scipy.io.mmread(folder / f"{name}.mtx").toarray()
                self.assertEqual(read.tolist(), [[float(x) for x in row] for row in expected], (line["problem"], name))

    def test_the_condition_in_the_index_is_that_of_numpy(self):
        for line in self.index:
            if float(line["condition"]) > 1e8:
                continue
            A = np.array(numbers_of(json.loads(self.read(line, ".json"))["projection"])[0], dtype=float)
            np.testing.assert_allclose(float(line["condition"]), np.linalg.cond(A), rtol=0.06)

    def test_the_program_of_the_page_measures_a_solver(self):
        page = (ROOT / "docs/problem-library.md").read_text(encoding="utf-8")
        names = {}
        exec(re.search(r"```python\n(.*?)```", page, re.DOTALL)[1], names)

        def solve(A, z, U, s, two_sided):
            return moreau.solve(A=A, z=z, U=U, s=s, two_sided=two_sided).acceleration

        found = names["errors"](self.folder, solve)
        self.assertEqual(len(found), sum(line["status"] == "solved" for line in self.index))
        self.assertLess(max(found.values()), 1e-9)
        worse = names["errors"](self.folder, lambda A, z, U, s, two_sided: np.linalg.solve(A, z))
        self.assertGreater(sum(error > 1e-6 for error in worse.values()), len(found) / 2)
