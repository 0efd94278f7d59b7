#include "mechanics/motion/expansion.hpp"

#include <algorithm>
#include <cmath>

#include "convex/invariant.hpp"
#include "mechanics/motion/jumping_nodes.hpp"

namespace mechanics::inline motions {

using expression::NodeId;
using expression::Slot;

namespace {

/// Of max and min the argument of the switch is a difference.
bool compares(const expression::Tape& tape, expression::NodeId chooses) {
  const expression::Operation operation = tape.operation(chooses);
  return operation == expression::Operation::max || operation == expression::Operation::min;
}

[[noreturn]] void refuse_order(int order, std::string_view besides = "") {
  throw convex::InvalidInput("a value or a derivative of order " + std::to_string(order) +
                             " is not finite there" + std::string(besides));
}

}  // namespace

Expansion::Expansion(const LagrangianSystem& system, int order)
    : system_(system),
      equations_(system.equations_of_motion().equations),
      steps_(system.equations_of_motion().series.steps),
      order_(order),
      series_(system.equations_of_motion().series, order),
      columns_(equations_, series_),
      lambda_(static_cast<std::size_t>(equations_.constraints() * (order - 1))),
      f_(static_cast<std::size_t>(equations_.constraints() * (order + 1))),
      magnitude_(series_) {
  convex::invariant(order >= 2 && order < most_orders, "a motion needs accelerations");
  const expression::Tape& tape = equations_.tape;
  const std::vector<bool> may_jump = nodes_that_may_jump(tape), of_quotients = nodes_of_quotients(tape);
  std::vector<bool> is_in_argument(tape.size());
  for (const Switch& one : steps_.switches) {
    const NodeId a = tape.a(one.node), b = compares(tape, one.node) ? tape.b(one.node) : a;
    may_jump_ = may_jump_ || may_jump[a] || may_jump[b];
    may_hide_.push_back(of_quotients[a] || of_quotients[b]);
    is_in_argument[a] = is_in_argument[b] = true;
  }
  for (const Slot f : equations_.constraint) may_hide_.push_back(of_quotients[equations_.program.node(f)]);
  for (NodeId node = static_cast<NodeId>(tape.size()); node-- > 0;) {
    const int count = is_in_argument[node] ? expression::arity(tape.operation(node)) : 0;
    if (count > 0) is_in_argument[tape.a(node)] = true;
    if (count > 1) is_in_argument[tape.b(node)] = true;
  }
  for (const TaylorStep& step : steps_.steps)
    if (step.kind == TaylorStep::Kind::angle && is_in_argument[equations_.program.node(step.out)])
      choosing_angles_.emplace_back(step.a, step.b);
}

void Expansion::take(const State& state) {
  state_ = state;
  magnitude_is_begun_ = false;
  const expression::Program& program = equations_.program;
  for (std::size_t i = 0; i < program.coordinates(); ++i) {
    series_.start(program.coordinate(i)) = state.q[static_cast<Index>(i)];
    series_.start(program.velocity(i)) = state.v[static_cast<Index>(i)];
  }
  series_.start(program.time()) = state.t;
}

void Expansion::look_at_constraints(const State& state) {
  take(state);
  for (std::size_t group = 0; group < 3; ++group) series_.find_values(group);
}

void Expansion::look_at_arguments(const State& state) {
  take(state);
  begin();
}

void Expansion::look_at(const State& state) {
  take(state);
  series_.bases_at_zero().clear();
  begin();
  if (!has_branches_) take_branches();
  while (!is_finite())
    if (!find_bases_at_zero()) refuse_order(1);
}

void Expansion::begin() {
  for (std::size_t group = 0; group < 3; ++group) series_.begin(group);
}

void Expansion::set(const State& state) {
  look_at(state);
  find_inertia();
}

/// The first state decides the branches: before that, one that is not taken may be undefined.
void Expansion::take_branches() {
  has_branches_ = true;
  for (std::size_t k = 0; k < switches(); ++k) {  // an argument may contain the switches before it
    const double argument = switch_argument(k)[0];
    if (!(argument < 0)) continue;
    branch(k) = -1;
    begin();
  }
}

void Expansion::refuse_cut(std::string_view besides) const { refuse_order(cut(), besides); }

/// Whether all is that enters the equations.
bool Expansion::is_finite() const {
  double spoiled = 0;  // 0 times a number, unless it is not finite
  const auto look = [&](Slot slot) { spoiled += 0 * series_[slot][0]; };
  for (const Slot slot : equations_.momentum) look(slot);
  for (const Slot slot : equations_.rate) look(slot);
  for (const auto& [i, slot] : equations_.force) look(slot);
  for (const Slot slot : equations_.constraint) look(slot);
  return spoiled == 0;
}

bool Expansion::depends(std::size_t k, expression::Dependence on) const {
  using namespace expression;
  const Tape& tape = equations_.tape;
  const NodeId chooses = steps_.switches[k].node;
  return (tape.depends(compares(tape, chooses) ? chooses : tape.a(chooses)) & on) != 0;
}

double Expansion::drift(Index a) const {
  double along = 0;
  for (const auto& [i, slot] : equations_.row[index(a)]) along += series_[slot][0] * state_.v[i];
  return rate(a) - along;
}

Vector Expansion::row(Index a) const {
  Vector u;
  row(a, u);
  return u;
}

void Expansion::row(Index a, Vector& u) const {
  u.setZero(coordinates());
  if (std::find(zero_rows_.begin(), zero_rows_.end(), a) != zero_rows_.end()) return;
  for (const auto& [i, slot] : equations_.row[index(a)]) u[i] = series_[slot][0];
}

double Expansion::rate_scale(Index a) const {
  double along = 0, scale = 0;
  for (const auto& [i, slot] : equations_.row[index(a)]) {
    const double part = series_[slot][0] * state_.v[i];
    along += part;
    scale = std::max(scale, std::abs(part));
  }
  return std::max(scale, std::abs(rate(a) - along));
}

double Expansion::position_scale(Index a) const {
  double scale = std::abs(f(a));
  for (const auto& [i, slot] : equations_.row[index(a)])
    scale = std::max(scale, std::abs(series_[slot][0] * state_.q[i]));
  return scale;
}

Vector Expansion::momentum() const {
  Vector p(coordinates());
  for (Index i = 0; i < p.size(); ++i) p[i] = series_[equations_.momentum[index(i)]][0];
  return p;
}

double Expansion::momentum_along(const Vector& x) const {
  double along = 0;
  for (Index i = 0; i < x.size(); ++i) along += series_[equations_.momentum[index(i)]][0] * x[i];
  return along;
}

HeldRows Expansion::held_rows(const std::vector<Index>& constraints) const {
  std::vector<Vector> U;
  for (const Index a : constraints) U.push_back(row(a));
  return HeldRows(inertia(), U);
}

/// Coefficient k of p, F and u is known, and the velocities of order k + 1 are as if they were 0:
/// r with A v_(k+1) = r + Uᵀ lambda_k / (k + 1). False where that is not finite.
bool Expansion::begin_order(int k) {
  const expression::Program& program = equations_.program;
  const auto order = static_cast<std::size_t>(k);
  if (k == 0) series_.restart();
  r_.setZero(coordinates());
  for (const auto& [i, slot] : equations_.force) r_[i] = k == 0 ? series_[slot][0] : series_.at_order(slot);
  for (const Index a : pushing_) {
    const std::span<const double> lambda = multiplier(a);
    for (const auto& [i, slot] : equations_.row[index(a)]) {
      const std::span<const double> u = series_[slot];
      double sum = 0;
      for (std::size_t j = 0; j < order; ++j) sum += lambda[j] * u[order - j];
      r_[i] += sum;
    }
  }
  const double next = k + 1;  // a factor 1 / (k + 1), rounded, would pull all steps to one side
  for (std::size_t i = 0; i < program.coordinates(); ++i) {
    const Slot v = program.velocity(i);
    series_.at_order(program.coordinate(i)) = (k == 0 ? series_[v][0] : series_.at_order(v)) / next;
    series_.at_order(v) = 0;
  }
  series_.at_order(program.time()) = k == 0 ? 1 : 0;
  series_.find_at_rest(k + 1);
  double spoiled = 0;  // 0 times a number, unless it is not finite
  for (Index i = 0; i < r_.size(); ++i) {
    r_[i] = r_[i] / next - series_.at_order(equations_.momentum[index(i)]);
    spoiled += 0 * r_[i];
  }
  for (const Slot slot : equations_.rate) spoiled += 0 * series_.at_order(slot);
  return spoiled == 0;
}

Vector Expansion::missing_rate(const std::vector<Index>& constraints) const {
  Vector s(static_cast<Index>(constraints.size()));
  for (std::size_t a = 0; a < constraints.size(); ++a)
    s[static_cast<Index>(a)] = -series_.at_order(equations_.rate[index(constraints[a])]);
  return s;
}

void Expansion::give_velocity(int k, const Vector& v) {
  const expression::Program& program = equations_.program;
  for (std::size_t i = 0; i < program.coordinates(); ++i)
    series_.at_order(program.velocity(i)) = v[static_cast<Index>(i)];
  series_.find(k);
}

void Expansion::give_multipliers(int k, const std::vector<Index>& constraints, const Vector& lambda) {
  for (std::size_t a = 0; a < constraints.size(); ++a)
    lambda_[index(constraints[a] * (order_ - 1) + k)] = lambda[static_cast<Index>(a)];
}

HeldRows::Answer Expansion::acceleration(const std::vector<Index>& held) {
  pushing_.clear();
  if (!begin_order(0)) refuse_order(2);
  force_ = r_;
  std::optional<HeldRows> rows;
  return solve_held(held, rows);
}

/// Whether all coefficients after order k are 0, as in a flight under constant forces. The recurrences are
/// linear in the coefficients of one order, but for products of lower ones: with nothing above order d, those
/// products are 0 above order 2d.
bool Expansion::ends_by(int k) const {
  int degree = std::max(1, series_.degree());  // of t itself
  if (2 * degree + 1 >= k) return false;
  for (const Index a : pushing_)
    for (int j = degree + 1; j <= k; ++j)
      if (multiplier(a)[static_cast<std::size_t>(j)] != 0) degree = j;
  return 2 * degree + 1 < k;
}

ContactAnswer Expansion::expand(const ContactQuestion& contacts) {
  may_push_.clear();
  exchanged_.clear();
  ContactAnswer answer = expand_once(contacts);
  while (!answer.excluding.empty() && exchange(contacts, answer)) answer = expand_once(contacts);
  return answer;
}

ContactAnswer Expansion::expand_once(const ContactQuestion& contacts) {
  ContactAnswer answer;
  in_doubt_.clear();
  unloaded_ = contacts.unloaded;
  weights_.clear();
  std::fill(lambda_.begin(), lambda_.end(), 0.0);
  std::vector<Index> persist = contacts.held, open = contacts.open;
  pushing_ = persist;
  cut_ = 0;
  if (persist.empty() && open.empty() && factor_.is_made() && expand_free()) return answer;
  std::optional<HeldRows> rows;
  magnitudes_found_ = 0;
  for (int k = 0; k <= order_ - 2; ++k) {
    if (!begin_order(k)) {
      if (take_bases_for_zero()) return expand(contacts);
      if (k == 0 || !open.empty()) refuse_order(k + 2);
      cut_ = k + 2;
      break;
    }
    if (k == 0) force_ = r_;
    const HeldRows::Answer solved = solve_held(persist, rows);
    give_multipliers(k, persist, solved.lambda * (k + 1));
    if (open.empty() || leaves_open(solved.x, persist, rows, open, answer, k)) {
      give_velocity(k + 1, solved.x);
    } else {
      const std::size_t held = persist.size();
      const Vector v = choose(persist, open, answer, k);
      if (!answer.excluding.empty()) return answer;
      give_velocity(k + 1, v);
      if (persist.size() > held) rows.reset();
    }
    if (ends_by(k)) break;
  }
  if (cut_ > 0) {  // what coordinates make of the last order, with which their own goes on
    series_.find(cut_ - 1);
    series_.cut();
  }
  for (std::size_t i = 0; i < equations_.program.coordinates(); ++i) {
    const Slot q = equations_.program.coordinate(i), v = equations_.program.velocity(i);
    if (cut_ > 0)
      series_.end(q, cut_ - 1, std::isfinite(series_.at_order(q)) ? series_.at_order(q) : 0);
    else
      series_.end(q, order_, series_.at_order(v) / order_);
  }
  answer.persist = std::move(persist);
  answer.persist.insert(answer.persist.end(), open.begin(), open.end());
  find_constraints();
  return answer;
}

/// The order begun, with these constraints held; their rows are factored once.
HeldRows::Answer Expansion::solve_held(const std::vector<Index>& held, std::optional<HeldRows>& rows) const {
  if (held.empty() && factor_.is_made()) {
    HeldRows::Answer solved{r_, {}};
    factor_.solve(solved.x);
    return solved;
  }
  if (!rows) rows.emplace(held_rows(held));
  return rows->solve(r_, missing_rate(held));
}

/// Without contacts in question.
bool Expansion::expand_free() {
  force_.setZero(coordinates());
  for (const auto& [i, slot] : equations_.force) force_[i] = series_[slot][0];
  if (!series_.find_free(factor_, {force_.data(), index(coordinates())})) return false;
  r_.resize(coordinates());
  for (Index i = 0; i < coordinates(); ++i) r_[i] = series_.at_order(equations_.program.velocity(index(i)));
  force_.noalias() = small_ * r_;
  find_constraints();
  return true;
}

/// The series of f from those of df/dt.
void Expansion::find_constraints() {
  for (Index a = 0; a < constraints(); ++a) {
    const std::span<const double> rate_of = series_[equations_.rate[index(a)]];
    double* f_a = f_.data() + a * (order_ + 1);
    f_a[0] = f(a);
    const int last = std::min(order_, series_.found());
    for (int k = 1; k <= last; ++k) f_a[k] = rate_of[static_cast<std::size_t>(k - 1)] / k;
    std::fill(f_a + last + 1, f_a + order_ + 1, 0.0);
  }
}

}  // namespace mechanics::inline motions
