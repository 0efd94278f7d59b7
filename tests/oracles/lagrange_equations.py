"""Lagrange's equations of a `[system]` problem file, derived by computer algebra (used by expected_values.py).

The expression language is translated to sympy here once more, decimals taken as the fractions they are written as.
"""

import itertools
import re
from fractions import Fraction

import mpmath
import sympy

TOKEN = re.compile(r"\s*(?:(\d+(?:\.(?!\.)\d*)?(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*)|(\.\.|>=|<=|[-+*/^()\[\],'=]))")
FUNCTIONS = {name: getattr(sympy, name) for name in
             "sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt".split()} | {"abs": sympy.Abs}


class Reader:
    """A recursive-descent reader of one text; values are sympy expressions, `indices` binds family indices."""

    def __init__(self, text, scene, indices=None):
        self.scene, self.indices, self.at = scene, dict(indices or {}), 0
        self.tokens, position = [], 0
        while position < len(text.rstrip()):
            match = TOKEN.match(text, position)
            if not match:
                raise ValueError(f"cannot read {text!r} at {position}")
            self.tokens.append(match.group(match.lastindex))
            position = match.end()

    def peek(self):
        """The next token, or None at the end."""
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, *wanted):
        """The next token if it is one of `wanted`, else None."""
        if self.peek() in wanted:
            self.at += 1
            return self.tokens[self.at - 1]
        return None

    def need(self, wanted):
        """Consumes `wanted` or fails."""
        if not self.take(wanted):
            raise ValueError(f"expected {wanted!r} in {' '.join(self.tokens)}")

    def expression(self):
        """Sums and differences."""
        value = self.product()
        while sign := self.take("+", "-"):
            term = self.product()
            value = value + term if sign == "+" else value - term
        return value

    def product(self):
        """Products and quotients."""
        value = self.unary()
        while sign := self.take("*", "/"):
            factor = self.unary()
            value = value * factor if sign == "*" else value / factor
        return value

    def unary(self):
        """Unary minus, which binds less than `^`."""
        return -self.unary() if self.take("-") else self.power()

    def power(self):
        """`^`, grouping to the right, over the postfix total derivative."""
        base = self.atom()
        while self.take("'"):
            base = self.scene.total_derivative(base)
        return base ** self.unary() if self.take("^") else base

    def atom(self):
        """A number, a name, a member of a family, a call, a sum over an index, or parentheses."""
        token = self.tokens[self.at]
        self.at += 1
        if token == "(":
            value = self.expression()
            self.need(")")
            return value
        if token[0].isdigit():
            return sympy.Rational(token)
        if token == "sum":
            return self.sum_over_index()
        if token in FUNCTIONS:
            self.need("(")
            arguments = self.listed(")")
            return FUNCTIONS[token](*arguments)
        if token in self.indices:
            return sympy.Integer(self.indices[token])
        return self.scene.value(token, tuple(int(i) for i in self.listed("]")) if self.take("[") else ())

    def listed(self, closing):
        """Expressions between commas up to `closing`."""
        values = [self.expression()]
        while self.take(","):
            values.append(self.expression())
        self.need(closing)
        return values

    def sum_over_index(self):
        """sum(i in a..b, body), the body read once for every i."""
        self.need("(")
        index, members = self.index_range()
        self.need(",")
        body, total = self.at, sympy.Integer(0)
        outer = dict(self.indices)
        for member in list(members) or [None]:
            self.at, self.indices = body, outer | {index: 0 if member is None else member}
            value = self.expression() if member is not None else self.skip()
            total += value
        self.indices = outer
        self.need(")")
        return total

    def skip(self):
        """Passes over the body of an empty sum; its value is 0."""
        depth = 0
        while depth or self.peek() != ")":
            depth += {"(": 1, ")": -1}.get(self.peek(), 0)
            self.at += 1
        return 0

    def index_range(self):
        """`i in a..b` as the index and its range."""
        index = self.tokens[self.at]
        self.at += 1
        self.need("in")
        first = int(self.expression())
        self.need("..")
        return index, range(first, int(self.expression()) + 1)


class Scene:
    """The data of a `[system]` file: symbols, definitions, forces, constraints and the state."""

    def __init__(self, data):
        system, self.state = data["system"], data["state"]
        self.system, self.t, self.memo = system, sympy.Symbol("t"), {}
        self.parameters, self.families = system.get("parameters", {}), {}
        self.q, self.v, self.definitions = {}, {}, {}
        for text in system["coordinates"]:
            self.declare_coordinate(text)
        self.definitions = self.members(system.get("definitions", {}))

    def declare_coordinate(self, text):
        """Enters a coordinate, or every member of a family `x[1..N,1..M]`, with its velocity."""
        name, _, ranges = text.partition("[")
        spans = [self.span(part) for part in ranges.rstrip("]").split(",")] if ranges else []
        self.families[name] = spans
        for member in itertools.product(*spans):
            label = member_name(name, member)
            self.q[label], self.v[label] = sympy.Symbol(label), sympy.Symbol(label + "'")

    def span(self, text):
        """`a..b` as a range."""
        first, last = text.split("..")
        return range(int(self.read(first)), int(self.read(last)) + 1)

    def read(self, text, indices=None):
        """The value of a number or of an expression's text."""
        if not isinstance(text, str):
            return sympy.Rational(str(text))
        reader = Reader(text, self, indices)
        value = reader.expression()
        if reader.peek() is not None:
            raise ValueError(f"left over in {text!r}: {reader.peek()}")
        return value

    def members(self, table):
        """{member name: (text, indices)} of a table in its order, families spread out, explicit members overriding."""
        found, explicit = {}, set()
        for key, text in table.items():
            name, _, inside = key.partition("[")
            parts = [part.strip() for part in inside.rstrip("]").split(",")] if inside else []
            indices = [re.match(r"([A-Za-z_]\w*)(?:\s+in\s+(.*))?$", part) for part in parts]
            if not all(indices) or not parts:
                label = member_name(name, [int(self.read(part)) for part in parts])
                found[label] = (text, {})
                explicit.add(label)
                continue
            spans = [self.span(index[2]) if index[2] else self.families[name][place]
                     for place, index in enumerate(indices)]
            for member in itertools.product(*spans):
                label = member_name(name, member)
                if label not in explicit:
                    found[label] = (text, {index[1]: number for index, number in zip(indices, member)})
        return found

    def value(self, name, member):
        """What a name stands for: time, pi, a coordinate, a parameter or a definition."""
        label = member_name(name, member)
        if label in ("t", "pi"):
            return self.t if label == "t" else sympy.pi
        if label in self.q:
            return self.q[label]
        if label not in self.memo:
            text, indices = self.definitions[label] if label in self.definitions else (self.parameters[label], {})
            self.memo[label] = self.read(text, indices)
        return self.memo[label]

    def total_derivative(self, value):
        """d/dt along the motion, for an expression in q and t."""
        if value in self.q.values():
            return self.v[str(value)]
        if value.has(*self.v.values()):
            raise ValueError("a second derivative")
        return sum((value.diff(self.q[c]) * self.v[c] for c in self.q), value.diff(self.t))

    def at_state(self):
        """{symbol: exact value} of t, q and q' at the state."""
        values = {self.t: self.read(self.state.get("t", 0))}
        for symbols, table in ((self.q, "position"), (self.v, "velocity")):
            given = self.members(self.state.get(table, {}))
            for label, symbol in symbols.items():
                found = self.read(*given[label]) if label in given or table == "position" else sympy.Integer(0)
                values[symbol] = sympy.sympify(found).xreplace({self.t: values[self.t]})
        return values

    def constraints(self):
        """{name: (f, two_sided)} with f >= 0 or f = 0."""
        found = {}
        ordered = self.members(self.system.get("constraints", {}))
        for name, (text, indices) in ordered.items():
            left, relation, right = re.fullmatch(r"(.*?)(>=|<=|=)(.*)", text).groups()
            difference = self.read(left, indices) - self.read(right, indices)
            found[name] = (-difference if relation == "<=" else difference, relation == "=")
        return found


def member_name(name, member):
    """x, x[3] or x[3,1]."""
    return f"{name}[{','.join(map(str, member))}]" if len(member) else name


def number(value):
    """A sympy number as a Fraction when it is rational, else with 60 digits."""
    value = sympy.expand(value)
    if value.is_Rational:
        return Fraction(int(value.p), int(value.q))
    return mpmath.mpf(str(sympy.N(value, 75)))


def equations(data, contact_tolerance=1e-9):
    """A, z of A q'' = z + U^T lambda and the contacts K with U, s of U q'' >= s, at the state of the file."""
    scene = Scene(data)
    q, v, state = list(scene.q.values()), list(scene.v.values()), scene.at_state()
    value = lambda expression: number(sympy.sympify(expression).xreplace(state))
    kinetic, potential = scene.read(scene.system["kinetic"]), scene.read(scene.system.get("potential", 0))
    forces = scene.members(scene.system.get("forces", {}))
    momentum = [kinetic.diff(w) for w in v]
    A = [[value(p.diff(w)) for w in v] for p in momentum]
    z = []
    for label, x, p in zip(scene.q, q, momentum):
        force = scene.read(*forces[label]) if label in forces else 0
        transport = sum((p.diff(y) * w for y, w in zip(q, v)), p.diff(scene.t))
        z.append(value(force + kinetic.diff(x) - potential.diff(x) - transport))
    names, two_sided, contacts, U, s = [], [], [], [], []
    rounded = {symbol: sympy.Float(float(sympy.N(x, 30)), 17) for symbol, x in state.items()}
    for name, (f, equality) in scene.constraints().items():
        names.append(name)
        rate = scene.total_derivative(sympy.sympify(f))
        here, speed = value(f), value(rate)
        if equality or max(abs(float(here)), abs(float(speed))) <= contact_tolerance:
            if max(abs(float(here)), abs(float(speed))) > 1e-40:
                raise ValueError(f"{name} is {here}, {speed}: meant to be in contact, but not exactly")
            for part in (f, rate):
                if abs(float(part.xreplace(rounded))) > 1e-11:
                    raise ValueError(f"{name} is not in contact in double arithmetic")
            contacts.append(name)
            two_sided.append(equality)
            U.append([value(f.diff(x)) for x in q])
            s.append(-value(sum((rate.diff(x) * w for x, w in zip(q, v)), rate.diff(scene.t))))
        elif here < 0 or (here == 0 and speed < 0):
            raise ValueError(f"{name} is violated: f = {here}, df/dt = {speed}")
    return {"coordinates": list(scene.q), "constraints": names, "contacts": contacts, "two_sided": two_sided,
            "A": A, "z": z, "U": U, "s": s, "scene": scene, "state": state}
