"""Problem files and dicts, motions, and what notebooks show; the oracle is the program, or a law of mechanics."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest
import warnings
import xml.dom.minidom

import numpy as np

import moreau

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("MOREAU_BUILD", ROOT / "build")) / "moreau"
BALL = {
    "system": {"coordinates": ["y"], "kinetic": "m/2*y'^2", "potential": "m*g*y", "parameters": {"m": 2, "g": 10},
               "constraints": {"floor": "y >= 0"}},
    "state": {"position": {"y": 5}, "velocity": {"y": 0}},
    "simulate": {"until": 3, "restitution": 0.5},
}


class Files(unittest.TestCase):
    def test_every_problem_has_the_answer_that_the_program_prints(self):
        for file in sorted((ROOT / "docs/problems").glob("*.toml")):
            if file.stem.startswith("liquid"):
                continue
            ran = subprocess.run([PROGRAM, "solve", "--json", file], capture_output=True, text=True)
            if ran.returncode == 2:
                with self.assertRaises(moreau.InvalidInput):
                    moreau.solve(file)
                continue
            expected = json.loads(ran.stdout)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", moreau.SceneWarning)
                found = dict(moreau.solve(file))
            for answer in (expected, found):
                answer.pop("seconds", None)
            self.assertEqual(found, expected, file)

    def test_a_dict_is_a_file_and_settings_change_it(self):
        at_rest = BALL | {"state": {"position": {"y": 0}}}
        found = moreau.solve(at_rest)
        self.assertEqual((found.kind, found.active, found.multipliers), ("system", ["floor"], {"floor": 20.0}))
        self.assertEqual(moreau.solve(at_rest, set={"m": 3}).multipliers["floor"], 30.0)
        self.assertEqual(moreau.solve(at_rest, certify=True).certificate["level"], "exact")
        self.assertIn("Persists: floor", found.text)

    def test_errors_have_their_message_and_place(self):
        with self.assertRaisesRegex(moreau.InvalidInput, 'unknown key "kinetc"') as caught:
            moreau.solve({"system": BALL["system"] | {"kinetc": "1"}, "state": BALL["state"]})
        self.assertEqual(caught.exception.key, "system.kinetc")
        self.assertEqual((caught.exception.line, caught.exception.column), (None, None))
        self.assertEqual(caught.exception.others, [])
        with self.assertRaisesRegex(moreau.InvalidInput, '"yy" is unknown') as caught:
            moreau.solve({"system": BALL["system"] | {"kinetic": "yy'^2"}, "state": {"position": {"z": "y*"}}})
        self.assertEqual(["z" in str(other) for other in caught.exception.others], [True])
        self.assertEqual(caught.exception.key, "system.kinetic")
        self.assertEqual([other.key for other in caught.exception.others], ["state.position.z"])
        for wrong, key in [({"projection": {"A": [[1, 0], [0, "a"]], "z": np.zeros(2)}}, "projection.A[1][1]"),
                           (BALL | {"state": {"position": {"y": -1}}}, "system.constraints.floor"),
                           ({"state": {}}, None)]:
            with self.assertRaises(moreau.InvalidInput) as caught:
                moreau.solve(wrong)
            self.assertEqual((caught.exception.key, caught.exception.line), (key, None))
        with self.assertRaises(moreau.InvalidInput) as caught:
            moreau.Motion(BALL | {"state": {"position": {"y": -1}}})
        self.assertEqual(caught.exception.key, "system.constraints.floor")
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.toml")
            with open(file, "w") as stream:
                stream.write("title = 'a'\nsytem = 3\n")
            with self.assertRaises(moreau.InvalidInput) as caught:
                moreau.solve(file)
            self.assertEqual((caught.exception.line, caught.exception.column, caught.exception.key), (2, 1, None))
        with self.assertRaisesRegex(moreau.InvalidInput, "^nowhere.toml: no such file"):
            moreau.solve("nowhere.toml")
        with self.assertRaisesRegex(AttributeError, "a system has no accelerations"):
            moreau.solve(BALL).accelerations
        with self.assertRaisesRegex(TypeError, "cannot hold a set"):
            moreau.solve({"system": {1, 2}})

    def test_what_the_program_warns_of_is_a_warning(self):
        near = BALL | {"state": {"position": {"y": 1e-6}}}
        with self.assertWarnsRegex(moreau.SceneWarning, "floor"):
            moreau.solve(near)


class Motions(unittest.TestCase):
    def test_a_ball_that_falls_bounces_at_the_times_of_galilei(self):
        motion = moreau.Motion(BALL)
        path = motion.run()
        self.assertEqual(motion.status, "done")
        impacts = [event.t for event in motion.events if event.kind == "impact"]
        # From 5 m at 10 m/s²: after 1 s; each flight takes half of the time of the one before.
        np.testing.assert_allclose(impacts[:3], [1, 2, 2.5], rtol=1e-12)
        first = motion.events[0]
        self.assertEqual(first.constraints, ["floor"])
        np.testing.assert_allclose([first.velocity_before[0], first.velocity_after[0]], [-10, 5], rtol=1e-12)
        self.assertEqual(path.t[-1], 3)
        falling = path.t < 1
        np.testing.assert_allclose(path["y"][falling], 5 - 5 * path.t[falling] ** 2, atol=1e-11)
        np.testing.assert_allclose(path["y''"][falling], -10, rtol=1e-12)
        np.testing.assert_allclose(path.energy[falling], 100, rtol=1e-12)

    def test_a_motion_goes_on_step_by_step_and_from_where_it_is(self):
        whole, parts = moreau.Motion(BALL), moreau.Motion(BALL)
        whole.run(2.2)
        while parts.advance(1.5):
            pass
        parts.run(2.2, times=[1.7, 1.6])
        np.testing.assert_allclose(parts.position, whole.position, rtol=1e-12)
        self.assertEqual([event.kind for event in parts.events], [event.kind for event in whole.events])

    def test_a_remark_tells_how_often_and_when(self):
        # Above the floor by less than the contact tolerance.
        motion = moreau.Motion(BALL, set={"position.y": 1e-10, "velocity.y": 0})
        (remark,) = motion.record["remarks"]
        self.assertEqual((remark["t"], remark["count"], remark["last"]), (0, 1, 0))
        self.assertIn("floor", remark["message"])

    def test_where_a_motion_does_not_go_on_it_has_no_acceleration(self):
        block = {"system": {"coordinates": ["x"], "kinetic": "x'^2/2", "potential": "2*x^2",
                            "forces": {"x": "-0.5*sign(x')"}}, "state": {"position": {"x": 1.1}}}
        motion = moreau.Motion(block)
        self.assertEqual(motion.acceleration.shape, (1,))
        motion.run(10)
        self.assertEqual((motion.status, motion.acceleration, motion.multipliers), ("stopped", None, None))

    def test_what_cannot_move_is_refused(self):
        with self.assertRaisesRegex(moreau.InvalidInput, "nothing here moves"):
            moreau.Motion({"projection": {"A": [[1]], "z": [1], "U": [[1]], "s": [0]}})
        with self.assertRaisesRegex(moreau.InvalidInput, "floor"):
            moreau.Motion(BALL, set={"position.y": -1})
        for times in ([3, 0.1], [-1]):
            with self.assertRaisesRegex(ValueError, "times: (3|-1)"):
                moreau.Motion(BALL).run(until=2, times=times)
        with self.assertRaisesRegex(ValueError, "before t = 0"):
            moreau.Motion(BALL).run(until=-1)
        for until in ("1", float("inf"), float("nan")):
            with self.assertRaisesRegex(ValueError, "^until: .* is no time; give a finite number$"):
                moreau.Motion(BALL).run(until)
        with self.assertRaisesRegex(KeyError, r"z: no such column; there are y, lambda.floor."):
            moreau.Motion(BALL).run(until=1)["z"]
        with self.assertRaisesRegex(moreau.InvalidInput, "^set: a str; give a dict"):
            moreau.Motion(BALL, set="m=3")
        with self.assertRaisesRegex(ValueError, "until"):
            moreau.Motion({key: BALL[key] for key in ("system", "state")}).run()


class Looks(unittest.TestCase):
    def test_results_show_themselves_as_tables_and_as_a_picture(self):
        scene = moreau.solve(ROOT / "docs/problems/delassus_drops_too_much.toml")
        numbers = moreau.solve(A=[[2, 0], [0, 1]], z=[0, -9.81], U=[[0, 1], [1, 1]], s=[0, 0])
        split = moreau.decompose(moreau.norm1(), [3, -0.5])
        motion = moreau.Motion(BALL)
        for shown in (scene, numbers, split, motion, moreau.laws(moreau.norm1(), 2), moreau.solve(z=[[1.0]], U=[[1.0]])):
            xml.dom.minidom.parseString(f"<div>{shown._repr_html_()}</div>")
        self.assertIn("<td>right</td><td>persists</td>", scene._repr_html_())
        for drawn in (scene, numbers, split):
            picture = drawn._repr_svg_()
            if picture is not None:  # gnuplot is not everywhere
                self.assertIn("svg", xml.dom.minidom.parseString(picture).documentElement.tagName)
        with tempfile.TemporaryDirectory() as folder:
            if scene._repr_svg_() is not None:
                scene.plot(pathlib.Path(folder) / "scene.svg")
                self.assertTrue((pathlib.Path(folder) / "scene.svg").stat().st_size > 1000)

    def test_arrows_on_each_other_have_names_apart_and_what_is_zero_is_said(self):
        for z, told in (([0.5, 0.25], ["z", "x = 0", "y"]), ([0, 0], ["z = x = y = 0"]), ([3, 1], ["z", "x", "y"])):
            texts = xml.dom.minidom.parseString(moreau.decompose(moreau.norm1(), z)._repr_svg_()).getElementsByTagName("text")
            self.assertEqual([text.firstChild.data for text in texts], told)
            places = [(float(text.getAttribute("x")), float(text.getAttribute("y"))) for text in texts]
            for i, (x, y) in enumerate(places):
                self.assertTrue(all(abs(x - a) + abs(y - b) > 15 for a, b in places[:i]))

    def test_what_cannot_be_drawn_has_no_picture(self):
        self.assertIsNone(moreau.solve(z=[1.0], U=[[1.0]])._repr_svg_())
        self.assertIsNone(moreau.decompose(moreau.norm1(), [1, 2, 3])._repr_svg_())
