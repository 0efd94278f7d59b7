"""The motion of a mechanism through impacts and rests."""

import collections
import dataclasses
import math

import numpy as np

from . import _moreau
from .problems import document_of

Event = collections.namedtuple("Event", "t kind constraints velocity_before velocity_after")
Event.__doc__ = """What happens at an instant: kind is 'impact', 'contact', 'release', 'accumulation' or 'branch'."""


@dataclasses.dataclass
class Trajectory:
    """States at k instants: t (k), position, velocity, acceleration (k, n), multipliers (k, m), energy (k); and the
    events on the way. A row at an event holds the state after it."""

    coordinates: list
    constraints: list
    t: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    multipliers: np.ndarray
    energy: np.ndarray
    events: list

    def __getitem__(self, name):
        """The column of a coordinate "x", a velocity "x'", an acceleration "x''" or a multiplier "lambda[floor]"."""
        if name.startswith("lambda[") and name[7:-1] in self.constraints:
            return self.multipliers[:, self.constraints.index(name[7:-1])]
        order = len(name) - len(name.rstrip("'"))
        if order > 2 or name.rstrip("'") not in self.coordinates:
            known = [*self.coordinates, *(f"lambda[{one}]" for one in self.constraints)]
            raise KeyError(f"{name}: no such column; there are {', '.join(known)}, and with ' and '' the derivatives")
        table = (self.position, self.velocity, self.acceleration)[order]
        return table[:, self.coordinates.index(name.rstrip("'"))]


class Motion:
    """The motion of a [system], from its state on: smooth arcs, impacts, rests on contacts (docs/motion.md).

    problem: a file or a dict. set: {"m": 3}. method: "event-driven" or "time-stepping"; tolerance: of a step.
    Raises InvalidInput where the state cannot begin a motion.
    """

    def __init__(self, problem, *, set=None, method=None, tolerance=None, step_limit=None):
        options = {"method": method, "tolerance": tolerance, "step_limit": step_limit}
        options = {key: value for key, value in options.items() if value is not None}
        self._motion = _moreau.FollowedSystem(document_of(problem, set), options)
        self.coordinates, self.constraints = self._motion.coordinates, self._motion.constraints
        self.events = [Event(*event) for event in self._motion.events()]

    def advance(self, until=math.inf):
        """One step on, at most to `until`; False when nothing is left to do. Its events are added to `events`."""
        more = self._motion.advance(until)
        if more:
            self.events += [Event(*event) for event in self._motion.events()]
        return more

    def run(self, until=None, times=None, samples=201):
        """Goes on to `until` (that of [simulate] unless given) and returns the Trajectory at `times`, or at so many
        samples, evenly spaced. Where it ends before, `status` is not 'done' and `why` tells."""
        if until is None:
            until = self._motion.until
        if until is None:
            raise ValueError("until: missing; give it, or write until = 3.0 below [simulate]")
        if isinstance(until, str) or not math.isfinite(until):
            raise ValueError(f"until: {until!r} is no time; give a finite number")
        if not until >= self.t:
            raise ValueError(f"until: {until} is before t = {self.t}; the motion goes forward")
        if times is None:
            times = np.linspace(self.t, until, samples)
        times = np.sort(np.asarray(times, dtype=float)).tolist()
        for time in times[:1] + times[-1:]:
            if not self.t <= time <= until:
                raise ValueError(f"times: {time} is not from t = {self.t} to until = {until}")
        *tables, events = self._motion.run(float(until), times)
        events = [Event(*event) for event in events]
        self.events += events
        return Trajectory(self.coordinates, self.constraints, *tables, events)

    def _right_limit(self, numbers):
        return None if self._motion.acceleration.size == 0 else numbers

    t = property(lambda self: self._motion.t, doc="The time.")
    position = property(lambda self: self._motion.position, doc="q: n numbers.")
    velocity = property(lambda self: self._motion.velocity, doc="q': n numbers.")
    acceleration = property(lambda self: self._right_limit(self._motion.acceleration),
                            doc="q'' to the right of t: n numbers; None where the motion does not go on.")
    multipliers = property(lambda self: self._right_limit(self._motion.multipliers),
                           doc="lambda to the right of t, of all constraints; None where it does not go on.")
    energy = property(lambda self: self._motion.energy, doc="T + V.")
    status = property(lambda self: self._motion.status, doc="'done', 'stopped' or 'infeasible'.")
    why = property(lambda self: self._motion.why, doc="Why it was stopped, or what excludes what.")
    record = property(lambda self: self._motion.record(),
                      doc="Counts and remarks, one of a kind: message, count, the first time t and the last.")

    def __repr__(self):
        return f"Motion(t={self.t:g}, status={self.status!r}, {len(self.events)} events)"
