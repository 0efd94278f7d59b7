#include "mechanics/motion/variation.hpp"

#include "mechanics/expression/gradient_nodes.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/motion/lagrange_equations.hpp"

namespace mechanics::inline motions {

using namespace expression;
using convex::Matrix;

namespace {

/// Sums of products as nodes; no_node is 0.
class Sums {
 public:
  explicit Sums(Tape& tape) : tape_(tape) {}
  void add(NodeId& sum, NodeId term, Operation operation = Operation::add) {
    if (term == no_node) return;
    if (sum == no_node)
      sum = operation == Operation::add ? term : tape_.apply(Operation::negate, term, term, at(term));
    else
      sum = tape_.apply(operation, sum, term, at(term));
  }
  NodeId product(NodeId a, NodeId b) { return tape_.apply(Operation::multiply, a, b, at(a)); }
  NodeId or_zero(NodeId node, Origin origin) {
    return node == no_node ? tape_.literal("0", 0, origin) : node;
  }
  Origin at(NodeId node) const { return tape_.origin(node); }

 private:
  Tape& tape_;
};

}  // namespace

Variation::Variation(const LagrangianSystem& system) : system_(system) {
  const LagrangeEquations& equations = system.equations_of_motion().equations;
  Tape tape = equations.tape;
  Sums sums(tape);
  n_ = equations.coordinates();
  m_ = equations.constraints();
  const auto n = static_cast<std::uint32_t>(n_);
  const Origin origin = tape.origin(system.model().kinetic);
  const auto node = [&](Slot slot) {
    const Program& program = equations.program;
    if (slot == program.time()) return tape.time(origin);
    if (slot > program.time()) return program.node(slot);
    return slot < n ? tape.coordinate(slot, origin) : tape.velocity(slot - n, origin);
  };
  const auto acceleration = [&](std::uint32_t i) { return tape.coordinate(n + i, origin); };
  const auto lambda = [&](Index a) { return tape.coordinate(2 * n + static_cast<std::uint32_t>(a), origin); };
  /// d/dt of a node that depends on velocities too.
  const auto time_derivative = [&](NodeId of) {
    NodeId sum = no_node;
    const GradientNodes gradient = gradient_nodes(tape, of);
    for (const auto& [i, by] : gradient.by_coordinate)
      sums.add(sum, sums.product(by, tape.velocity(i, origin)));
    for (const auto& [i, by] : gradient.by_velocity) sums.add(sum, sums.product(by, acceleration(i)));
    sums.add(sum, gradient.by_time);
    return sum;
  };
  std::vector<NodeId> e(n, no_node), reaction(n, no_node), roots, momenta;
  for (const auto& [i, slot] : equations.force) e[static_cast<std::size_t>(i)] = node(slot);
  for (Index a = 0; a < m_; ++a)
    for (const auto& [i, slot] : equations.row[static_cast<std::size_t>(a)])
      sums.add(reaction[static_cast<std::size_t>(i)], sums.product(lambda(a), node(slot)));
  for (std::uint32_t i = 0; i < n; ++i) {
    momenta.push_back(node(equations.momentum[i]));
    sums.add(e[i], reaction[i]);
    sums.add(e[i], time_derivative(momenta.back()), Operation::subtract);
    roots.push_back(sums.or_zero(e[i], origin));
  }
  second_roots_ = static_cast<Index>(roots.size());
  for (const Slot rate : equations.rate) roots.push_back(sums.or_zero(time_derivative(node(rate)), origin));
  momentum_roots_ = static_cast<Index>(roots.size());
  roots.insert(roots.end(), momenta.begin(), momenta.end());
  rate_roots_ = static_cast<Index>(roots.size());
  for (const Slot rate : equations.rate) roots.push_back(node(rate));
  reaction_roots_ = static_cast<Index>(roots.size());
  for (const NodeId r : reaction) roots.push_back(sums.or_zero(r, origin));
  last_roots_ = static_cast<Index>(roots.size());
  for (const Slot f : equations.constraint) roots.push_back(node(f));
  switch_roots_ = static_cast<Index>(roots.size());
  for (const Switch& one : system.equations_of_motion().series.steps.switches) {
    const Operation operation = tape.operation(one.node);
    const NodeId a = tape.a(one.node), b = tape.b(one.node);
    const bool compares = operation == Operation::max || operation == Operation::min;
    roots.push_back(compares ? tape.apply(Operation::subtract, a, b, origin) : a);
    ++switches_;
  }
  program_ = Program(tape, static_cast<std::size_t>(2 * n_ + m_), {roots});
}

Variation::Sweep Variation::sweep(const State& at, const Vector& q2, const Vector& lambda) const {
  State point{at.t, Vector(2 * n_ + m_), Vector::Zero(2 * n_ + m_)};
  point.q << at.q, q2, lambda;
  point.v.head(n_) = at.v;
  bool is_finite = true;
  const Values x = program_.values(point, 0, is_finite);
  const Index width = 2 * n_ + 1;
  // By slot: the gradient, of constants and of q'' and lambda 0.
  convex::RowMatrix gradient = convex::RowMatrix::Zero(static_cast<Index>(program_.size()), width);
  for (Index i = 0; i < n_; ++i) {
    gradient(program_.coordinate(static_cast<std::size_t>(i)), i) = 1;
    gradient(program_.velocity(static_cast<std::size_t>(i)), n_ + i) = 1;
  }
  gradient(program_.time(), 2 * n_) = 1;
  for (Slot slot = program_.begin(); slot < program_.end(0); ++slot) {
    const Partials by = program_.partials(slot, x);
    const Program::Instruction& step = program_[slot];
    if (by.a != 0) gradient.row(slot) += by.a * gradient.row(step.a);
    if (by.b != 0) gradient.row(slot) += by.b * gradient.row(step.b);
  }
  const std::vector<Slot>& roots = program_.roots(0);
  Sweep found{Vector(static_cast<Index>(roots.size())), Matrix(static_cast<Index>(roots.size()), width)};
  for (std::size_t k = 0; k < roots.size(); ++k) {
    found.value[static_cast<Index>(k)] = x[roots[k]];
    found.gradient.row(static_cast<Index>(k)) = gradient.row(roots[k]);
  }
  return found;
}

Variation::Number Variation::number(const State& at, Index root) const {
  const Sweep there = sweep(at, Vector::Zero(n_), Vector::Zero(m_));
  return {there.value[root], there.gradient.row(root).transpose()};
}

convex::Metric Variation::metric(const State& at) const {
  return kinetic_metric(system_.inertia(at).A, system_.coordinates());
}

std::vector<Vector> Variation::rows(const State& at, const std::vector<Index>& constraints) const {
  const convex::SparseRows U = system_.contact_rows(at, constraints).U;
  std::vector<Vector> found;
  for (Index k = 0; k < U.rows(); ++k) found.push_back(Vector(U.row(k).transpose()));
  return found;
}

Variation::Acceleration Variation::acceleration(const State& at, const std::vector<Index>& held) const {
  const Inertia inertia = system_.inertia(at);
  const HeldRows solver(kinetic_metric(inertia.A, system_.coordinates()), rows(at, held));
  const HeldRows::Answer found = solver.solve(inertia.z, system_.contact_rows(at, held).s);
  Vector lambda = Vector::Zero(m_);
  for (std::size_t k = 0; k < held.size(); ++k) lambda[held[k]] = found.lambda[static_cast<Index>(k)];
  const Sweep there = sweep(at, found.x, lambda);
  Acceleration answer{found.x, Matrix(n_, 2 * n_ + 1)};
  Vector s(static_cast<Index>(held.size()));
  for (Index k = 0; k < answer.gradient.cols(); ++k) {
    for (std::size_t a = 0; a < held.size(); ++a)
      s[static_cast<Index>(a)] = -there.gradient(second_roots_ + held[a], k);
    answer.gradient.col(k) = solver.solve(there.gradient.col(k).head(n_), s).x;
  }
  return answer;
}

Variation::Impact Variation::impact(const State& before, const std::vector<Index>& enforced,
                                    const Vector& restitution) const {
  const auto count = static_cast<Index>(enforced.size());
  const HeldRows solver(metric(before), rows(before, enforced));
  const Sweep first = sweep(before, Vector::Zero(n_), Vector::Zero(m_));
  Vector s(count);
  for (Index k = 0; k < count; ++k)
    s[k] = -(1 + restitution[k]) * first.value[rate_roots_ + enforced[static_cast<std::size_t>(k)]];
  const HeldRows::Answer found = solver.solve(Vector::Zero(n_), s);
  Vector impulse = Vector::Zero(m_);
  for (Index k = 0; k < count; ++k) impulse[enforced[static_cast<std::size_t>(k)]] = found.lambda[k];
  State after = before;
  after.v += found.x;
  const Sweep then = sweep(after, Vector::Zero(n_), impulse);
  Impact answer{after.v, found.lambda, Matrix::Zero(n_, 2 * n_ + 1)};
  answer.gradient.middleCols(n_, n_) = Matrix::Identity(n_, n_);
  // p(v+) - p(v) = Σ P_a u_a and g(v+) = -e g(v), differentiated: p and g are of degree 1 in v.
  for (Index j = 0; j < answer.gradient.cols(); ++j) {
    const bool by_velocity = j >= n_ && j < 2 * n_;
    Vector r = Vector::Zero(n_);
    if (!by_velocity)
      r = then.gradient.col(j).segment(reaction_roots_, n_) -
          (then.gradient.col(j) - first.gradient.col(j)).segment(momentum_roots_, n_);
    for (Index k = 0; k < count; ++k) {
      const Index rate = rate_roots_ + enforced[static_cast<std::size_t>(k)];
      s[k] = -restitution[k] * first.gradient(rate, j) - then.gradient(rate, j);
    }
    answer.gradient.col(j) += solver.solve(r, s).x;
  }
  return answer;
}

void Variation::hold(const State& at, const std::vector<Index>& constraints, Matrix& variations) const {
  if (constraints.empty()) return;
  const HeldRows solver(metric(at), rows(at, constraints));
  const Sweep there = sweep(at, Vector::Zero(n_), Vector::Zero(m_));
  Vector f(static_cast<Index>(constraints.size())), rate(f.size());
  for (Index j = 0; j < variations.cols(); ++j) {
    for (std::size_t k = 0; k < constraints.size(); ++k)
      f[static_cast<Index>(k)] =
          -there.gradient.row(last_roots_ + constraints[k]).head(n_).dot(variations.col(j).head(n_));
    variations.col(j).head(n_) += solver.least_change(f);
    for (std::size_t k = 0; k < constraints.size(); ++k)
      rate[static_cast<Index>(k)] =
          -there.gradient.row(rate_roots_ + constraints[k]).head(2 * n_).dot(variations.col(j));
    variations.col(j).tail(n_) += solver.least_change(rate);
  }
}

}  // namespace mechanics::inline motions
