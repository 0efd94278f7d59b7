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

/// Columns of A found in one sweep.
constexpr std::size_t lanes_at_once = 8;

}  // namespace

/// A = ∂p/∂q', by columns.
void Expansion::find_inertia() {
  const Index n = coordinates();
  const auto lanes = std::min(lanes_at_once, static_cast<std::size_t>(n));
  // What depends on velocities is filled in by each sweep, and all else stays 0.
  columns_.resize(series_.series() * lanes);
  const bool is_small = n <= small_system;
  if (is_small) found_.resize(n, n);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index first = 0; first < n; first += static_cast<Index>(lanes)) {
    const Index count = std::min(static_cast<Index>(lanes), n - first);
    const auto seed = [&](double one) {
      for (Index l = 0; l < count; ++l)
        columns_[equations_.program.velocity(index(first + l)) * lanes + index(l)] = one;
    };
    seed(1);
    series_.carry(columns_, lanes);
    for (Index i = 0; i < n; ++i)
      for (Index l = 0; l < count; ++l)
        if (const double a = columns_[equations_.momentum[index(i)] * lanes + index(l)]; is_small)
          found_(i, first + l) = a;
        else if (a != 0)
          entries.emplace_back(i, first + l, a);
    seed(0);
  }
  if (is_small) {
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j) found_(i, j) = found_(j, i) = 0.5 * (found_(i, j) + found_(j, i));
    if (small_.size() == found_.size() && small_ == found_) return;  // and so is all that follows from it
    small_ = found_;
    A_.reset();
    if (!factor_.make(small_)) inertia();
    return;
  }
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
  if (first > Eight::count) find_eight(first - Eight::count);  // the last two orders may lie on both sides
  if (first > 0) find_eight(0);
  of_order.resize(count);
}

}  // namespace mechanics::inline motions
