"""What the page and the notebooks say is what happens; the stubs name what is there."""

import ast
import contextlib
import doctest
import io
import json
import pathlib
import re
import unittest

import moreau

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "docs/notebooks"


def code_of(notebook):
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


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

    def test_the_notebooks_run_in_order_and_hold_what_they_assert(self):
        found = sorted(NOTEBOOKS.glob("*.ipynb"))
        self.assertGreaterEqual(len(found), 2)
        for notebook in found:
            with self.subTest(notebook.name), contextlib.chdir(NOTEBOOKS), contextlib.redirect_stdout(io.StringIO()):
                names = {}
                for k, code in enumerate(code_of(notebook)):
                    exec(compile(code, f"{notebook.name}[{k}]", "exec"), names)

    def test_notebooks_are_stored_without_results(self):
        for notebook in NOTEBOOKS.glob("*.ipynb"):
            for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
                self.assertFalse(cell.get("outputs"), notebook.name)


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
