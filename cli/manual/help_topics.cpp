#include "cli/manual/help_topics.hpp"

namespace cli::inline manual {
namespace {

constexpr std::string_view start_text = R"text(  moreau new system ladder.toml     a file to begin with
  moreau solve ladder.toml          which contacts persist, accelerations, forces
  moreau explain ladder.toml        the reasoning, step by step
  moreau solve ladder.toml --plot ladder.svg
  moreau simulate ladder.toml --until 1
  moreau sweep ladder.toml --over "F=0:5:100"

A state that misses the constraints by a little is put right by `moreau assemble`.
)text";

constexpr std::string_view system_text = R"text([system]
  coordinates = ["x", "a"]             q, in order; "x[1..N]" is a family
  kinetic     = "m/2*x'^2 + J/2*a'^2"  T(q, q', t), at most quadratic in the velocities
  potential   = "m*g*x"                V(q, t); adds -dV/dq to the forces
[system.parameters]   m = 2.0          numbers, or expressions in other parameters
[system.definitions]  h = "l*sin(a)"   named expressions
[system.forces]       x = "-3*x'"      Q by coordinate; what is missing is 0
[system.constraints]  floor = "x >= h" >= and <= are one-sided, = is two-sided
[system.looseness]    mesh = { between = ["a", "2*x"], gap = 0.01 }   play
[bodies.top]          mass = 2.0, inertia = [1, 1, 2]: a rigid body in space; makes the coordinates top_x
                      top_y top_z top_e0 ... top_e3 (Euler's parameters) and the constraint top_unit
[state]               see `moreau help state`
[solve]               method, tolerance, contact_tolerance
[simulate]            until, method, tolerance, step, restitution, samples, impact_law
[draw]                points, segments, circles: what --plot and --animate show
)text";

constexpr std::string_view state_text = R"text([state]
  t = 0.0
  position = { x = 1.0, y = "sqrt(l^2 - x^2)" }      every coordinate
  velocity = { x = 0.5, y = "(sqrt(l^2 - x^2))'" }   what is missing is 0
  in_contact = ["string"]    the state is a guess: the nearest one with these contacts is taken
  solve_for = ["y"]          only these coordinates move then

A one-sided constraint counts as in contact where f and df/dt are 0 to contact_tolerance (1e-9 of the
largest term of f, or of 1). A state that violates a constraint is refused. Then
  moreau assemble FILE --contact string -o OUT.toml
writes the nearest state at which this contact and all two-sided constraints hold.
)text";

constexpr std::string_view expressions_text =
    R"text(+ - * / ^ and parentheses; ^ groups to the right and binds tighter than a minus in front
numbers (1, 2.5e-3), pi, t, coordinates, parameters, definitions
sin cos tan asin acos atan atan2(y, x) sinh cosh tanh exp log ln sqrt abs
min max hypot(x, y) sign(x) step(x)
if(a >= b, c, d)                 c where the comparison holds, else d
table(x, [x1, ...], [y1, ...])   a cubic spline; table(x, "F.csv") takes two columns of a file
sum(i in 1..N, m*x[i]^2)         over a family
dot(u, v) norm(u) cross(u, v)[k] of vectors: r for "r[1..3]", lists [a, b, c], sums and multiples
point(BODY, a, b, c, k)          the k-th coordinate in space of a point of a body
x'                               the velocity of x; (l*sin(a))' the rate of anything
)text";

constexpr std::string_view motion_text = R"text([simulate]
  until       = 10.0             where it ends; --until wins
  method      = "event-driven"   or time-stepping, auto
  tolerance   = 1e-10            error of a step
  step        = 1e-3             length of a step of time-stepping
  restitution = 0.9              e, or { floor = 0.9, wall = 0 } by constraint, 0 <= e <= 1
  impact_law  = "moreau"         or poisson, sequential
  samples     = 201              rows of --output F.csv

  moreau simulate FILE --plot F.svg --animate F.html --events F.jsonl
  moreau simulate FILE --output F.csv --strobe "2*pi/w" --modulo "a=2*pi"
  moreau simulate FILE --json > end.json; moreau simulate FILE --resume end.json --until 20
  moreau orbit FILE --period "2*pi/w" --over w=1:0.01:3     motions that come back, and how they change
)text";

constexpr std::string_view liquid_text = R"text([liquid]
  coordinates = ["x", "y"]                      one to three
  domain      = "disc(center=[0, 0], radius=1)" interval box disc ball polygon, "{x^2 + 4*y^2 <= 1, y >= 0}"
  density     = "rho"
  velocity    = ["-w*y", "w*x"]                 u now; its divergence is 0 where there is no cavity
  force       = ["0", "-g"]                     F, of a unit of mass
  cells       = 256                             along the longest side; default: as many as it takes
[liquid.free]   rim = { where = "y > 0 and x < 1", pressure = "p0" }
[liquid.walls]  bed = { where = "y <= 0", acceleration = 0 }   along the outward normal
[liquid.parameters]   rho = 1.0, w = 3.0, g = 9.81, p0 = 3.0

  moreau solve FILE                   whether it parts and where, and the pressure
  moreau solve FILE --onset w         from which value of w on
  moreau solve FILE --probe "x=0.5, y=0" --plot F.svg --data F.csv --vtk F.vti
  moreau solve FILE --animate F.html --over w=0:0.05:3
--tolerance X is of the largest pressure, 1e-3 by default.
)text";

constexpr std::string_view settings_text = R"text(  --set "m=3"                 a parameter
  --set "position.x=0.2"      a number of the state; velocity.x as well, and t
  --set simulate.until=2      any other key, by its tables
  --set "projection.z[1]=4"   an entry of a list

May be repeated. `moreau sweep FILE --over "m=1:0.5:3"` answers for each of many values.
)text";

constexpr std::string_view exit_codes_text =
    R"text(  0  solved: the error bound is at most tolerance * max(1, ||q''||_A)
  1  the problem has no solution, or a check failed
  2  the input or the command is wrong
  3  an answer, but not to the accuracy that was asked for

Of several files the largest counts. Results go to standard output, messages to standard error as
`moreau: FILE:LINE:COLUMN: what is wrong; what to do`.
)text";

constexpr std::string_view language_text =
    R"text(A convex function is a call, name(arguments), by position or key=value:
  norm1(weight=2)              indicator(ball2(radius=3))       2*norm1() + norm2()
  sum(norm1(), quadratic([[2, 0], [0, 1]]))          translate(huber(mu=1), [1, 2])

An argument is a number (1/3 is exact), inf, a vector [1, 2], a matrix [[1, 2], [3, 4]], a set or a
function. `moreau functions` lists all of them, `moreau functions NAME` tells one.
The product is that of the metric: --metric, or the key `metric`.
)text";

constexpr std::string_view accuracy_text =
    R"text(Every answer has an error bound. Without --certify it is an estimate that takes the conditioning in;
with it a proved one, in fractions or intervals, of the mechanism as written; exit 3 without a proof.
--tolerance X asks for another bound than 1e-9, --method exact for fractions.
`moreau check FILE` puts an answer to the laws that it must obey.
)text";

constexpr std::string_view contact_text =
    R"text(A contact is an inequality of the coordinates, written below [system.constraints]:
  floor  = "y >= h"                     one-sided: it pushes, lambda >= 0, and may open
  string = "x^2 + y^2 <= l^2"           one-sided too: it pulls when it is taut
  rod    = "x^2 + y^2 = l^2"            two-sided: it holds

It is present (in K) where f = 0 and df/dt = 0, to contact_tolerance. `moreau solve` then tells whether it
  persists   it goes on, with the multiplier lambda
  opens      it is in K and is left now, d2f/dt2 > 0
  touches    it neither presses nor opens to second order
  inactive   it is not in K: apart, or being left already
lambda is the force of the contact where f is a distance; elsewhere the column |lambda grad f| is.
A state that is not quite in contact: `moreau help state`. Impacts: `moreau help motion`.
)text";

constexpr std::string_view friction_text =
    R"text(Contacts have no friction: their forces are along the gradient of f alone. What there is in its place:
  [system.forces] x = "-c*x'"              a resistance that grows with the velocity
  [system.forces] x = "-mu*N*sign(x')"     sliding friction, where the normal force N is known beforehand
  stuck = "x = 0"                          a two-sided constraint holds what sticks; its lambda is the force
                                           that friction has to give: compare it with mu times the normal one
A cone of friction as a convex set: second_order_cone(), docs/problems/decomposition_friction_cone.toml.
)text";

constexpr std::string_view units_text =
    R"text(Numbers carry no units: any consistent system will do, as m, kg, s, N, and radians.
  [system.parameters] alpha = "30*pi/180"  30 degrees
lambda has the unit of energy over that of f: a force where f is a length, a moment where it is an angle.
Choose units in which lengths are not far below 1: a contact counts as closed within contact_tolerance times
the largest term of f, or times 1 (`moreau help state`).
)text";

constexpr HelpTopic topics[] = {
    {"start", "from nothing to an answer", start_text},
    {"system", "what a file on a mechanism holds", system_text},
    {"state", "the state of a mechanism, and which contacts are present", state_text},
    {"contact", "how contacts are written, and what becomes of them", contact_text},
    {"friction", "there is none, and what there is in its place", friction_text},
    {"units", "numbers carry none", units_text},
    {"expressions", "what may stand in an expression", expressions_text},
    {"motion", "what a file says of a motion, and what may be asked", motion_text},
    {"liquid", "what a file on a liquid holds: the inception of cavitation", liquid_text},
    {"language", "convex functions, as prox and conjugate read them", language_text},
    {"settings", "values other than those of the file: --set", settings_text},
    {"accuracy", "how right an answer is", accuracy_text},
    {"exit-codes", "what the program ends with", exit_codes_text},
};

}  // namespace

std::span<const HelpTopic> help_topics() { return topics; }

}  // namespace cli::inline manual
