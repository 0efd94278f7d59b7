"""Proxes to 40 digits by mpmath (its own roots and functions), for tests/convex/proved_prox/proved_split.cpp.

Each line: the call, the diagonal of the metric, z, prox_f z. `python3 tests/oracles/proved_proxes.py`
"""
from mpmath import findroot, log, exp, mp, mpf, sqrt, lambertw

mp.dps = 50
H = mpf(1) / 2


def show(call, d, z, x):
    def row(v):
        return "{" + ", ".join(v) + "}"

    print('{"%s", %s, %s, %s},' % (call, row([repr(float(a)) for a in d]), row([repr(float(a)) for a in z]),
                                  row(['"%s"' % mp.nstr(a, 40) for a in x])))


def separable(call, slope, d, z, start):
    show(call, d, z, [findroot(lambda x: w * (x - t) + slope(x), s) for w, t, s in zip(d, z, start)])


d, z = [1, 2, H], [mpf(5) / 4, -mpf(3) / 4, mpf(17) / 8]
separable("entropy()", lambda x: log(x) + 1, d, z, [0.5, 0.1, 0.9])
separable("logistic()", lambda x: 1 / (1 + exp(-x)), d, z, z)
separable("exponential()", exp, d, z, [0, -1, 0])
separable("log_barrier()", lambda x: -1 / x, d, z, [1.8, 0.5, 2.8])
separable("power(1.5)", lambda x: mpf(3) / 2 * (sqrt(x) if x > 0 else -sqrt(-x)), d, z, [0.4, -0.4, 0.5])
separable("inverse_power(2)", lambda x: -2 / x**3, d, z, [1.6, 0.8, 2.2])
separable("binary_entropy()", lambda x: log(x / (1 - x)), d, z, [0.6, 0.3, 0.7])
separable("kullback_leibler(2)", lambda x: log(x / 2), d, z, [1.5, 0.5, 2])


def along(mu):
    return [w * t / (w + mu) for w, t in zip(d, z)]


def norm(x):
    return sqrt(sum(a * a for a in x))


def softmax(x):
    total = sum(exp(a) for a in x)
    return [exp(a) / total for a in x]


show("log_sum_exp()", d, z,
     list(findroot(lambda *x: [w * (a - t) + s for w, a, t, s in zip(d, x, z, softmax(x))], (1, -0.8, 1))))
mu = findroot(lambda m: m * norm(along(m)) - 1, 1)  # mu x = x/|x|
show("norm2()", d, z, along(mu))
mu = findroot(lambda m: norm(along(m)) - 1, 1)
show("indicator(ball2())", d, z, along(mu))
# The exponential cone, identity: x = (r y, y, y e^r), z - x = s (e^r, e^r (1 - r), -1).
z = [mpf(1) / 2, mpf(5) / 4, mpf(3) / 8]
r, y, s = findroot(lambda r, y, s: (r * y + s * exp(r) - z[0], y + s * exp(r) * (1 - r) - z[1],
                                    y * exp(r) - s - z[2]), (0.1, 1, 0.5))
show("indicator(exponential_cone())", [1, 1, 1], z, [r * y, y, y * exp(r)])
