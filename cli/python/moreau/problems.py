"""Problems: from numbers, one or many, from files and from dicts of the same form."""

import fractions
import json
import os
import warnings

import numpy as np

from . import _moreau
from .functions import STATUS, axes_of


class SceneWarning(UserWarning):
    """What the program says on standard error: a state nearly in contact, singular, or not decided."""


class Result(dict):
    """The answer to a problem file, the keys those of docs/problem-files.md; r.status is r["status"].

    Numbers by coordinate or constraint are dicts by name. `text` is what the program prints.
    """

    def __init__(self, document, options):
        text, told = document.json(options)
        super().__init__(json.loads(text))
        self._document, self._options = document, options
        for line in told:
            warnings.warn(line, SceneWarning, stacklevel=3)

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"a {self['kind']} has no {name}; it has {', '.join(self)}") from None

    def __dir__(self):
        return [*super().__dir__(), *self]

    @property
    def text(self):
        return self._document.text(self._options)[0]

    def plot(self, file, plane=None):
        """Draws the picture of `moreau solve --plot` into a file .svg, .png or .pdf. plane: two coordinates, "x,y"."""
        self._document.draw(os.fspath(file), {**self._options, "plane": plane})


class Solutions:
    """The answers to many problems of one size, the first axis their number.

    acceleration (B, n), multipliers (B, m): not numbers where there is none. Multipliers that are not unique are those
    of the rows that the answer rests on; `solve` of that problem alone gives those of least norm.
    status (B): words; error_bound (B); farkas: by number, the weights of what is infeasible.
    """

    def __init__(self, acceleration, multipliers, error_bound, codes, farkas):
        self.acceleration, self.multipliers, self.error_bound = acceleration, multipliers, error_bound
        self.farkas, self._codes = farkas, codes

    @property
    def status(self):
        return STATUS[self._codes]

    @property
    def all_solved(self):
        return not self._codes.any()

    def __len__(self):
        return len(self._codes)

    def __repr__(self):
        counts = ", ".join(f"{np.count_nonzero(self._codes == k)} {name}" for k, name in enumerate(STATUS)
                           if k == 0 or np.any(self._codes == k))
        return f"Solutions({counts}; largest error bound {self.error_bound.max(initial=0):.1e})"


def _plain(value):
    """What JSON has no form for: arrays, numbers of numpy, fractions."""
    if hasattr(value, "toarray"):
        value = value.toarray()
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, fractions.Fraction):
        return str(value)
    raise TypeError(f"a problem cannot hold a {type(value).__name__}; give numbers, texts, lists, dicts or arrays")


def written(numbers):
    """A vector or matrix as the command line has it: "[1.5, 1/3]"."""
    if np.ndim(numbers) == 0:
        return str(numbers.item() if isinstance(numbers, np.generic) else numbers)
    return "[" + ", ".join(written(entry) for entry in numbers) + "]"


def document_of(problem, settings):
    """The document of a path or a dict. settings: {"m": 3, "position.x": 0.2}."""
    if settings is not None and not isinstance(settings, dict):
        raise _moreau.InvalidInput(f"set: a {type(settings).__name__}; give a dict, such as {{\"m\": 3}}")
    given = [f"{key}={value}" for key, value in (settings or {}).items()]
    if not isinstance(problem, (dict, str, os.PathLike)):
        raise _moreau.InvalidInput(f"a {type(problem).__name__} is no problem; give a file, a dict, or A=, z=, U=, s=")
    if isinstance(problem, dict):
        return _moreau.Document(json.dumps(problem, default=_plain), True, given, "dict")
    return _moreau.Document(os.fspath(problem), False, given, "")


def solve(problem=None, /, *, A=None, z=None, U=None, s=None, two_sided=None, method=None, tolerance=None, set=None,
          **options):
    """Solves a problem: of numbers, of a file, or of a dict of the same form.

    solve(A=, z=, U=, s=): q'' that minimises 1/2 q''.A q'' - z.q'' over U q'' >= s (Moreau 1966, (10)).
        A: n by n, symmetric positive definite (numpy or scipy.sparse), its diagonal, a Metric, or None for the
        identity; z: n; U: m by n; s: m, 0 unless given; two_sided: rows held with equality.
        With z (B, n), s (B, m), U (B, m, n) or A (B, n, n) it solves B problems, on all processors, and returns
        Solutions; else a Solution.
    solve("scene.toml"), solve({"system": ...}): a Result. set: what the file says, said otherwise, {"m": 3}.
        options: certify, sensitivity, ranges, null_space, plane, probes, onset, as those of `moreau solve`.

    method: a name of methods(). tolerance: of the error bound, relative, 1e-9 unless given.
    Raises InvalidInput when the input is wrong. What has no solution has the status 'infeasible', with weights that
    prove it.
    """
    if problem is None:
        if options or set:
            raise TypeError(f"{', '.join(options) or 'set'}: for files and dicts; numbers take method and tolerance")
        if z is None and A is None and U is None and s is None and two_sided is None:
            raise TypeError("nothing to solve; give a file, a dict, or A, z, U and s")
        if z is None:
            raise TypeError("z is missing; give it, one number per coordinate")
        accuracy = 1e-9 if tolerance is None else tolerance
        if _is_batch(A, z, U, s):
            return Solutions(*_moreau.solve_batch(A, z, U, s, two_sided, method, accuracy))
        return _moreau.solve_numbers(A, z, U, s, two_sided, method, accuracy)
    if not (A is None and z is None and U is None and s is None and two_sided is None):
        raise TypeError("A, z, U, s and two_sided: for problems of numbers; a file or dict has its own")
    options |= {"method": method, "tolerance": tolerance}
    return Result(document_of(problem, set), options)


def _is_batch(A, z, U, s):
    if type(z) is np.ndarray and z.ndim == 1 and type(s) is np.ndarray and s.ndim == 1:
        if type(U) is np.ndarray and U.ndim == 2 and type(A) is np.ndarray and A.ndim <= 2:
            return False
    axes = {name: 0 if x is None or isinstance(x, _moreau.Metric) or hasattr(x, "tocsr") else axes_of(x, name)
            for name, x in (("A", A), ("z", z), ("U", U), ("s", s))}
    return axes["z"] == 2 or axes["s"] == 2 or axes["U"] == 3 or axes["A"] == 3
