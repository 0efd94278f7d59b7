#include "convex/nearest_point/isotonic/bordered_chain.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/isotonic/peeling.hpp"
#include "convex/nearest_point/isotonic/pooling.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/solve_watch.hpp"

namespace convex::inline isotonic {
namespace {

/// Rows that may be left over, and coordinates that there must be for each: with fewer, other methods are as
/// fast.
constexpr Index most_border = 16, coordinates_per_row = 24;
/// Poolings in doubles, and in twice the precision, before the structure is given up.
constexpr int most_poolings = 120, most_refinements = 12;
/// Added to the curvature, relative to that of the border without strings: where pools hold a row it has
/// none.
constexpr double rough_ridge = 1e-11, fine_ridge = 1e-12;
/// A line search ends where the slope is this part of the first; how far a step too short or too long may
/// change.
constexpr double flat = 0.1, longer = 64;
/// In doubles the border is met when it would move q by less than this part of the scale.
constexpr double nearly_met = 1e-11;
/// At the end, relative to the scale: what is left of the border, in the length of its rows, and the last
/// correction. Rows of the border closer to dependence than `least_angle` would hide more than the bound
/// says.
constexpr double met = 0x1p-84, enough = 0x1p-66, least_angle = 0x1p-27;

/// The solution that q, known in twice the working precision but for `missing` (in the norm of A), and its
/// multipliers make: slacks, residuals, bound and status. A slack that `missing` and the rounding of sums
/// could hide has the sign that `sign_of` finds for its row; it is `undecided` where that finds none. `basis`
/// is left empty.
Solution string_answer(const NearestPointProblem& problem, const Accuracy& accuracy,
                       const DoubleDoubleVector& q, Vector lambda, double missing,
                       const std::function<std::optional<int>(Index)>& sign_of) {
  const Vector& d = problem.A.diagonal();
  Solution found;
  found.q = q.hi;
  found.lambda = std::move(lambda);
  found.slack = Vector::Zero(problem.rows());
  found.acceleration_norm = std::sqrt(found.q.cwiseAbs2().dot(d));
  found.force_norm = std::sqrt(problem.z.cwiseAbs2().cwiseQuotient(d).sum());
  // Sums of n terms in twice the precision.
  const double scale = std::max(found.acceleration_norm, found.force_norm), n = static_cast<double>(q.size()),
               sums = 8 * unit_roundoff * unit_roundoff * n * scale;
  const Vector unit = d.cwiseSqrt().cwiseInverse();
  for (Index a = 0; a < problem.rows(); ++a) {
    if (std::abs(found.lambda[a]) > 0) continue;
    found.slack[a] = std::max(0.0, slack(problem, a, q).value());
    if (found.slack[a] > (missing + sums) * problem.U.absolute_dot(a, unit)) continue;
    const std::optional<int> sign = sign_of(a);
    if (!sign) found.undecided = open_question::degenerate_rows;
    found.slack[a] =
        sign && *sign > 0 ? std::max(found.slack[a], std::numeric_limits<double>::denorm_min()) : 0;
  }
  found.residuals = residuals(problem, found);
  found.rounding = std::sqrt(q.lo.cwiseAbs2().dot(d));
  found.error_bound = found.rounding + missing + sums;
  found.status = found.is_within(accuracy) && found.undecided.empty() ? Status::solved : Status::inaccurate;
  return found;
}

class BorderedChain {
 public:
  BorderedChain(const NearestPointProblem& problem, const Strings& strings)
      : problem_(problem),
        strings_(strings),
        pooling_(problem, strings),
        count_(static_cast<Index>(strings.border.size())),
        place_(strings.coordinate.size()),
        linear_(problem.z),
        rest_(Vector::Zero(problem.dimension())),
        mu_(count_),
        length_(problem.U.lengths(problem.A.diagonal().cwiseInverse())) {
    for (std::size_t k = 0; k < place_.size(); ++k) place_[at(strings.coordinate[k])] = static_cast<int>(k);
    for (Index a : strings.border) two_sided_.push_back(problem.is_two_sided(a));
  }

  bool solve() { return approach() && refine(); }

  Solution answer(const Accuracy& accuracy) const {
    Vector lambda = pooling_.lambda();
    for (Index b = 0; b < count_; ++b) lambda[row(b)] = mu_.hi[b];
    std::vector<int> place_of_row(at(problem_.rows()), -1);
    for (std::size_t k = 0; k < strings_.row.size(); ++k)
      if (strings_.row[k] >= 0) place_of_row[at(strings_.row[k])] = static_cast<int>(k);
    const auto sign_of = [&](Index a) -> std::optional<int> {
      const int k = place_of_row[at(a)];
      return k < 0 ? std::nullopt : pooling_.rise_below(k, linear_, rest_);
    };
    Solution found = string_answer(problem_, accuracy, pooling_.q(), std::move(lambda),
                                   missing_ + pooling_.rounding(), sign_of);
    found.method = "bordered-chain";
    for (Index a = 0; a < problem_.rows(); ++a)
      if (std::abs(found.lambda[a]) > 0) found.basis.push_back(a);
    if (!rows_left_by_peeling(problem_.U, found.basis).empty()) found.basis.clear();  // they may be dependent
    found.steps = poolings_;
    const double n = static_cast<double>(problem_.dimension());
    found.model.islands = {
        {found.method, problem_.dimension(), problem_.rows(), 0, 8 * n * static_cast<double>(poolings_), 0}};
    return found;
  }

 private:
  Index row(Index b) const { return strings_.border[at(b)]; }

  /// The linear term with the border's multipliers, as pairs.
  void load(const DoubleDoubleVector& mu) {
    for (Index b = 0; b < count_; ++b)
      for (SparseRows::InnerIterator it(problem_.U.sparse(), row(b)); it; ++it) {
        linear_[it.col()] = problem_.z[it.col()];
        rest_[it.col()] = 0;
      }
    for (Index b = 0; b < count_; ++b)
      for (SparseRows::InnerIterator it(problem_.U.sparse(), row(b)); it; ++it)
        accumulate_product(it.value(), mu[b], linear_[it.col()], rest_[it.col()]);
    for (Index b = 0; b < count_; ++b)
      for (SparseRows::InnerIterator it(problem_.U.sparse(), row(b)); it; ++it) {
        const DoubleDouble tidy = two_sum(linear_[it.col()], rest_[it.col()]);
        linear_[it.col()] = tidy.hi;
        rest_[it.col()] = tidy.lo;
      }
  }

  /// s - Uq on the border with the strings solved in doubles.
  Vector gradient(const Vector& mu) {
    load(DoubleDoubleVector(mu));
    pooling_.pool(linear_);
    pooling_.place(q_);
    ++poolings_;
    SolveWatch::tell("bordered-chain", poolings_);
    Vector left(count_);
    for (Index b = 0; b < count_; ++b) {
      double reach = 0;
      for (SparseRows::InnerIterator it(problem_.U.sparse(), row(b)); it; ++it)
        reach += it.value() * q_[it.col()];
      left[b] = problem_.s[row(b)] - reach;
    }
    return left;
  }

  /// The curvature of the dual function: Σ over pools off the floor of their sums of the border's entries,
  /// squared, over their weights.
  Matrix curvature(double ridge) const {
    struct Entry {
      std::size_t pool;
      Index b;
      double value;
    };
    const std::vector<Pooling::Pool>& pools = pooling_.pools();
    std::vector<Entry> entries;
    for (Index b = 0; b < count_; ++b)
      for (SparseRows::InnerIterator it(problem_.U.sparse(), row(b)); it; ++it) {
        const auto after = std::upper_bound(pools.begin(), pools.end(), place_[at(it.col())],
                                            [](int k, const Pooling::Pool& pool) { return k < pool.begin; });
        entries.push_back({at(after - pools.begin()) - 1, b, it.value()});
      }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& x, const Entry& y) { return x.pool < y.pool; });
    Matrix H = Matrix::Zero(count_, count_);
    for (std::size_t first = 0; first < entries.size();) {
      const std::size_t pool = entries[first].pool;
      Vector sum = Vector::Zero(count_), size = Vector::Zero(count_);
      for (; first < entries.size() && entries[first].pool == pool; ++first) {
        sum[entries[first].b] += entries[first].value;
        size[entries[first].b] += std::abs(entries[first].value);
      }
      for (Index b = 0; b < count_; ++b)
        if (std::abs(sum[b]) <= 8 * unit_roundoff * size[b]) sum[b] = 0;
      if (!pooling_.is_lifted(pool)) H += sum * sum.transpose() / pools[pool].weight;
    }
    for (Index b = 0; b < count_; ++b) H(b, b) += ridge * length_[row(b)] * length_[row(b)];
    return H;
  }

  /// The step d that maximises left·d - ½ d·Hd with mu + d >= 0 on one-sided rows.
  bool step(const Vector& left, const Matrix& H, const Vector& mu, Vector& d) const {
    std::vector<Index> bounded;
    for (Index b = 0; b < count_; ++b)
      if (!two_sided_[at(b)]) bounded.push_back(b);
    const Index m = static_cast<Index>(bounded.size());
    RowMatrix U = RowMatrix::Zero(m, count_);
    Vector s(m);
    for (Index j = 0; j < m; ++j) {
      U(j, bounded[at(j)]) = 1;
      s[j] = -mu[bounded[at(j)]];
    }
    const Solution found =
        active_set({Metric::dense(H), left, ConstraintRows(std::move(U)), s, {}}, {.limit = 0});
    if (found.status != Status::solved && found.status != Status::inaccurate) return false;
    d = found.q;
    // Which bounds hold is settled. They hold without rounding, and the rest is small beside what they bear.
    std::vector<bool> holds(at(count_), false);
    for (Index j : found.basis) {
      d[bounded[at(j)]] = s[j];
      holds[at(bounded[at(j)])] = true;
    }
    std::vector<Index> rest, held;
    for (Index b = 0; b < count_; ++b) (holds[at(b)] ? held : rest).push_back(b);
    const Vector load = left(rest) - H(rest, held) * d(held);
    if (!rest.empty()) d(rest) = Metric::dense(H(rest, rest)).solve(load);
    return d.allFinite();
  }

  bool approach() {
    Vector mu = Vector::Zero(count_), left = gradient(mu), d;
    const double z_norm = problem_.A.dual_norm(problem_.z);
    while (true) {
      const Matrix H = curvature(rough_ridge);
      if (!step(left, H, mu, d)) return false;
      const double slope = left.dot(d), scale = std::max(problem_.A.norm(q_), z_norm);
      if (std::sqrt(std::max(0.0, d.dot(H * d))) <= nearly_met * scale || !(slope > 0)) break;
      // The slope along d falls in pieces of straight lines; its zero lies between `low` and `high`, and is
      // found by Newton's method there.
      double low = 0, high = INFINITY, t = 1;
      double longest = INFINITY;
      for (Index b = 0; b < count_; ++b)
        if (!two_sided_[at(b)] && d[b] < 0) longest = std::min(longest, std::max(1.0, -mu[b] / d[b]));
      while (true) {
        if (poolings_ > most_poolings) return false;
        left = gradient(clipped(mu + t * d));
        const double now = left.dot(d);
        if (std::abs(now) <= flat * slope || (now > 0 && t >= longest)) break;
        (now > 0 ? low : high) = t;
        const double next = t + now / d.dot(curvature(rough_ridge) * d);
        if (high < INFINITY)
          t = next > low && next < high ? next : low > 0 ? std::sqrt(low * high) : high / longer;
        else
          t = std::min({std::max(next, 2 * t), longer * t, longest});
        if (!(t > low && t < high)) break;
      }
      mu = clipped(mu + t * d);
    }
    mu_ = DoubleDoubleVector(mu);
    return true;
  }

  Vector clipped(Vector mu) const {
    for (Index b = 0; b < count_; ++b)
      if (!two_sided_[at(b)]) mu[b] = std::max(0.0, mu[b]);
    return mu;
  }

  /// Newton steps with q in twice the precision.
  bool refine() {
    Vector left(count_), d;
    for (int k = 0; k < most_refinements; ++k, ++poolings_) {
      load(mu_);
      pooling_.pool(linear_);
      pooling_.refine(linear_, rest_);
      const DoubleDoubleVector& q = pooling_.q();
      const double scale = std::max(problem_.A.norm(q.hi), problem_.A.dual_norm(problem_.z));
      double most = 0;
      for (Index b = 0; b < count_; ++b) {
        left[b] = -slack(problem_, row(b), q).value();
        const bool active = two_sided_[at(b)] || mu_.hi[b] > 0;
        const double length = length_[row(b)];
        if (length > 0) most = std::max(most, (active ? std::abs(left[b]) : left[b]) / length);
      }
      const Matrix H = curvature(fine_ridge);
      if (!step(left, H, mu_.hi, d)) return false;
      const double last = std::sqrt(std::max(0.0, d.dot(H * d)));
      missing_ = 2 * last + most / least_angle;
      if (most <= met * scale && last <= enough * scale) return true;
      for (Index b = 0; b < count_; ++b) {
        const bool gone = !two_sided_[at(b)] && d[b] <= -mu_.hi[b];
        const DoubleDouble sum = gone ? DoubleDouble{} : add(mu_[b], {d[b], 0});
        mu_.hi[b] = sum.hi;
        mu_.lo[b] = sum.lo;
      }
    }
    return false;
  }

  const NearestPointProblem& problem_;
  const Strings& strings_;
  Pooling pooling_;
  Index count_;
  std::vector<int> place_;  // of a coordinate among the strings
  std::vector<bool> two_sided_;
  Vector linear_, rest_, q_;
  DoubleDoubleVector mu_;
  Vector length_;
  Index poolings_ = 0;
  double missing_ = 0;
};

}  // namespace

std::optional<Solution> solve_bordered_chain(const NearestPointProblem& problem, const Accuracy& accuracy) {
  const Strings strings = find_strings(problem, most_border);
  const Index border = static_cast<Index>(strings.border.size());
  if (strings.count() == 0 || border == 0 || problem.dimension() < coordinates_per_row * (1 + border))
    return std::nullopt;
  BorderedChain chain(problem, strings);
  if (!chain.solve()) return std::nullopt;
  Solution found = chain.answer(accuracy);
  if (found.status != Status::solved) return std::nullopt;
  return found;
}

}  // namespace convex::inline isotonic
