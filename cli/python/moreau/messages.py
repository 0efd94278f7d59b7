"""Wrong arguments of what is compiled, told in the module's own words."""

import functools

from . import _moreau
from ._moreau import InvalidInput

_TAKES = {
    (_moreau.Function, "__call__"): "f(x, W=None)",
    (_moreau.Function, "conjugate"): "conjugate(W=None)",
    (_moreau.Set, "__contains__"): "x in set, x a vector",
    (_moreau.Metric, "__init__"): "Metric(W), W a matrix or a diagonal",
    (_moreau.Metric, "multiply"): "multiply(x)",
    (_moreau.Metric, "solve"): "solve(c)",
    (_moreau.Metric, "inner"): "inner(x, y)",
    (_moreau.Metric, "norm"): "norm(x)",
    (_moreau.Subdifferential, "__contains__"): "v in subdifferential, v a vector",
    (_moreau.Subdifferential, "support"): "support(d)",
    (_moreau.Subdifferential, "projection"): "projection(u, V=None)",
    (_moreau.Subdifferential, "critical_cone"): "critical_cone(v)",
}


def own_words(call, takes):
    """The same call; where its arguments do not fit at all it says what it takes."""

    @functools.wraps(call)
    def told(*arguments, **named):
        try:
            return call(*arguments, **named)
        except TypeError as error:
            if "incompatible" not in str(error):
                raise
        given = [type(one).__name__ for one in arguments[1:]] + [f"{key}=" for key in named]
        raise InvalidInput(f"it takes {takes}; it was given ({', '.join(given)})")

    return told


def attach():
    for (owner, name), takes in _TAKES.items():
        setattr(owner, name, own_words(getattr(owner, name), takes))
