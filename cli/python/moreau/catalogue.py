"""Every set, function and operation of the language (docs/functions.md), made of the one catalogue of the library."""

import builtins
import inspect

from . import _moreau

_NOUNS = {"set": "Set", "function": "Function", "operation": "Function"}


def _text(entry):
    """The docstring of an entry: formula, domain, how its prox is found, source."""
    lines = [entry["formula"], ""]
    if entry["domain"]:
        lines += [f"Finite: {entry['domain']}.", ""]
    for metric, route in zip(("identity", "diagonal", "general"), entry["prox"]):
        if route:
            lines.append(f"Prox in a metric that is {metric}: {route}.")
    if entry["source"]:
        lines += ["", f"Source: {entry['source']}."]
    if entry["examples"]:
        lines += ["", "For example " + ", ".join(entry["examples"]) + "."]
    return "\n".join(lines)


def signature(entry):
    """The signature of an entry. A parameter that has to be given behind one with a default goes by its name."""
    Parameter, made, form = inspect.Parameter, [], inspect.Parameter.POSITIONAL_OR_KEYWORD
    for name, kind, fallback in entry["parameters"]:
        if kind == "functions":
            made.append(Parameter(name, Parameter.VAR_POSITIONAL))
            continue
        if not fallback and any(one.default is not Parameter.empty for one in made):
            form = Parameter.KEYWORD_ONLY
        made.append(Parameter(name, form, default=float(fallback) if fallback else Parameter.empty))
    return inspect.Signature(made)


def _maker(entry):
    name = entry["name"]

    def make(*arguments, **named):
        return _moreau.call(name, *arguments, **named)

    make.__name__ = make.__qualname__ = name
    make.__module__ = "moreau"
    make.__doc__ = _text(entry)
    make.__signature__ = signature(entry)
    return make


entries = {entry["name"]: entry for entry in _moreau.catalogue()}
globals().update({name: _maker(entry) for name, entry in entries.items()})

__all__ = list(entries)
#: What `from moreau import *` leaves alone: sum, max and the like stay Python's.
builtin_names = [name for name in entries if hasattr(builtins, name)]
