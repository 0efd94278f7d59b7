#include "mechanics/data_radii.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "mechanics/exact_text.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/rounded_nodes.hpp"
#include "mechanics/expression/state_nodes.hpp"
#include "mechanics/expression/sweeps.hpp"

namespace mechanics {

using convex::infinity;

using namespace expression;

namespace {

/// A radius that is no number says nothing.
double known(double radius) { return radius >= 0 ? radius : infinity; }

/// How far the numbers of some nodes may be from the values; what is not given is 0, and exact.
Vector radii_of_values(const std::vector<NodeId>& nodes, const std::vector<Rounded>& numbers,
                       const Vector& values) {
  Vector radii = Vector::Zero(values.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] == no_node) continue;
    const auto k = static_cast<Index>(i);
    const Rounded number = numbers[nodes[i]];
    radii[k] = known(number.radius + std::abs(number.value - values[k]));
  }
  return radii;
}

/// The numbers by whose signs a program takes its branches, where rounding leaves the sign open.
void add_open_conditions(const Program& program, const RoundedState& state,
                         const std::vector<Rounded>& constants, std::vector<NodeId>& open) {
  if (program.groups() == 0 || !program.has_branches()) return;
  const std::size_t last = program.groups() - 1;
  const ValuesOf<Rounded> x = program.rounded_values(state, last, constants);
  const std::vector<bool> used = program.in_use(x, last);
  for (Slot slot = program.begin(); slot < program.end(last); ++slot) {
    const auto& i = program[slot];
    if (used[slot] && is_where(i.operation) && x[i.a].is_undecided()) open.push_back(program.node(i.a));
  }
}

std::vector<KnownNode> conditions_as_written(const LagrangianSystem& system, const StateText& text,
                                             const RoundedState& state) {
  const LagrangianModel& model = system.model();
  if (!model.tape.has_branches()) return {};
  const std::vector<Rounded> constants = rounded_nodes(model.tape);
  std::vector<NodeId> open;
  add_open_conditions(model.motion, state, constants, open);
  add_open_conditions(model.contacts, state, constants, open);
  if (open.empty()) return {};
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  return numbers_as_written(system, text, open);
}

/// The program of T, V and Q run with radii, and its reverse sweep from T - V.
struct Motion {
  ValuesOf<Rounded> x;
  std::vector<PartialsOf<Rounded>> p;
  ValuesOf<Rounded> adjoint;
};

Motion run_motion(const LagrangianModel& model, const RoundedState& state,
                  const std::vector<Rounded>& constants) {
  const Program& program = model.motion;
  Motion run{program.rounded_values(state, 1, constants), {}, {}};
  run.p = first_partials(program, run.x);
  std::vector<std::pair<Slot, double>> weights{{program.roots(0)[0], 1.0}};
  if (model.potential != no_node) weights.emplace_back(program.roots(0)[1], -1.0);
  run.adjoint = adjoints(program, run.p, weights);
  return run;
}

/// ∂T/∂q - ∂V/∂q + Q - d/dt ∂T/∂v in the acceleration q2, which rests when it is empty: z - A q2.
std::vector<Rounded> imbalance(const LagrangianModel& model, const RoundedState& state, const Motion& run,
                               const std::vector<Rounded>& q2) {
  const Program& program = model.motion;
  std::vector<Rounded> z = model.hessian.gradient_rate(program, run.x, run.adjoint,
                                                       tangents<Rounded>(program, run.p, state.v, q2));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = run.adjoint[i] - z[i];
  for (std::size_t k = 0; k < model.forced.size(); ++k)
    z[static_cast<std::size_t>(model.forced[k])] += run.x[program.roots(1)[k]];
  return z;
}

Vector radii_of(const std::vector<Rounded>& numbers) {
  Vector radii(static_cast<Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) radii[static_cast<Index>(i)] = known(numbers[i].radius);
  return radii;
}

RoundedVector rounded_vector(const std::vector<Rounded>& numbers) {
  RoundedVector made{Vector(static_cast<Index>(numbers.size())), radii_of(numbers)};
  for (std::size_t i = 0; i < numbers.size(); ++i) made.value[static_cast<Index>(i)] = numbers[i].value;
  return made;
}

/// The same state as doubles see it: on the branches that their signs choose.
RoundedState without_known(RoundedState state) {
  state.known.clear();
  return state;
}

Values values_of(const ValuesOf<Rounded>& numbers) {
  Values values(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) values[i] = numbers[i].value;
  return values;
}

void add_motion(const LagrangianModel& model, const RoundedState& state,
                const std::vector<Rounded>& constants, convex::EntryRadii& found) {
  const Motion run = run_motion(model, state, constants);
  found.A = model.hessian.matrix_radii(model.motion, run.x, run.adjoint);
  for (double& radius : std::span(found.A.valuePtr(), static_cast<std::size_t>(found.A.nonZeros())))
    radius = known(radius);
  const RoundedVector z = rounded_vector(imbalance(model, state, run, {}));
  found.z = z.radius;
  if (state.known.empty()) return;
  const RoundedState seen = without_known(state);
  const Motion as_seen = run_motion(model, seen, constants);
  const auto inertia = [&](const Motion& of) {
    return model.hessian.matrix(model.motion, values_of(of.x), values_of(of.adjoint));
  };
  found.A += convex::SparseMatrix((inertia(run) - inertia(as_seen)).cwiseAbs());
  found.z += (z.value - rounded_vector(imbalance(model, seen, as_seen, {})).value).cwiseAbs();
}

/// U and s with what is known of them.
struct RowNumbers {
  convex::SparseRows U, U_radius;
  RoundedVector s;
};

RowNumbers row_numbers(const LagrangianModel& model, const RoundedState& state,
                       const std::vector<Rounded>& constants, const std::vector<Index>& contacts) {
  const Program& program = model.contacts;
  const ValuesOf<Rounded> x = program.rounded_values(state, 0, constants);
  const auto m = static_cast<Index>(contacts.size()), n = static_cast<Index>(state.q.size());
  GradientsOf<Rounded> gradients(program);
  std::vector<Eigen::Triplet<double>> values, radii;
  const Vector rest = Vector::Zero(n);
  const ValuesOf<Rounded> second = rates<Rounded>(program, x, state.v, &rest).second;
  RowNumbers found{{}, {}, {Vector(m), Vector(m)}};
  for (Index k = 0; k < m; ++k) {
    const Slot root = program.roots(0)[static_cast<std::size_t>(contacts[static_cast<std::size_t>(k)])];
    for (const auto& [i, u] : gradients.of(root, x).by_q) {
      values.emplace_back(k, i, u.value);
      radii.emplace_back(k, i, known(u.radius));
    }
    found.s.value[k] = second[root].value;
    found.s.radius[k] = known(second[root].radius);
  }
  found.U.resize(m, n);
  found.U.setFromTriplets(values.begin(), values.end());
  found.U_radius.resize(m, n);
  found.U_radius.setFromTriplets(radii.begin(), radii.end());
  return found;
}

void add_contacts(const LagrangianModel& model, const RoundedState& state,
                  const std::vector<Rounded>& constants, const std::vector<Index>& contacts,
                  convex::EntryRadii& found) {
  RowNumbers rows = row_numbers(model, state, constants, contacts);
  found.U = std::move(rows.U_radius);
  found.s = std::move(rows.s.radius);
  if (state.known.empty()) return;
  const RowNumbers as_seen = row_numbers(model, without_known(state), constants, contacts);
  found.U += convex::SparseRows((rows.U - as_seen.U).cwiseAbs());
  found.s += (rows.s.value - as_seen.s.value).cwiseAbs();
}

}  // namespace

StateRadii state_radii(const LagrangianSystem& system, const StateText& text, const State& state) {
  const LagrangianModel& model = system.model();
  StateRadii radii;
  const StateNodes nodes = state_nodes(model, text);
  const std::vector<Rounded> numbers = rounded_nodes(nodes.tape);
  if (nodes.t != no_node)
    radii.t = known(numbers[nodes.t].radius + std::abs(numbers[nodes.t].value - state.t));
  radii.q = radii_of_values(nodes.q, numbers, state.q);
  radii.v = radii_of_values(nodes.v, numbers, state.v);
  radii.conditions = conditions_as_written(system, text, rounded_state(state, radii));
  return radii;
}

RoundedState rounded_state(const State& state, const StateRadii& radii) {
  RoundedState rounded{{state.t, radii.t}, {}, {}, radii.conditions};
  for (Index i = 0; i < state.q.size(); ++i) {
    rounded.q.emplace_back(state.q[i], radii.q.size() > 0 ? radii.q[i] : 0);
    rounded.v.emplace_back(state.v[i], radii.v.size() > 0 ? radii.v[i] : 0);
  }
  return rounded;
}

StateRadii guessed_radii(const State& state) {
  constexpr double operations = 4 * 0x1p-53;
  return {
      operations * std::abs(state.t), operations * state.q.cwiseAbs(), operations * state.v.cwiseAbs(), {}};
}

convex::EntryRadii data_radii(const LagrangianSystem& system, const State& state, const StateRadii& radii,
                              const std::vector<Index>& contacts) {
  const LagrangianModel& model = system.model();
  const RoundedState rounded = rounded_state(state, radii);
  const std::vector<Rounded> constants = rounded_nodes(model.tape);
  convex::EntryRadii found;
  add_motion(model, rounded, constants, found);
  add_contacts(model, rounded, constants, contacts, found);
  return found;
}

convex::DataRadii row_radii(const LagrangianSystem& system, const State& state, const StateRadii& radii,
                            const std::vector<Index>& contacts, const convex::Metric& metric) {
  convex::EntryRadii found;
  if (contacts.empty()) return {Vector(0), Vector(0)};
  add_contacts(system.model(), rounded_state(state, radii), rounded_nodes(system.model().tape), contacts,
               found);
  return found.by_rows(metric);
}

convex::SparseRows gradients_beyond_rounding(const LagrangianSystem& system, const State& state,
                                             const std::vector<Index>& constraints) {
  convex::SparseRows U(static_cast<Index>(constraints.size()), state.q.size());
  if (constraints.empty()) return U;
  const LagrangianModel& model = system.model();
  const Program& program = model.contacts;
  const ValuesOf<Rounded> x =
      program.rounded_values(rounded_state(state, guessed_radii(state)), 0, rounded_nodes(model.tape));
  GradientsOf<Rounded> gradients(program);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < constraints.size(); ++k)
    for (const auto& [i, u] :
         gradients.of(program.roots(0)[static_cast<std::size_t>(constraints[k])], x).by_q)
      if (!u.may_be_zero()) entries.emplace_back(static_cast<Index>(k), i, u.value);
  U.setFromTriplets(entries.begin(), entries.end());
  return U;
}

RateRadii rate_radii(const LagrangianSystem& system, const State& state, const StateRadii& radii) {
  const Program& program = system.model().contacts;
  const std::vector<Rounded> constants = rounded_nodes(system.model().tape);
  const auto& roots = program.roots(0);
  const auto m = static_cast<Index>(roots.size());
  const auto numbers = [&](const RoundedState& at) {
    const ValuesOf<Rounded> x = program.rounded_values(at, 0, constants);
    const ValuesOf<Rounded> rate = rates<Rounded>(program, x, at.v, nullptr).first;
    std::pair<RoundedVector, RoundedVector> found{{Vector(m), Vector(m)}, {Vector(m), Vector(m)}};
    for (Index a = 0; a < m; ++a) {
      const Slot root = roots[static_cast<std::size_t>(a)];
      found.first.value[a] = x[root].value;
      found.first.radius[a] = known(x[root].radius);
      found.second.value[a] = rate[root].value;
      found.second.radius[a] = known(rate[root].radius);
    }
    return found;
  };
  const RoundedState rounded = rounded_state(state, radii);
  const auto [f, df] = numbers(rounded);
  RateRadii found{f.radius, df.radius};
  if (rounded.known.empty()) return found;
  const auto [f_seen, df_seen] = numbers(without_known(rounded));
  found.f += (f.value - f_seen.value).cwiseAbs();
  found.df += (df.value - df_seen.value).cwiseAbs();
  return found;
}

EquationsAsWritten equations_as_written(const LagrangianSystem& system, const State& state,
                                        const StateRadii& radii, const std::vector<Index>& contacts,
                                        const Vector& q2, const Vector& lambda) {
  const LagrangianModel& model = system.model();
  const RoundedState rounded = rounded_state(state, radii);
  const std::vector<Rounded> constants = rounded_nodes(model.tape);
  std::vector<Rounded> balance = imbalance(model, rounded, run_motion(model, rounded, constants),
                                           std::vector<Rounded>(q2.begin(), q2.end()));
  const Program& program = model.contacts;
  const ValuesOf<Rounded> x = program.rounded_values(rounded, 0, constants);
  const ValuesOf<Rounded> second = rates<Rounded>(program, x, rounded.v, &q2).second;
  std::vector<Rounded> rows;
  std::vector<std::pair<Slot, double>> weights;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Slot root = program.roots(0)[static_cast<std::size_t>(contacts[k])];
    rows.push_back(second[root]);
    if (const double push = lambda[static_cast<Index>(k)]; push != 0) weights.emplace_back(root, push);
  }
  const ValuesOf<Rounded> pushed = adjoints(program, first_partials(program, x), weights);
  for (std::size_t i = 0; i < balance.size(); ++i) balance[i] += pushed[i];
  return {rounded_vector(balance), rounded_vector(rows)};
}

}  // namespace mechanics
