"""The expected events of docs/problems/motion_*.toml by closed forms, 40 digits, without the product; written to
tests/cases/*.expected.json. The source of each form stands in the problem file."""
import json
from pathlib import Path

from mpmath import acos, asin, atan, cos, ellipf, ellipk, findroot, mp, mpf, nstr, pi, quad, sin, sqrt

mp.dps = 50
ROOT = Path(__file__).resolve().parents[2]
g = mpf("9.81")


def event(kind, t, constraints, **velocity):
    found = {"kind": kind, "t": nstr(t, 40), "constraints": constraints}
    if velocity:
        found["velocity_after"] = {name: nstr(v, 40) for name, v in velocity.items()}
    return found


def ball():
    e, t, v, events = mpf("0.9"), sqrt(2 / g), sqrt(2 * g), []
    for k in range(100):
        events.append(event("impact", t, ["floor"], y=v * e ** (k + 1)))
        t += 2 * v * e ** (k + 1) / g
    events.append(event("accumulation", sqrt(2 / g) * (1 + e) / (1 - e), ["floor"], y=0))
    return events


def oscillator():
    e, t, v, events = mpf("0.8"), asin(mpf(1) / 2), sqrt(mpf(3)) / 2, []
    for _ in range(5):
        events.append(event("impact", t, ["stop"], x=-e * v))
        t += 2 * (pi - atan(2 * e * v))
        v *= e
    return events


def pendulum():
    """Time from rest at the angle `start` to -0.3, and back there after an impact at speed v."""
    e = mpf("0.7")

    def fall(start, end):
        k = sin(start / 2)
        return (ellipk(k ** 2) - ellipf(asin(sin(end / 2) / k), k ** 2)) / sqrt(g)

    first = fall(mpf(1), mpf("-0.3"))
    v = sqrt(2 * g * (cos(mpf("0.3")) - cos(mpf(1))))
    top = acos(cos(mpf("0.3")) - (e * v) ** 2 / (2 * g))
    return [event("impact", first, ["stop"], a=e * v),
            event("impact", first + 2 * fall(top, mpf("-0.3")), ["stop"], a=e * e * v)]


def ladder():
    start = mpf("1.2")
    end = asin(2 * sin(start) / 3)
    # a' = -root(3 g/(2 h) (sin a_0 - sin a)); a = a_0 - u^2 takes the root at a_0 out
    t = quad(lambda u: 2 * u / sqrt(3 * g / 2 * cos(start - u * u / 2) * sin(u * u / 2)), [0, sqrt(start - end)])
    rate = -sqrt(3 * g / 4 * sin(start) / 3)
    return [event("release", t, ["wall"], x=-2 * sin(end) * rate, y=2 * cos(end) * rate, a=rate)]


def cylinder():
    start = mpf("0.1")
    end = acos(2 * cos(start) / 3)
    t = quad(lambda u: 2 * u / sqrt(2 * g * sin(start + u * u / 2) * sin(u * u / 2)), [0, sqrt(end - start)])
    v = 2 * sqrt(g * (cos(start) - cos(end)))
    return [event("release", t, ["cylinder"], x=v * cos(end), y=-v * sin(end))]


def shaken_table():
    A, w = mpf("0.1"), mpf(12)
    t0 = asin(g / (A * w ** 2)) / w
    y = lambda t: A * sin(w * t0) + A * w * cos(w * t0) * (t - t0) - g / 2 * (t - t0) ** 2
    t1 = findroot(lambda t: y(t) - A * sin(w * t), 0.35)
    return [event("release", t0, ["table"], y=A * w * cos(w * t0)),
            event("impact", t1, ["table"], y=A * w * cos(w * t1))]


def impact_pair():
    e, w, d, A = mpf("0.7"), 2 * pi, mpf(1), mpf(1)
    k = 2 / pi * (1 - e) / (1 + e)
    tau = atan(k) + acos(-(k * d / A) / sqrt(1 + k * k))
    v = 2 * w * (A * sin(tau) + d) / pi
    return [event("impact", tau / w + mpf(1) / 2, ["mesh_lower"], x=v),
            event("impact", tau / w + 1, ["mesh_upper"], x=-v),
            event("impact", tau / w + mpf(3) / 2, ["mesh_lower"], x=v)]


def rocking_block():
    """The centre moves up and down only: (Y'(a)^2 + I) a'^2/2 + g Y(a) is kept between impacts, with
    Y(a) = h cos a + b sin a = R cos(a - f)."""
    b, h, top = mpf("0.2"), mpf(1), mpf("0.1")
    inertia, R, f = (b * b + h * h) / 3, sqrt(b * b + h * h), atan(b / h)
    ratio = (h * h - 2 * b * b) / (h * h + 4 * b * b)

    def fall(start):
        """From rest at the lean `start` to 0; a = start - u^2 takes the root at the start out."""
        height = lambda x: 2 * R * sin(f - start + x / 2) * sin(x / 2)
        mass = lambda x: inertia + (R * sin(f - start + x)) ** 2
        return quad(lambda u: 2 * u * sqrt(mass(u * u) / (2 * g * height(u * u))), [0, sqrt(start)])

    events, t, sides = [], fall(top), ["right", "left"]
    rate = -sqrt(2 * g * (R * cos(top - f) - h) / (inertia + b * b))
    for k in range(4):
        rate *= ratio
        events.append(event("impact", t, [sides[k % 2]], x=0, y=abs(rate) * b, a=rate))
        top = f - acos((h + (inertia + b * b) * rate ** 2 / (2 * g)) / R)
        t += 2 * fall(top)
        rate = -rate
    return events


def cradle():
    return [event("impact", mpf(2), ["gap[1]", "gap[2]", "gap[3]", "gap[4]"], **{f"x[{i}]": mpf(i == 5) for i in range(1, 6)})]


def gear_rattle():
    """Wheels as parabolas between impacts of one contact each; the first 18 impacts."""
    Jb, Jc, A, w, i, D = map(mpf, "0.02 0.05 0.3 20 1.5 0.4".split())
    t, b, c, vb, vc, events = mpf(0), mpf(0), mpf(0), mpf(1), mpf(2), []
    at = lambda x, v, J, tau: x + v * tau - D / J * tau ** 2 / 2
    while len(events) < 18:
        play = {"first_lower": lambda s: at(b, vb, Jb, s) - A * sin(w * (t + s)) + mpf("0.01"),
                "first_upper": lambda s: A * sin(w * (t + s)) - at(b, vb, Jb, s) + mpf("0.01"),
                "second_lower": lambda s: at(b, vb, Jb, s) - i * at(c, vc, Jc, s) + mpf("0.02"),
                "second_upper": lambda s: i * at(c, vc, Jc, s) - at(b, vb, Jb, s) + mpf("0.02")}
        step, s, hit = mpf("1e-5"), mpf("1e-5"), None
        while hit is None:
            hit = next((name for name, f in play.items() if f(s) < 0), None)
            s += step
        s = findroot(play[hit], (s - 2 * step, s - step), solver="anderson")
        b, c, vb, vc, t = at(b, vb, Jb, s), at(c, vc, Jc, s), vb - D / Jb * s, vc - D / Jc * s, t + s
        if hit.startswith("first"):  # the shaft does not feel it
            wall = A * w * cos(w * t)
            vb = wall - mpf("0.6") * (vb - wall)
        else:
            impulse = -(1 + mpf("0.8")) * (vb - i * vc) / (1 / Jb + i * i / Jc)
            vb, vc = vb + impulse / Jb, vc - i * impulse / Jc
        events.append(event("impact", t, [hit], b=vb, c=vc))
    return events


def slider_crank():
    """The slider stays straight, and the guide acts on its centre: two coordinates, by the midpoint rule with ten
    extrapolations (Gragg 1965), 30 digits."""
    l1, l2, play, m1, m2, m3, J1, J2, e = map(mpf, "0.153 0.306 0.001 0.038 0.038 0.076 7.4e-5 5.9e-4 0.4".split())
    a, b, k = (m1 / 4 + m2 + m3) * l1 ** 2 + J1, (m2 / 4 + m3) * l2 ** 2 + J2, (m2 / 2 + m3) * l1 * l2
    V1, V2 = g * (m1 / 2 + m2 + m3) * l1, g * (m2 / 2 + m3) * l2

    def solve(p, q, r1, r2):
        C = k * cos(p - q)
        return (b * r1 - C * r2) / (a * b - C * C), (a * r2 - C * r1) / (a * b - C * C)

    def rate(y):
        S = k * sin(y[0] - y[1])
        return [y[2], y[3], *solve(y[0], y[1], -S * y[3] ** 2 - V1 * cos(y[0]), S * y[2] ** 2 - V2 * cos(y[1]))]

    def flow(y, H, levels=10):
        rows = []
        for j in range(levels):
            n, h = 2 * (j + 1), H / (2 * (j + 1))
            last, now = y, [u + h * x for u, x in zip(y, rate(y))]
            for _ in range(n - 1):
                last, now = now, [u + 2 * h * x for u, x in zip(last, rate(now))]
            row = [[(u + v + h * x) / 2 for u, v, x in zip(now, last, rate(now))]]
            for m in range(1, j + 1):
                square = (mpf(n) / (2 * (j - m + 1))) ** 2
                row.append([x + (x - z) / (square - 1) for x, z in zip(row[-1], rows[-1][m - 1])])
            rows.append(row)
        return rows[-1][-1]

    height = lambda y: l1 * sin(y[0]) + l2 * sin(y[1])
    t, y, events, H = mpf(0), [mpf(0), mpf(0), mpf(150), mpf(-75)], [], mpf("1e-4")
    while len(events) < 8:
        s = H
        while abs(height(flow(y, s))) < play:
            y, t = flow(y, s), t + s
        side = 1 if height(flow(y, s)) > 0 else -1
        s = findroot(lambda s: height(flow(y, s)) - side * play, (s / 2, s), tol=mpf(10) ** -60, verify=False)
        y, t = flow(y, s), t + s
        u = (-side * l1 * cos(y[0]), -side * l2 * cos(y[1]))
        way = solve(y[0], y[1], *u)
        impulse = -(1 + e) * (u[0] * y[2] + u[1] * y[3]) / (u[0] * way[0] + u[1] * way[1])
        y = [y[0], y[1], y[2] + impulse * way[0], y[3] + impulse * way[1]]
        corners = ["corner1", "corner2"] if side > 0 else ["corner3", "corner4"]
        events.append(event("impact", t, corners, p1=y[2], p2=y[3], p3=mpf(0)))
    return events


CASES = {"gear_rattle": gear_rattle, "slider_crank": slider_crank, "cradle": cradle, "ball": ball, "oscillator_stop": oscillator, "pendulum_stop": pendulum, "ladder": ladder,
         "cylinder": cylinder, "shaken_table": shaken_table, "impact_pair": impact_pair,
         "rocking_block": rocking_block}

if __name__ == "__main__":
    for name, events in CASES.items():
        target = ROOT / "tests" / "cases" / f"motion_{name}.expected.json"
        target.write_text(json.dumps({"kind": "motion", "events": events()}, indent=1) + "\n")
        print(target.relative_to(ROOT))
