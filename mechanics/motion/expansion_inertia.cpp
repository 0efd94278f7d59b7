#include <algorithm>
#include <array>
#include <cmath>

#include "mechanics/gauss_problem.hpp"
#include "mechanics/motion/expansion.hpp"

namespace mechanics::inline motions {

using expression::Slot;

namespace {

/// Up to so many coordinates A is written down in full.
constexpr Index small_system = 32;

/// Contacts whose gradients differ by less than such a part are apart by the square of it, over a curvature,
/// from where they are one: by rounding.
constexpr double part_implied = 0x1p-20;

}  // namespace

/// A = ∂p/∂q', its symmetric part.
void Expansion::find_inertia() {
  if (!columns_.find() && (factor_.is_made() || A_)) return;
  const Index n = coordinates();
  if (n <= small_system) {
    found_.setZero(n, n);
    for (const auto& [i, j, a] : columns_.entries()) found_(i, j) = a;
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j) found_(i, j) = found_(j, i) = 0.5 * (found_(i, j) + found_(j, i));
    if (factor_.is_made() && small_.size() == found_.size() && small_ == found_) return;
    small_ = found_;
    A_.reset();
    if (!factor_.make(small_)) inertia();
    return;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [i, j, a] : columns_.entries())
    if (a != 0) entries.emplace_back(i, j, a);
  A_.reset();
  convex::SparseMatrix columns(n, n);
  columns.setFromTriplets(entries.begin(), entries.end());
  const convex::SparseMatrix transposed = columns.transpose();
  A_ = kinetic_metric(convex::SparseMatrix(0.5 * (columns + transposed)), system_.coordinates());
}

const convex::Metric& Expansion::inertia() const {
  if (A_) return *A_;
  if ((small_.diagonal().array() > 0).all() && small_.isDiagonal(0))
    A_ = convex::Metric::diagonal(small_.diagonal());
  else
    A_ = kinetic_metric(small_.sparseView(0, 0), system_.coordinates());
  return *A_;
}

double Expansion::norm(const Vector& x) const {
  return factor_.is_made() ? factor_.norm({x.data(), static_cast<std::size_t>(x.size())}) : inertia().norm(x);
}

double Expansion::force_norm() const {
  if (!factor_.is_made()) return inertia().dual_norm(force_);
  std::array<double, small_system> x;
  std::copy_n(force_.data(), force_.size(), x.data());
  factor_.solve(x.data());
  double square = 0;
  for (Index i = 0; i < force_.size(); ++i) square += x[index(i)] * force_[i];
  return std::sqrt(std::max(0.0, square));
}

void Expansion::sizes(std::vector<double>& of_order) const {
  const auto count = static_cast<std::size_t>(order_) + 1;
  of_order.assign(blocks_of(count) * Eight::count, 0.0);
  if (!factor_.is_made()) {
    Vector q(coordinates());
    for (std::size_t k = 0; k < count; ++k) {
      for (Index i = 0; i < q.size(); ++i) q[i] = position(i)[k];
      of_order[k] = inertia().norm(q);
    }
    of_order.resize(count);
    return;
  }
  std::array<const double*, small_system> q;
  const auto find_eight = [&](std::size_t first) {
    bool is_zero = true;
    for (Index i = 0; i < coordinates() && is_zero; ++i)
      is_zero = std::all_of(position(i).data() + first, position(i).data() + first + Eight::count,
                            [](double c) { return c == 0; });
    if (is_zero) return false;
    for (Index i = 0; i < coordinates(); ++i) q[index(i)] = position(i).data() + first;
    factor_.norms(q.data(), of_order.data() + first, Eight::count);
    return true;
  };
  // Beyond the orders found all are 0.
  std::size_t first =
      std::min(static_cast<std::size_t>(series_.found()), count - 1) / Eight::count * Eight::count;
  while (!find_eight(first) && first > 0) first -= Eight::count;
  const std::span<const double> last(of_order.data() + first, Eight::count);
  if (first > Eight::count &&
      static_cast<std::size_t>(std::count(last.begin(), last.end(), 0.0)) > Eight::count - 2)
    find_eight(first - Eight::count);  // the last two orders lie on both sides
  if (first > 0) find_eight(0);
  of_order.resize(count);
}

bool Expansion::is_nearly_implied(Index a, std::vector<Index> constraints) const {
  constraints.push_back(a);
  const auto count = static_cast<Index>(constraints.size());
  const Vector turned = held_rows(constraints).least_change(Vector::Unit(count, count - 1));
  return turned.isZero(0) || inertia().norm(turned) * inertia().dual_norm(row(a)) * part_implied > 1;
}

std::optional<Expansion::Slack> Expansion::slack_beside(const Asked& a, const Asked& b, const Vector& x,
                                                        const Magnitudes& of, int k) {
  const auto &of_a = equations_.row[index(a.constraint)], &of_b = equations_.row[index(b.constraint)];
  if (a.constraint == b.constraint || of_a.empty() ||
      !std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                  [](const auto& one, const auto& other) { return one.first == other.first; }))
    return std::nullopt;
  const Vector u = row(a.constraint), base = row(b.constraint);
  Index pivot = 0;
  base.cwiseAbs().maxCoeff(&pivot);
  if (base[pivot] == 0 || u[pivot] == 0) return std::nullopt;
  const double times = u[pivot] / base[pivot];
  Vector rounded = u - times * base;
  const Vector part = rounded.cwiseAbs();
  if (part.maxCoeff() > part_implied * std::abs(u[pivot])) return std::nullopt;
  const double slack = rounded.dot(x) + times * b.s - a.s;
  rounded = part;
  const auto add = [&](const auto& entries, double by) {
    for (const auto& [i, slot] : entries) {
      if (equations_.tape.is_constant(equations_.program.node(slot))) continue;
      rounded[i] += by * magnitude_.at(slot, 0);
      if (i == pivot) rounded += u.cwiseAbs();
    }
  };
  add(of_a, 1);
  add(of_b, std::abs(times));
  if (std::abs(times) != 1) rounded += u.cwiseAbs();
  const double terms = std::abs(a.s) + a.rate + std::abs(times) * (std::abs(b.s) + b.rate);
  return Slack{slack, rounding_of_operations(k) * (terms + of.along(rounded)), times};
}

}  // namespace mechanics::inline motions
