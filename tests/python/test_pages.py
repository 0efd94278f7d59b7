"""What the page and the notebooks say is what happens; the stubs name what is there."""

import ast
import doctest
import io
import json
import pathlib
import re
import unittest

import moreau
from notebook_outputs import NOTEBOOKS, differs, outputs_of, told

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Pages(unittest.TestCase):
    def test_the_examples_of_the_page_print_what_it_shows(self):
        page = (ROOT / "docs/python.md").read_text(encoding="utf-8")
        examples = "\n".join(re.findall(r"```python\n(.*?)```", page, re.DOTALL))
        test = doctest.DocTestParser().get_doctest(examples, {}, "docs/python.md", None, 0)
        said = io.StringIO()
        runner = doctest.DocTestRunner()
        runner.run(test, out=said.write)
        self.assertGreater(runner.tries, 15)
        self.assertEqual(runner.failures, 0, said.getvalue())

    def test_the_notebooks_run_in_order_hold_what_they_assert_and_show_what_is_stored(self):
        found = sorted(NOTEBOOKS.glob("*.ipynb"))
        self.assertGreaterEqual(len(found), 2)
        for path in found:
            notebook = json.loads(path.read_text(encoding="utf-8"))
            stored = [cell["outputs"] for cell in notebook["cells"] if cell["cell_type"] == "code"]
            self.assertGreater(sum(map(len, stored)), 3, path.name)
            for k, (kept, run) in enumerate(zip(stored, outputs_of(notebook), strict=True)):
                with self.subTest(f"{path.name}, code cell {k + 1}"):
                    if not moreau._moreau.can_draw():
                        kept = [one for one in kept if "image/svg+xml" not in one.get("data", {})]
                    self.assertEqual([set(told(one)) for one in kept], [set(told(one)) for one in run])
                    for one, other in zip(kept, run):
                        for kind, text in told(one).items():
                            self.assertEqual(differs(text, told(other)[kind]), "")

    def test_the_tests_that_the_page_of_proofs_names_are_there(self):
        page = (ROOT / "docs/proof.md").read_text(encoding="utf-8")
        named = re.findall(r"`(tests/[\w/.]+\.(?:cpp|py))`", page[page.index("## 11."):])
        self.assertGreater(len(named), 15)
        for path in named:
            self.assertTrue((ROOT / path).is_file(), path)

    def test_a_stored_number_that_is_off_is_told(self):
        self.assertEqual(differs("f = 1.25, error 3e-15", "f = 1.2500000001, error 7e-15"), "")
        self.assertIn("1.26", differs("f = 1.25", "f = 1.26"))
        self.assertIn("opens", differs("persists 1", "opens 1"))


class Stubs(unittest.TestCase):
    def test_the_stubs_name_everything_that_is_there_and_nothing_else(self):
        folder = pathlib.Path(moreau.__file__).parent
        self.assertTrue((folder / "py.typed").exists())
        tree = ast.parse((folder / "__init__.pyi").read_text(encoding="utf-8"))
        classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        for name, node in classes.items():
            declared = {item.name if isinstance(item, ast.FunctionDef) else item.target.id
                        for item in node.body if isinstance(item, (ast.FunctionDef, ast.AnnAssign))}
            there = set(dir(getattr(moreau, name)))
            if name != "InvalidInput":  # its attributes are set when it is raised
                self.assertLessEqual(declared, there, name)
            own = {one for one in vars(getattr(moreau, name)) if not one.startswith("_")}
            self.assertLessEqual(own, declared, name)
        functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        reexported = {alias.asname or alias.name for node in tree.body if isinstance(node, ast.ImportFrom)
                      for alias in node.names}
        declared = functions | set(classes) | reexported
        for name in moreau.__all__:
            self.assertTrue(name in declared or name in moreau.catalogue.entries, name)
        stub = ast.parse((folder / "catalogue.pyi").read_text(encoding="utf-8"))
        self.assertEqual([node.name for node in stub.body if isinstance(node, ast.FunctionDef)],
                         list(moreau.catalogue.entries))
