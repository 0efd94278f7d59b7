"""Scenes whose two-sided gradients depend on each other at the state only (used by expected_values.py).

The third total derivative of every constraint is differentiated out by computer algebra, with symbols for q'' and q''';
combinations of constraints whose gradients cancel leave linear equations in q''.
"""

import sympy


def third_derivatives(given):
    """d^3 f/dt^3 at the state for every constraint, in the symbols of q'' and q''', which are returned as well."""
    scene, state = given["scene"], given["state"]
    q, v = list(scene.q.values()), list(scene.v.values())
    a = [sympy.Symbol(f"{x}''") for x in q]
    j = [sympy.Symbol(f"{x}'''") for x in q]

    def rate(value):
        chain = sum(value.diff(x) * y for x, y in zip(q + v + a, v + a + j))
        return chain + value.diff(scene.t)

    found = {name: sympy.expand(rate(rate(rate(sympy.sympify(f)))).xreplace(state))
             for name, (f, two_sided) in scene.constraints().items() if two_sided}
    return found, a, j


def added_rows(given, null_vectors, number):
    """[(weights, row, rhs)]: for every w with w.U = 0 over the two-sided rows the equation row.q'' = rhs."""
    third, a, j = third_derivatives(given)
    rows = []
    for weights in null_vectors:
        equation = sympy.expand(sum(w * third[name] for name, w in weights.items()))
        if any(equation.diff(x) != 0 for x in j):
            raise ValueError("q''' does not drop out")
        row = [equation.diff(x) for x in a]
        if any(entry.diff(x) != 0 for entry in row for x in a):
            raise ValueError("not linear in q''")
        rows.append((weights, [number(entry) for entry in row], -number(equation.xreplace({x: 0 for x in a}))))
    return rows
