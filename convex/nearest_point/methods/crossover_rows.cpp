#include "convex/nearest_point/methods/crossover_rows.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/nearest_point/active_set/degenerate_rows.hpp"
#include "convex/nearest_point/active_set/dependent_row.hpp"
#include "convex/nearest_point/active_set/refined_slacks.hpp"

namespace convex::inline algorithms {
namespace {

class Polish {
 public:
  using Set = WorkingSet;
  using Split = Set::Split;

  Polish(const NearestPointProblem& problem, const Vector& row_scale)
      : problem_(problem),
        row_scale_(row_scale),
        set_(problem),
        two_sided_(marked(problem.rows(), problem.two_sided)) {}

  Holding run(const Vector& q, const Vector& lambda, Index most_changes) {
    for (Index p : problem_.two_sided) {
      set_.split(p, split_);
      if (split_.rho > 0) set_.append(p, split_, lambda[p]);
    }
    set_.fix();
    for (Index p : active(q, lambda)) take_in(p, lambda[p]);
    for (Index change = 0; change <= most_changes; ++change) {
      set_.solve();
      RefinedPoint refined = refine(set_);
      if (!(refined.contraction < 1) || !std::isfinite(refined.remaining())) return found_;
      if (drop_negative(refined)) continue;
      slack_ = refined_slacks(set_, refined, row_scale_);
      if (admit_violated(refined)) continue;
      if (found_.farkas.size() > 0) return found_;
      std::string_view open;
      if (!problem_.radii) {
        open = decide_degenerate_rows(set_, refined.q, row_scale_, slack_);
        if (open.empty()) contradiction_ = moved_edge_ = 0;
      }
      found_.held = held(refined);
      found_.held->undecided = open;
      return found_;
    }
    return found_;
  }

 private:
  /// One-sided rows that look active, the most loaded first.
  std::vector<Index> active(const Vector& q, const Vector& lambda) const {
    const Vector slack = problem_.U.times(q) - problem_.s;
    std::vector<Index> rows;
    for (Index a = 0; a < problem_.rows(); ++a)
      if (!two_sided_[at(a)] && row_scale_[a] > 0 && lambda[a] > 0 &&
          lambda[a] * row_scale_[a] > slack[a] / row_scale_[a])
        rows.push_back(a);
    std::stable_sort(rows.begin(), rows.end(),
                     [&](Index a, Index b) { return lambda[a] * row_scale_[a] > lambda[b] * row_scale_[b]; });
    return rows;
  }

  /// Takes in row p with its multiplier; while it depends on S, the multiplier moves over to S, from which
  /// the row that comes to 0 first is dropped.
  void take_in(Index p, double multiplier) {
    set_.split(p, split_);
    while (!(split_.rho > 0)) {
      const auto [blocking, step] = blocking_row(set_, split_, -1, multiplier);
      set_.lambda().head(set_.size()) += step * split_.coefficients.head(set_.size());
      multiplier -= step;
      if (blocking < 0) return;
      set_.remove(blocking);
      set_.split(p, split_);
    }
    set_.append(p, split_, multiplier);
  }

  bool drop_negative(const RefinedPoint& refined) {
    const Index worst = most_negative(set_, refined);
    if (worst >= 0) set_.remove(worst);
    return worst >= 0;
  }

  /// Takes in the most violated row that S does not span.
  bool admit_violated(const RefinedPoint& refined) {
    std::vector<Index> rows;
    contradiction_ = moved_edge_ = 0;
    for (Index a = 0; a < problem_.rows(); ++a)
      if (slack_[a] < 0 || (two_sided_[at(a)] && slack_[a] != 0)) rows.push_back(a);
    std::sort(rows.begin(), rows.end(),
              [&](Index a, Index b) { return slack_[a] * row_scale_[b] < slack_[b] * row_scale_[a]; });
    for (Index p : rows) {
      set_.split(p, split_);
      const bool spanned = !(split_.rho > 0);
      if (spanned && !(std::abs(contradiction(set_, p, split_)) > 0)) {
        // Where rows that are flat to rounding meet, their edge may be far away.
        contradiction_ = is_flat_vertex(set_, split_)
                             ? infinity
                             : std::max(contradiction_, std::abs(slack_[p]) / split_.length);
        count_moved_edge(p);
        continue;
      }
      if (spanned && two_sided_[at(p)]) {
        found_.farkas = contradiction_weights(set_, p, split_, slack_[p] < 0 ? 1 : -1);
        return false;
      }
      if (two_sided_[at(p)]) continue;
      if (!spanned && -slack_[p] <= 2 * refined.remaining() * split_.length) {
        count_moved_edge(p);
        continue;
      }
      for (Index k = 0; k < set_.size(); ++k)
        set_.lambda()[k] = set_.one_sided(k) ? std::max(0.0, refined.lambda.hi[k]) : refined.lambda.hi[k];
      return exchange(p);
    }
    return false;
  }

  /// How far the violation of row p, taken for 0, leaves the point from the edge of that row and S.
  void count_moved_edge(Index p) {
    if (split_.rest > exact_dependence * split_.magnitude)
      moved_edge_ = std::max(moved_edge_, std::abs(slack_[p]) / split_.rest);
  }

  /// Takes in the violated row p; where S spans it, the row that blocks first goes. False when none does:
  /// then the rows contradict each other.
  bool exchange(Index p) {
    while (!(split_.rho > 0)) {
      const auto [blocking, step] = blocking_row(set_, split_);
      if (blocking < 0) {
        found_.farkas = contradiction_weights(set_, p, split_, 1);
        return false;
      }
      set_.lambda().head(set_.size()) -= step * split_.coefficients.head(set_.size());
      set_.remove(blocking);
      set_.split(p, split_);
    }
    set_.append(p, split_, 0);
    return true;
  }

  HeldRows held(const RefinedPoint& refined) const {
    HeldRows found{set_.rows(), refined.q, Vector::Zero(problem_.rows()), slack_};
    for (Index k = 0; k < set_.size(); ++k) found.lambda[set_.rows()[at(k)]] = refined.lambda.hi[k];
    found.remaining = refined.remaining() + refined.dropped + moved_edge_;
    found.inverse_norm = set_.factor().inverse_norm();
    found.contradiction = contradiction_;
    return found;
  }

  const NearestPointProblem& problem_;
  const Vector& row_scale_;
  Set set_;
  Split split_;
  std::vector<bool> two_sided_;
  Vector slack_;
  double contradiction_ = 0, moved_edge_ = 0;
  Holding found_;
};

}  // namespace

Holding hold_active_rows(const NearestPointProblem& problem, const Vector& q, const Vector& lambda,
                         const Vector& row_scale, Index most_changes) {
  return Polish(problem, row_scale).run(q, lambda, most_changes);
}

}  // namespace convex::inline algorithms
