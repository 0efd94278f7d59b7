#include "convex/nearest_point/structure/chain.hpp"

#include <cmath>

#include "convex/nearest_point/residuals.hpp"

namespace convex {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// A multiplier below this part of the largest sum it was made of is 0.
constexpr double silence = 0x1p-90;

DoubleDouble product(DoubleDouble x, double y) {
  DoubleDouble p = two_product(x.hi, y);
  p.lo += x.lo * y;
  return two_sum(p.hi, p.lo);
}

DoubleDouble negative(DoubleDouble x) { return {-x.hi, -x.lo}; }

DoubleDouble quotient(DoubleDouble x, DoubleDouble y) {
  const double first = x.hi / y.hi;
  const DoubleDouble rest = add(x, negative(product(y, first)));
  return two_sum(first, rest.value() / y.hi);
}

bool less(DoubleDouble x, DoubleDouble y) { return x.hi < y.hi || (x.hi <= y.hi && x.lo < y.lo); }

/// The row above each coordinate and the coordinate that it leads to, and the row below.
struct Strings {
  std::vector<int> next, row_above, row_below, floor;
  std::vector<Index> firsts;  ///< of each string
};

std::optional<Strings> find_strings(const NearestPointProblem& problem) {
  const MetricKind kind = problem.A.kind();
  if ((kind != MetricKind::diagonal && kind != MetricKind::identity) || !problem.U.is_sparse() ||
      !problem.two_sided.empty())
    return std::nullopt;
  const Index n = problem.dimension();
  const SparseRows& U = problem.U.sparse();
  Strings found;
  found.next.assign(at(n), -1);
  found.row_above.assign(at(n), -1);
  found.row_below.assign(at(n), -1);
  found.floor.assign(at(n), -1);
  for (Index a = 0; a < U.rows(); ++a) {
    SparseRows::InnerIterator it(U, a);
    if (!it) return std::nullopt;
    const Index i = it.col();
    const double value = it.value();
    ++it;
    if (!it) {
      if (!(value > 0) || found.floor[at(i)] >= 0) return std::nullopt;
      found.floor[at(i)] = static_cast<int>(a);
      continue;
    }
    const Index j = it.col();
    if (it.value() != -value || !(std::abs(value) > 0)) return std::nullopt;
    ++it;
    if (it) return std::nullopt;
    const Index low = value < 0 ? i : j, high = value < 0 ? j : i;
    if (found.next[at(low)] >= 0 || found.row_below[at(high)] >= 0) return std::nullopt;
    found.next[at(low)] = static_cast<int>(high);
    found.row_above[at(low)] = static_cast<int>(a);
    found.row_below[at(high)] = static_cast<int>(a);
  }
  Index seen = 0;
  for (Index i = 0; i < n; ++i) {
    if (found.row_below[at(i)] >= 0) {
      if (found.floor[at(i)] >= 0) return std::nullopt;
      continue;
    }
    found.firsts.push_back(i);
    for (Index k = i; k >= 0; k = found.next[at(k)]) ++seen;
  }
  if (seen != n) return std::nullopt;  // a ring
  return found;
}

/// Coordinates of a string that move together, y = mean.
struct Pool {
  Index first, count;
  DoubleDouble weight, sum, mean;
};

class ChainSolver {
 public:
  ChainSolver(const NearestPointProblem& problem, const Strings& strings)
      : problem_(problem),
        strings_(strings),
        q_(problem.dimension()),
        lambda_(Vector::Zero(problem.rows())) {}

  void solve_string(Index first) {
    order_.clear();
    offset_.clear();
    pools_.clear();
    DoubleDouble offset{};
    for (Index i = first; i >= 0; i = strings_.next[at(i)]) {
      if (const int row = strings_.row_below[at(i)]; row >= 0) offset = add(offset, bound(row));
      Pool pool{static_cast<Index>(order_.size()), 1, {mass(i), 0}, {}, {}};
      pool.sum = add({problem_.z[i], 0}, negative(product(offset, mass(i))));
      pool.mean = quotient(pool.sum, pool.weight);
      order_.push_back(i);
      offset_.push_back(offset);
      while (!pools_.empty() && !less(pools_.back().mean, pool.mean)) {
        Pool& last = pools_.back();
        last.count += pool.count;
        last.weight = add(last.weight, pool.weight);
        last.sum = add(last.sum, pool.sum);
        last.mean = quotient(last.sum, last.weight);
        pool = last;
        pools_.pop_back();
      }
      pools_.push_back(pool);
    }
    place(strings_.floor[at(first)]);
  }

  Solution solution(const Accuracy& accuracy) && {
    Solution found;
    found.method = "chain";
    found.q = q_.hi;
    found.lambda = std::move(lambda_);
    found.slack = Vector::Zero(problem_.rows());
    for (Index a = 0; a < problem_.rows(); ++a)
      if (!(found.lambda[a] > 0)) {
        const DoubleDouble reach = add(problem_.U.dot(a, q_), {-problem_.s[a], 0});
        const double terms = std::abs(problem_.s[a]) + std::abs(reach.hi);
        found.slack[a] = std::abs(reach.value()) <= silence * terms ? 0 : std::max(0.0, reach.value());
      } else {
        found.basis.push_back(a);
      }
    found.steps = static_cast<Index>(found.basis.size());
    found.acceleration_norm = problem_.A.norm(found.q);
    found.force_norm = problem_.A.dual_norm(problem_.z);
    found.residuals = residuals(problem_, found.q, found.lambda,
                                KnownParts{problem_.U.lengths(problem_.A.diagonal().cwiseInverse()),
                                           found.slack,
                                           {},
                                           found.acceleration_norm,
                                           found.force_norm});
    found.rounding = problem_.A.norm(q_.lo);
    // Sums of n terms in twice the precision.
    const double scale = std::max(found.acceleration_norm, found.force_norm);
    found.error_bound = found.rounding +
                        8 * unit_roundoff * unit_roundoff * static_cast<double>(problem_.dimension()) * scale;
    const bool close = found.error_bound <= accuracy.tolerance * std::max(1.0, found.acceleration_norm);
    found.status = close ? Status::solved : Status::inaccurate;
    const double n = static_cast<double>(problem_.dimension());
    found.model.islands = {{found.method, problem_.dimension(), problem_.rows(), 0, 8 * n, 0}};
    return found;
  }

 private:
  double mass(Index i) const { return problem_.A.diagonal()[i]; }
  double factor(Index row) const {
    return std::abs(problem_.U.sparse().valuePtr()[problem_.U.sparse().outerIndexPtr()[row]]);
  }
  DoubleDouble bound(Index row) const {
    const double c = factor(row);
    if (c == 1) return {problem_.s[row], 0};
    return quotient({problem_.s[row], 0}, {c, 0});
  }

  /// q and multipliers from the pools; a pool below the floor is lifted to it.
  void place(int floor) {
    DoubleDouble push{};  // what the rows below push a pool up with; 0 between pools, but for the floor
    double largest = 0;
    if (floor >= 0) {
      const DoubleDouble least = bound(floor);
      for (Pool& pool : pools_) {
        if (!less(pool.mean, least)) break;
        push = add(push, lift(pool, least));
        pool.mean = least;
      }
      largest = push.hi;
      lambda_[floor] = std::max(0.0, push.value() / factor(floor));
    }
    for (const Pool& pool : pools_) {
      for (Index k = pool.first; k < pool.first + pool.count; ++k) {
        const Index i = order_[at(k)];
        const DoubleDouble x = add(pool.mean, offset_[at(k)]);
        q_.hi[i] = x.hi;
        q_.lo[i] = x.lo;
        const DoubleDouble inertia = product(x, mass(i));
        push = add(push, add({problem_.z[i], 0}, negative(inertia)));
        largest = std::max({largest, std::abs(push.hi), std::abs(inertia.hi)});
        const int row = strings_.row_above[at(i)];
        const bool inside = k + 1 < pool.first + pool.count;
        const bool lifted = floor >= 0 && lambda_[floor] > 0 && !less(bound(floor), pool.mean);
        if (row >= 0 && (inside || lifted))
          lambda_[row] = push.value() > silence * largest ? push.value() / factor(row) : 0;
      }
      if (floor < 0 || less(bound(floor), pool.mean)) {
        push = {};
        largest = 0;
      }
    }
  }

  /// What holds a pool at `level` instead of its own mean.
  static DoubleDouble lift(const Pool& pool, DoubleDouble level) {
    const DoubleDouble whole = two_sum(pool.weight.hi, pool.weight.lo);
    DoubleDouble needed = product(level, whole.hi);
    needed.lo += level.hi * whole.lo;
    return add(needed, negative(pool.sum));
  }

  const NearestPointProblem& problem_;
  const Strings& strings_;
  DoubleDoubleVector q_;
  Vector lambda_;
  std::vector<Index> order_;
  std::vector<DoubleDouble> offset_;
  std::vector<Pool> pools_;
};

}  // namespace

std::optional<Solution> solve_chain(const NearestPointProblem& problem, const Accuracy& accuracy) {
  const std::optional<Strings> strings = find_strings(problem);
  if (!strings || strings->firsts.size() != 1) return std::nullopt;
  ChainSolver solver(problem, *strings);
  solver.solve_string(strings->firsts.front());
  return std::move(solver).solution(accuracy);
}

}  // namespace convex
