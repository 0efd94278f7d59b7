"""What a notebook shows of results."""

import html
import os
import tempfile

import numpy as np

from . import _moreau
from .contact_atlas import Atlas
from .motion import Motion
from .problems import Result, Solutions

_MOST_ROWS = 40


def _number(x):
    return x if isinstance(x, str) else "-" if x is None else f"{x:.6g}"


def _table(heading, rows):
    cells = lambda row, tag: "<tr>" + "".join(f"<{tag}>{html.escape(_number(cell))}</{tag}>" for cell in row) + "</tr>"
    more = f"<p>... and {len(rows) - _MOST_ROWS} more rows</p>" if len(rows) > _MOST_ROWS else ""
    return "<table>" + cells(heading, "th") + "".join(cells(row, "td") for row in rows[:_MOST_ROWS]) + f"</table>{more}"


def _svg_of(draw):
    """What `draw` writes into a file; None where there is no picture, or no gnuplot."""
    if not _moreau.can_draw():
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "picture.svg")
        try:
            draw(file)
        except _moreau.InvalidInput:  # one coordinate, no answer: nothing to draw
            return None
        with open(file, encoding="utf-8") as stream:
            return stream.read()


def _result_html(result):
    if "acceleration" not in result:
        return f"<pre>{html.escape(result.text)}</pre>"
    bound = result["certificate"]["error_bound"]
    told = f"<p>{result['status']}: error of the acceleration at most {_number(bound)} ({result['certificate']['level']})</p>"
    states = result["constraints"]
    contacts = [(name, states[name]["state"], states[name]["ddf"], result["multipliers"][name]) for name in states]
    motions = [(name, q, result["reaction"][name]) for name, q in result["acceleration"].items()]
    return (told + _table(("constraint", "state", "d\u00b2f/dt\u00b2", "\u03bb"), contacts)
            + _table(("coordinate", "acceleration", "reaction"), motions))


def _solution_html(solution):
    if solution.status == "infeasible":
        return f"<p>infeasible; Farkas weights {html.escape(np.array2string(solution.farkas))}</p>"
    told = f"<p>{solution.status}: error of q'' at most about {solution.error_bound:.1e}</p>"
    active = solution.active
    rows = [(f"c[{a}]", "persists" if a in active else "opens", slack, multiplier)
            for a, (slack, multiplier) in enumerate(zip(solution.slack, solution.multipliers))]
    motions = [(f"q[{i}]", *pair) for i, pair in enumerate(zip(solution.acceleration, solution.reaction))]
    return told + _table(("row", "state", "u.q'' - s", "\u03bb"), rows) + _table(("", "q''", "R"), motions)


def _split_html(split):
    rows = [(f"[{i}]", *row) for i, row in enumerate(zip(split.z, split.x, split.y))]
    told = (f"<p>{split.status}: error of x and of y at most {split.error_bound:.1e}; f(x) + g(y) - (x|y) = "
            f"{split.fenchel_gap:.1e}</p>")
    return f"<p><code>{html.escape(split.f)}</code></p>{told}" + _table(("", "z", "x = prox_f z", "y = prox_g z"), rows)


def _split_svg(split):
    """z = x + y in the plane of two entries, drawn as arrows: z wide, so that it is seen under x and y; what is 0 as a dot."""
    if len(split.z) != 2:
        return None
    z, x, none = np.asarray(split.z, dtype=float), np.asarray(split.x, dtype=float), np.zeros(2)
    points = np.array([none, z, x])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = 240 / max(float((high - low).max()), 1e-300)
    at = lambda p: 150 + scale * (p - (low + high) / 2) * [1, -1]
    are_all_none = not (np.any(z) or np.any(x))
    outside = 1 if z[0] * x[1] >= z[1] * x[0] else -1  # x and y are on this side of z, and their names beyond them
    lines, tips = [], []
    for name, begin, end, colour, width, side in (("z", none, z, "#aaaaaa", 6, -outside), ("x", none, x, "#1b6ca8", 2, outside),
                                                  ("y", x, z, "#c0392b", 2, outside)):
        a, b = at(begin), at(end)
        is_dot = np.hypot(*(b - a)) < 1
        way = at(z) - at(none) if is_dot else b - a
        across = np.array([way[1], -way[0]]) / np.hypot(*way) if np.hypot(*way) > 0 else np.array([0, -1])
        text = (a + b) / 2 + (15 + width / 2) * side * across
        if is_dot:
            lines.append(f'<circle cx="{a[0]:.1f}" cy="{a[1]:.1f}" r="{2 + width / 2}" fill="{colour}"/>')
        else:
            lines.append(f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{colour}" '
                         f'stroke-width="{width}" marker-end="url(#tip_{name})"/>')
        tips.append(f'<marker id="tip_{name}" markerUnits="userSpaceOnUse" markerWidth="{8 + 2 * width}" '
                    f'markerHeight="{8 + 2 * width}" viewBox="0 0 8 8" refX="7" refY="4" orient="auto">'
                    f'<path d="M0,1 L8,4 L0,7 z" fill="{colour}"/></marker>')
        if are_all_none and name != "z":
            continue  # one dot, with one name
        named = "z = x = y = 0" if are_all_none else name if np.any(end - begin) else f"{name} = 0"
        lines.append(f'<text x="{text[0]:.1f}" y="{text[1] + 5:.1f}" text-anchor="middle" '
                     f'fill="{"#555555" if name == "z" else colour}">{named}</text>')
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="300" height="300" font-family="Helvetica" font-size="14">'
            f'<defs>{"".join(tips)}</defs>{"".join(lines)}</svg>')


def _solution_repr(solution):
    if solution.status == "infeasible":
        return f"Solution(status='infeasible', farkas={solution.farkas})"
    return (f"Solution(status={solution.status!r}, acceleration={solution.acceleration}, active={solution.active}, "
            f"error_bound={solution.error_bound:.1e})")


def _solution_result(solution):
    """The answer in full, as `moreau solve` gives it of a [projection]: a Result."""
    return Result(_moreau.document_of(solution), {"method": solution.method})


def _table_and_picture(result):
    """For IPython: of a table and a picture in one answer a notebook shows the table alone, so they are two."""
    from IPython.display import display
    display({"text/plain": repr(result), "text/html": result._repr_html_()}, raw=True)
    if (picture := result._repr_svg_()) is not None:
        display({"text/plain": "the picture", "image/svg+xml": picture}, raw=True)


def attach():
    """Gives the results their looks in a notebook."""
    solution, split, report = _moreau.Solution, _moreau.Decomposition, _moreau.LawReport
    solution.__repr__, solution._repr_html_ = _solution_repr, _solution_html
    solution._repr_svg_ = lambda self: _svg_of(lambda file: _moreau.document_of(self).draw(file, {}))
    solution.result = property(_solution_result)
    split.__repr__ = lambda self: f"Decomposition(f={self.f!r}, x={self.x}, y={self.y}, status={self.status!r})"
    split._repr_html_, split._repr_svg_ = _split_html, _split_svg
    report._repr_html_ = lambda self: f"<pre>{html.escape(repr(self))}</pre>"
    Result._repr_html_ = _result_html
    Result._repr_svg_ = lambda self: _svg_of(lambda file: self._document.draw(file, self._options))
    Solutions._repr_html_ = lambda self: f"<p>{html.escape(repr(self))}</p>"
    Motion._repr_html_ = _motion_html
    Atlas._repr_html_ = _atlas_html
    Atlas._repr_svg_ = lambda self: _svg_of(self.plot)
    for drawn in (solution, split, Result, Atlas):
        drawn._ipython_display_ = _table_and_picture
    _moreau.Subdifferential._repr_html_ = lambda self: f"<pre>{html.escape(repr(self))}</pre>"


def _motion_html(motion):
    rows = [(event.t, event.kind, ", ".join(event.constraints)) for event in motion.events]
    return f"<p>{html.escape(repr(motion))}</p>" + _table(("t", "event", "constraints"), rows)


def _atlas_html(atlas):
    rows = [(", ".join(one.contacts) or "none", one.freedom, len(one.walls), one.probability, one.error_bound)
            for one in atlas.cells]
    heading = ("contacts that persist", "freedom", "walls", "probability", "error at most")
    return f"<p>{html.escape(repr(atlas))}</p>" + _table(heading, rows)
