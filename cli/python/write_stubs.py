"""Writes catalogue.pyi, the types and docstrings of every set, function and operation, from the compiled catalogue."""

import importlib.util

TYPES = {"number": "float", "vector": "Numbers", "matrix": "Numbers", "set": "Set", "function": "Function"}
NOUNS = {"set": "Set", "function": "Function", "operation": "Function"}


def parameters_of(entry):
    made, has_default, by_name = [], False, False
    for name, kind, fallback in entry["parameters"]:
        if kind == "functions":
            made.append(f"*{name}: Function")
            continue
        if not fallback and has_default and not by_name:
            made.append("*")
            by_name = True
        has_default = has_default or bool(fallback)
        made.append(f"{name}: {TYPES[kind]}" + (f" = {fallback}" if fallback else ""))
    return ", ".join(made)


def stub_of(entry):
    text = entry["formula"].replace("\\", "\\\\").replace('"""', "'''")
    return f'def {entry["name"]}({parameters_of(entry)}) -> {NOUNS[entry["kind"]]}:\n    """{text}"""\n'


def write(module_file, folder):
    spec = importlib.util.spec_from_file_location("_moreau", module_file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    entries = module.catalogue()
    text = "from typing import Any\n\nfrom numpy.typing import ArrayLike\n\nfrom . import Function, Set\n\n"
    text += "Numbers = float | ArrayLike\nentries: dict[str, dict[str, Any]]\nbuiltin_names: list[str]\n\n"
    (folder / "catalogue.pyi").write_text(text + "\n".join(stub_of(entry) for entry in entries), encoding="utf-8")
