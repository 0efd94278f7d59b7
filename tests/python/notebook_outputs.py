"""Runs notebooks and keeps what their cells show, without Jupyter.

    python tests/python/notebook_outputs.py            stores the outputs in docs/notebooks/*.ipynb
"""

import ast
import contextlib
import html
import io
import json
import pathlib
import re
import sys
import types
import unittest.mock

NOTEBOOKS = pathlib.Path(__file__).resolve().parents[2] / "docs/notebooks"
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def lines(text):
    return text.splitlines(keepends=True)


def shown(value, count):
    """What a notebook shows of the last expression of a cell; IPython's part is played here."""
    displayed = []
    display = types.ModuleType("IPython.display")
    display.display = lambda data, raw: displayed.append(data)
    if hasattr(value, "_ipython_display_"):
        with unittest.mock.patch.dict(sys.modules, {"IPython": types.ModuleType("IPython"), "IPython.display": display}):
            value._ipython_display_()
        return [{"output_type": "display_data", "data": {kind: lines(text) for kind, text in data.items()},
                 "metadata": {}} for data in displayed]
    data = {"text/plain": lines(repr(value))}
    if hasattr(value, "_repr_html_"):
        data["text/html"] = lines(value._repr_html_())
    return [{"output_type": "execute_result", "execution_count": count, "data": data, "metadata": {}}]


def outputs_of(notebook):
    """A list of outputs for each code cell, in order."""
    names, made = {}, []
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    with contextlib.chdir(NOTEBOOKS):
        for count, cell in enumerate(cells, 1):
            tree = ast.parse("".join(cell["source"]), f"cell {count}")
            last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
            said, outputs = io.StringIO(), []
            with contextlib.redirect_stdout(said):
                exec(compile(tree, f"cell {count}", "exec"), names)
                value = None if last is None else eval(compile(ast.Expression(last.value), f"cell {count}", "eval"), names)
            if said.getvalue():
                outputs.append({"output_type": "stream", "name": "stdout", "text": lines(said.getvalue())})
            if value is not None:
                outputs += shown(value, count)
            made.append(outputs)
    return made


def told(output):
    """The texts that are seen of an output, by kind: beside a table no plain text (it has times); of a picture its words."""
    texts = {"stream": "".join(output["text"])} if output["output_type"] == "stream" else {
        kind: "".join(text) for kind, text in output["data"].items()}
    if "text/html" in texts:
        del texts["text/plain"]
    for kind, text in texts.items():
        if "<svg" in text:
            words = re.findall(r"<(?:text|tspan|title|td|th|p|caption)\b[^>]*>([^<]*)<", text)
            texts[kind] = html.unescape(" ".join(sorted(words)))
    return texts


def differs(stored, run, relative=1e-6, nothing=1e-9):
    """Where two texts differ, beyond the last digits of their numbers and the size of errors; "" where not."""
    if NUMBER.sub("#", stored) != NUMBER.sub("#", run):
        return f"stored: {stored[:300]}\nrun: {run[:300]}"
    for a, b in zip(NUMBER.findall(stored), NUMBER.findall(run)):
        x, y = float(a), float(b)
        if abs(x - y) > relative * max(abs(x), abs(y)) and max(abs(x), abs(y)) > nothing:
            return f"stored: {a}, run: {b}"
    return ""


def store(path):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    made = iter(outputs_of(notebook))
    count = 0
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            count += 1
            cell["outputs"], cell["execution_count"] = next(made), count
    path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        store(path)
