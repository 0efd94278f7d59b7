#include "cli/manual/starting_files.hpp"

namespace cli::inline manual {
namespace {

constexpr std::string_view system_file =
    R"text(# A ladder against a smooth wall, held by a rope at its foot. Change it to what you have, then
#   moreau solve FILE       which contacts persist, with which acceleration and which forces
#   moreau explain FILE     why
#   moreau help system      what may stand in a file like this
title = "A ladder at a wall"

[system]
coordinates = ["x", "y", "a"]              # q: centre of the ladder (m), its angle with the floor (rad)
kinetic     = "m/2*(x'^2 + y'^2) + m*L^2/24*a'^2"   # T(q, q', t); x' is a velocity
potential   = "m*g*y"                      # V(q, t)

[system.parameters]                        # numbers, or expressions in other parameters
m = 10.0                                   # kg
L = 4.0                                    # m
g = 9.81
F = 20.0                                   # N, in the rope

[system.forces]                            # Q by coordinate; what is missing is 0
x = "-F"
a = "F*L/2*sin(a)"                         # the rope pulls at the foot

[system.constraints]                       # one relation each: >= and <= are one-sided, = is two-sided
floor = "y - L/2*sin(a) >= 0"
wall  = "x - L/2*cos(a) >= 0"

[state]                                    # where, and how fast
position = { x = "L/2*cos(a)", y = "L/2*sin(a)", a = 1.1 }
velocity = { x = 0.0, y = 0.0, a = 0.0 }

[draw]                                     # shown by `moreau solve --plot F.svg FILE`
segments = { ladder = [["x - L/2*cos(a)", "y + L/2*sin(a)"], ["x + L/2*cos(a)", "y - L/2*sin(a)"]] }
)text";

constexpr std::string_view projection_file =
    R"text(# Minimise 1/2 q.A q - z.q over all q with U q >= s: the point of a polyhedron that is nearest to A^-1 z in
# the norm of A. Numbers may be exact, "1/3".
#   moreau solve FILE            the point, the multipliers, an error bound
#   moreau solve --certify FILE  the same with a proved bound
title = "Two rows in the plane"

[projection]
A = [[2, 0], [0, 1]]      # symmetric positive definite; or { diagonal = [2, 1] }, { matrix_market = "A.mtx" }
z = [1, -9.81]
U = [[0, 1], [1, 1]]      # a row a constraint; or { matrix_market = "U.mtx" }
s = [0, "1/2"]
two_sided = []            # rows, from 0, that hold with equality
)text";

constexpr std::string_view decomposition_file =
    R"text(# The split z = x + y of a point, x = prox_f z and y the prox of the conjugate of f.
#   moreau solve FILE       x, y, f(x), and the conjugate's value at y
#   moreau functions        what may stand in f
title = "A point split by a norm"

[decomposition]
z = [3.0, -1.0, "1/2"]
f = "norm1(weight=1)"
metric = [[2, 1, 0], [1, 2, 0], [0, 0, 1]]   # W of the product x.Wy; leave the line out for the identity
)text";

constexpr std::string_view cone_file =
    R"text(# A cone by its generators, its polar, and a point split between the two; in fractions, so nothing is rounded.
#   moreau solve FILE       facets, extreme rays, the polar, the nearest points
title = "A cone of three rays"

[cone]
generators = [[1, 0, 0], [0, 1, 0], [1, 1, 1]]   # or halfspaces = [...]: a.x <= 0 for each row a
lines = []                                       # rows taken both ways
z = [1, 2, -3]                                   # leave it out for the descriptions alone
)text";

constexpr std::string_view motion_file =
    R"text(# A ball in the plane that falls on a floor and bounces off a wall.
#   moreau simulate FILE                        the motion in short
#   moreau simulate --animate F.html FILE       a page that plays it
#   moreau simulate --output F.csv --plot F.svg FILE
title = "A ball, a floor and a wall"

[system]
coordinates = ["x", "y"]                   # m
kinetic     = "m/2*(x'^2 + y'^2)"
potential   = "m*g*y"

[system.parameters]
m = 0.5                                    # kg
g = 9.81
r = 0.1                                    # m, of the ball

[system.constraints]
floor = "y >= r"
wall  = "x <= 2 - r"

[state]
position = { x = 0.0, y = 1.0 }
velocity = { x = 2.0 }

[simulate]
until = 3.0                                # s
restitution = { floor = 0.8, wall = 0.5 }  # or one number for all

[draw]
circles = { ball = { centre = ["x", "y"], radius = "r" } }
segments = { ground = [["-0.2", "0"], ["2", "0"]], wall = [["2", "0"], ["2", "1.2"]] }
)text";

constexpr std::string_view liquid_file =
    R"text(# Where a liquid parts: a vessel that spins, seen from above, its rim at a given pressure.
#   moreau solve FILE                  whether it parts, where, and the pressure
#   moreau solve --plot F.svg FILE
#   moreau solve --onset w FILE        from which speed on
title = "A disc of liquid that spins"

[liquid]
coordinates = ["x", "y"]
domain   = "disc(center=[0, 0], radius=1)" # or box, ball, interval, polygon, "{x^2 + 4*y^2 <= 1}"
density  = "rho"
velocity = ["-w*y", "w*x"]                 # now, by coordinate
free  = { rim = { where = "true", pressure = "p0" } }
# walls = { bed = { where = "y <= 0", acceleration = 0 } }

[liquid.parameters]
w   = 3.0
rho = 1.0
p0  = 3.0
)text";

constexpr std::string_view looseness_file =
    R"text(# A gear driven to and fro by another one, with play between their teeth.
#   moreau simulate FILE               which flank hammers, and when
#   moreau orbit FILE --period "2*pi/w"   a motion that comes back to itself
title = "A gear with backlash"

[system]
coordinates = ["b"]                        # rad, of the driven gear
kinetic     = "J/2*b'^2"

[system.parameters]
J = 0.02                                   # kg m^2
A = 0.1                                    # rad, of the driving gear
w = 20.0                                   # 1/s
D = 0.05                                   # N m s, drag

[system.forces]
b = "-D*b'"

[system.looseness]                         # stands for mesh_lower and mesh_upper
mesh = { between = ["b", "A*sin(w*t)"], gap = 0.02, restitution = 0.6 }

[state]
position = { b = 0.0 }
velocity = { b = 1.0 }

[simulate]
until = 2.0
)text";

constexpr StartingFile files[] = {
    {"system", "a mechanism with contacts: which persist, with which forces", system_file},
    {"simulate", "a motion with impacts, drawn", motion_file},
    {"looseness", "a mechanism with play, followed in time", looseness_file},
    {"projection", "the nearest point of a polyhedron, from numbers", projection_file},
    {"decomposition", "a point split by a convex function and its conjugate", decomposition_file},
    {"cone", "a polyhedral cone, its polar, a point split between them", cone_file},
    {"liquid", "a liquid that may part", liquid_file},
};

}  // namespace

std::span<const StartingFile> starting_files() { return files; }

}  // namespace cli::inline manual
