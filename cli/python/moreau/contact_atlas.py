"""The atlas of contacts: the forces for which one set of contacts persists (docs/atlas.md)."""

import collections
import fractions
import json
import os

import numpy as np

from . import _moreau
from .functions import axes_of
from .problems import document_of, written

Cell = collections.namedtuple("Cell", "contacts freedom probability error_bound neighbours walls explored")
Cell.__doc__ = """A set of contacts that persists, and its forces.

contacts: names; freedom: the dimension of the face of accelerations; probability, error_bound: of a normal force, None
where nothing was measured; neighbours: indices of cells; walls: indices of atlas["walls"]; explored: are all walls
there?
"""


class Atlas(dict):
    """The polyhedra of forces z on each of which one set of contacts persists, exactly (Robinson 1992).

    A dict with the keys of `moreau atlas --json`; those are attributes too, but `cells`, which holds a Cell each.
    `sum` is that of the probabilities, which are found one by one and never normalised: 1 within `error_sum`.
    """

    def __init__(self, document, options):
        super().__init__(json.loads(_moreau.atlas(document, options)))
        self._document, self._options = document, options
        self.cells = [Cell(tuple(one["contacts"]), one["freedom"], one.get("probability"), one.get("error_bound"),
                           one["neighbours"], one["walls"], one["explored"]) for one in self["cells"]]

    def __getattr__(self, name):
        if name.startswith("_") or name not in self:
            raise AttributeError(f"an atlas has no {name}; it has {', '.join(self)}")
        return self[name]

    def __dir__(self):
        return [*super().__dir__(), *self]

    @property
    def probabilities(self):
        """One a cell; not numbers where nothing was measured."""
        return np.array([np.nan if one.probability is None else one.probability for one in self.cells])

    @property
    def error_bounds(self):
        """One a cell: the true probability is at most so far off."""
        return np.array([np.nan if one.error_bound is None else one.error_bound for one in self.cells])

    @property
    def sum(self):
        return self["probability_sum"]

    def cell(self, *contacts):
        """The Cell on which exactly these contacts persist. KeyError where there is none."""
        for one in self.cells:
            if set(one.contacts) == set(contacts):
                return one
        raise KeyError(f"no cell has exactly the contacts {', '.join(contacts) or 'none'}; see `cells`")

    def cells_at(self, z):
        """The cells that contain the force z, several on their edges: decided in fractions. z: one number per
        coordinate, floats at their exact value, fractions, or a dict by coordinate."""
        names = list(self["here"]["z"]) if self["here"] else None
        if isinstance(z, dict):
            z = [z.get(name, 0) for name in names]
        z = [fractions.Fraction(entry) for entry in np.asarray(z, dtype=object).ravel()]
        found = []
        for k, one in enumerate(self.cells):
            if one.explored and all(self._side(w, z) * (-1 if self["walls"][w]["cells"][0] == k else 1) >= 0
                                    for w in one.walls):
                found.append(one)
        return found

    def _side(self, index, z):
        exact = self["walls"][index]["exact"]
        if len(exact["normal"]) != len(z):
            raise _moreau.InvalidInput(f"z: {len(z)} entries; give {len(exact['normal'])}, one per coordinate")
        return sum(int(a) * b for a, b in zip(exact["normal"], z)) - fractions.Fraction(exact["offset"])

    def plot(self, file):
        """Draws the map over two forces into a file .svg, .png or .pdf."""
        _moreau.atlas(self._document, {**self._options, "plot": os.fspath(file)})

    def __repr__(self):
        if not self.cells:
            return f"Atlas(infeasible: {', '.join(name for name, w in self['farkas'].items() if w)} exclude each other)"
        told = f"{len(self.cells)} cells in {self['dimension']} dimensions, {len(self['walls'])} walls"
        if "probability_sum" in self:
            told += f", probabilities of sum {self['probability_sum']:.9f} within {self['error_sum']:.1e}"
        return f"Atlas({told})"


def atlas(problem=None, /, *, A=None, z=None, U=None, s=None, two_sided=None, mean=None, covariance=None, over=None,
          tolerance=1e-6, cells=None, set=None):
    """The atlas of the contacts of a problem: a file, a dict of the same form, or numbers as in `solve`.

    mean, covariance: of the normal force that cells are measured by, 0 and A unless given; mean="file" is the force z
        of the problem.
    tolerance: of each probability, whose error_bound is proved.
    over: a map over one or two forces, {"x": (-5, 5), "y": (-5, 5)}, added to that of the problem; it is the picture.
    cells: explore so many from the problem's force on, and measure nothing; 50 beyond rank 6.
    Raises InvalidInput when the input is wrong.
    """
    if problem is None:
        if U is None:
            raise TypeError("no contacts; give a file, a dict, or U with A, z and s")
        problem = _projection(A, z, U, s, two_sided)
    elif not (A is None and z is None and U is None and s is None and two_sided is None):
        raise TypeError("A, z, U, s and two_sided: for problems of numbers; a file or dict has its own")
    options = {"tolerance": tolerance, "cells": cells}
    if mean is not None:
        options["mean"] = mean if isinstance(mean, str) else written(mean)
    if covariance is not None:
        options["covariance"] = written(covariance)
    if over is not None:
        options["over"] = [f"force.{name}={low}:{high}" for name, (low, high) in over.items()]
    return Atlas(document_of(problem, set), {key: value for key, value in options.items() if value is not None})


def _projection(A, z, U, s, two_sided):
    rows = U.toarray() if hasattr(U, "toarray") else U
    n = np.shape(rows)[1] if axes_of(rows, "U") == 2 else 0
    if n == 0:
        raise _moreau.InvalidInput("U: not a matrix of contacts; give one row a contact")
    A = np.eye(n) if A is None else A.gram if isinstance(A, _moreau.Metric) else A
    table = {"A": {"diagonal": A} if axes_of(A, "A") == 1 else A, "U": rows, "z": [0] * n if z is None else z,
             "s": [0] * len(rows) if s is None else s}
    return {"projection": table | ({} if two_sided is None else {"two_sided": two_sided})}
