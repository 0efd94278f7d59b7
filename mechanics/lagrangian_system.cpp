#include "mechanics/lagrangian_system.hpp"

#include <algorithm>
#include <cmath>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/sweeps.hpp"
#include "mechanics/motion/lagrange_equations.hpp"

namespace mechanics {

using namespace expression;

namespace {

std::vector<std::string> names_of_motion(const LagrangianModel& model, std::size_t group) {
  if (group == 0) return {"kinetic", "potential"};
  std::vector<std::string> names;
  for (const Index i : model.forced)
    names.push_back("force on " + model.coordinates[static_cast<std::size_t>(i)]);
  return names;
}

std::vector<std::string> names_of_constraints(const LagrangianModel& model) {
  std::vector<std::string> names;
  for (const Constraint& constraint : model.constraints) names.push_back("constraint " + constraint.name);
  return names;
}

void check_size(const LagrangianModel& model, const State& state) {
  const auto n = static_cast<Index>(model.coordinates.size());
  if (state.q.size() == n && state.v.size() == n) return;
  throw convex::InvalidInput("state: " + std::to_string(state.q.size()) + " positions and " +
                             std::to_string(state.v.size()) + " velocities; give " + std::to_string(n) +
                             " of each, one per coordinate");
}

/// Something in T, V or their derivatives, or in Q, is not finite.
[[noreturn]] void refuse_motion(const LagrangianModel& model, const Values& x, int derivatives) {
  bool energies_are_finite = true;
  const std::vector<bool> used = model.motion.in_use(x, 0);
  for (Slot slot = 0; slot < model.motion.end(0); ++slot)
    energies_are_finite = energies_are_finite && (!used[slot] || std::isfinite(x[slot]));
  const std::size_t group = derivatives == 0 && energies_are_finite ? 1 : 0;
  refuse_values(model, model.motion, group, x, derivatives, names_of_motion(model, group));
}

/// The values of `contacts`, all finite.
Values values_of_contacts(const LagrangianModel& model, const State& state) {
  check_size(model, state);
  bool is_finite = true;
  Values x = model.contacts.values(state, 0, is_finite);
  if (!is_finite) refuse_values(model, model.contacts, 0, x, 0, names_of_constraints(model));
  return x;
}

std::span<const double> numbers(const Vector& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

Vector at_roots(const Program& program, const Values& of_slot) {
  const auto& roots = program.roots(0);
  Vector result(static_cast<Index>(roots.size()));
  for (std::size_t a = 0; a < roots.size(); ++a) result[static_cast<Index>(a)] = of_slot[roots[a]];
  return result;
}

/// The largest |summand| of each f, as written: sums, differences and signs are looked into, nothing else.
Vector largest_summands(const LagrangianModel& model, const Values& x) {
  const Program& program = model.contacts;
  Values largest(program.size());
  for (Slot slot = 0; slot <= program.time(); ++slot) largest[slot] = std::abs(x[slot]);
  const Values& of_constants = model.largest_summand_of_constant;
  std::copy(of_constants.begin() + program.time() + 1, of_constants.end(),
            largest.begin() + program.time() + 1);
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) {
    const auto& i = program[slot];
    const bool is_sum = i.operation == Operation::add || i.operation == Operation::subtract;
    if (is_sum)
      largest[slot] = std::max(largest[i.a], largest[i.b]);
    else
      largest[slot] = i.operation == Operation::negate ? largest[i.a] : std::abs(x[slot]);
  }
  return at_roots(program, largest);
}

}  // namespace

LagrangianSystem::LagrangianSystem(std::unique_ptr<const LagrangianModel> model) : model_(std::move(model)) {}
LagrangianSystem::~LagrangianSystem() = default;

const std::vector<std::string>& LagrangianSystem::coordinates() const { return model_->coordinates; }
const std::vector<Constraint>& LagrangianSystem::constraints() const { return model_->constraints; }

Inertia LagrangianSystem::inertia(const State& state) const {
  const LagrangianModel& model = *model_;
  const Program& program = model.motion;
  check_size(model, state);
  bool is_finite = true;
  const Values x = program.values(state, 1, is_finite);
  if (!is_finite) refuse_motion(model, x, 0);
  const std::vector<Partials> p = first_partials(program, x);
  std::vector<std::pair<Slot, double>> weights{
      {program.roots(0)[0], 1.0}};  // of T - V, whose ∂/∂v is that of T
  if (model.potential != no_node) weights.emplace_back(program.roots(0)[1], -1.0);
  const Values adjoint = adjoints(program, p, weights);
  const auto n = static_cast<Index>(model.coordinates.size());
  Inertia result;
  result.A = model.hessian.matrix(program, x, adjoint);
  const std::vector<double> rate =
      model.hessian.gradient_rate(program, x, adjoint, tangents<double>(program, p, numbers(state.v)));
  result.z = Eigen::Map<const Vector>(adjoint.data(), n) - Eigen::Map<const Vector>(rate.data(), n);
  for (std::size_t k = 0; k < model.forced.size(); ++k) result.z[model.forced[k]] += x[program.roots(1)[k]];
  const Index entries = result.A.nonZeros();
  if (!result.z.allFinite() || !Eigen::Map<const Vector>(result.A.valuePtr(), entries).allFinite())
    refuse_motion(model, x, 1);
  return result;
}

ConstraintRates LagrangianSystem::constraint_rates(const State& state) const {
  const LagrangianModel& model = *model_;
  const Program& program = model.contacts;
  const Values x = values_of_contacts(model, state);
  ConstraintRates result;
  result.f = at_roots(program, x);
  result.df = at_roots(program, rates<double>(program, x, numbers(state.v), nullptr).first);
  result.f_scale = largest_summands(model, x).cwiseMax(1.0);
  result.df_scale = Vector::Ones(result.f.size());
  if (!result.df.allFinite()) refuse_values(model, program, 0, x, 1, names_of_constraints(model));
  Gradients gradients(program);
  for (Index a = 0; a < result.f.size(); ++a) {
    const auto& gradient = gradients.of(program.roots(0)[static_cast<std::size_t>(a)], x);
    double scale = std::abs(gradient.by_t);
    for (const auto& [i, u] : gradient.by_q) scale = std::max(scale, std::abs(u * state.v[i]));
    result.df_scale[a] = std::max(1.0, scale);
  }
  return result;
}

ContactRows LagrangianSystem::contact_rows(const State& state, const std::vector<Index>& constraints) const {
  const LagrangianModel& model = *model_;
  const Program& program = model.contacts;
  const Values x = values_of_contacts(model, state);
  const auto n = static_cast<Index>(model.coordinates.size());
  const auto m = static_cast<Index>(constraints.size());
  ContactRows result{convex::SparseRows(m, n), Vector(m)};
  std::vector<bool> wanted(program.size());
  Gradients gradients(program);
  bool is_finite = true;
  std::vector<Eigen::Triplet<double>> entries;
  const auto count = static_cast<Index>(model.constraints.size());
  for (const Index a : constraints)
    if (a < 0 || a >= count)
      throw convex::InvalidInput("constraints: there is no number " + std::to_string(a) +
                                 "; they run from 0 to " + std::to_string(count - 1));
  for (Index k = 0; k < m; ++k) {
    const Slot root = program.roots(0)[static_cast<std::size_t>(constraints[static_cast<std::size_t>(k)])];
    for (const auto& [i, u] : gradients.of(root, x).by_q) {
      entries.emplace_back(k, i, u);
      is_finite = is_finite && std::isfinite(u);
    }
    for (const Slot slot : gradients.last_below()) wanted[slot] = true;
  }
  result.U.setFromTriplets(entries.begin(), entries.end());
  const Vector rest = Vector::Zero(n);
  const Values second = rates<double>(program, x, numbers(state.v), &rest, &wanted).second;
  for (Index k = 0; k < m; ++k)
    result.s[k] =
        0.0 - second[program.roots(0)[static_cast<std::size_t>(constraints[static_cast<std::size_t>(k)])]];
  if (!is_finite || !result.s.allFinite())
    refuse_values(model, program, 0, x, 2, names_of_constraints(model));
  return result;
}

Vector LagrangianSystem::second_rates(const State& state, const Vector& q2) const {
  const Values x = values_of_contacts(*model_, state);
  if (q2.size() != state.q.size())
    throw convex::InvalidInput("acceleration: " + convex::counted(q2.size(), "entry", "entries") + "; give " +
                               std::to_string(state.q.size()) + ", one per coordinate");
  Vector result =
      at_roots(model_->contacts, rates<double>(model_->contacts, x, numbers(state.v), &q2).second);
  if (!result.allFinite()) refuse_values(*model_, model_->contacts, 0, x, 2, names_of_constraints(*model_));
  return result;
}

double LagrangianSystem::kinetic_energy(const State& state) const {
  check_size(*model_, state);
  bool is_finite = true;
  const Values x = model_->motion.values(state, 0, is_finite);
  if (!is_finite) refuse_values(*model_, model_->motion, 0, x, 0, names_of_motion(*model_, 0));
  return x[model_->motion.roots(0)[0]];
}

double LagrangianSystem::energy(const State& state) const {
  check_size(*model_, state);
  bool is_finite = true;
  const Values x = model_->motion.values(state, 0, is_finite);
  if (!is_finite) refuse_values(*model_, model_->motion, 0, x, 0, names_of_motion(*model_, 0));
  double energy = 0;
  for (const Slot root : model_->motion.roots(0)) energy += x[root];
  return energy;
}

State LagrangianSystem::state(const StateText& text) const { return read_state(*model_, text); }

std::unique_ptr<const LagrangianSystem> lagrangian_system(const LagrangianText& text,
                                                          const StateText& state) {
  try {
    return std::make_unique<const LagrangianSystem>(read_lagrangian(text));
  } catch (const convex::InvalidInput& error) {
    convex::Mistakes mistakes;
    mistakes.add(error);
    expression::gather_mistakes(text, state, mistakes);
    mistakes.tell();
    throw;
  }
}

void gather_mistakes(const LagrangianText& text, const StateText& state, convex::Mistakes& mistakes) {
  expression::gather_mistakes(text, state, mistakes);
}

const EquationsOfMotion& LagrangianSystem::equations_of_motion() const {
  std::call_once(is_derived_, [&] { equations_ = std::make_unique<const EquationsOfMotion>(*model_); });
  return *equations_;
}

}  // namespace mechanics
