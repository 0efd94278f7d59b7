#include "convex/nearest_point/active_set/active_set.hpp"

#include <cmath>
#include <utility>

#include "convex/infinity.hpp"
#include "convex/nearest_point/active_set/active_set_answer.hpp"
#include "convex/nearest_point/active_set/degenerate_rows.hpp"
#include "convex/nearest_point/active_set/gram_method.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/working_set/dependent_row.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline dual_active_set {
namespace {

/// Roundings of the terms of w that it carries; a violation below is left to the check in twice the
/// precision.
constexpr double rounding_of_w = 8 * unit_roundoff;

/// Changes of the working set after a refinement before the method gives up, beyond one for each row, and
/// before it blames doubles.
constexpr Index most_rounds = 100, patient_rounds = 4;

class DualActiveSet {
 public:
  using Split = WorkingSet::Split;

  DualActiveSet(const NearestPointProblem& problem, const Accuracy& accuracy)
      : problem_(problem),
        accuracy_(accuracy),
        set_(problem),
        row_scale_(problem.U.lengths(problem.A.diagonal().cwiseInverse())),
        two_sided_(marked(problem.rows(), problem.two_sided)),
        passed_(two_sided_.size(), false) {}

  Solution run(const std::vector<Index>& guess) {
    if (!hold_two_sided()) return infeasible();
    start(guess);
    return settle(
        accuracy_.step_limit > 0 ? accuracy_.step_limit : 100 + 10 * (problem_.rows() + problem_.dimension()),
        most_rounds + problem_.rows());
  }

  Solution run_near(const std::vector<Index>& rows, const Vector& lambda, Index most_changes) {
    if (!hold_two_sided()) return infeasible();
    for (Index p : rows) take_in_with_multiplier(set_, p, lambda[p], split_);
    const Index most = steps_ + most_changes;
    finish_change();
    return settle(steps_, most + 1 - steps_);
  }

 private:
  enum class Outcome { unchanged, changed, infeasible };

  Solution infeasible() const {
    return infeasible_answer(problem_, farkas_, set_.scale(), steps_, accuracy_);
  }

  /// Goes on until nothing is wrong after a refinement. limit: of steps up to which doubles go on by
  /// themselves; rounds: of refinements, each with a change.
  Solution settle(Index limit, Index rounds) {
    RefinedPoint refined;
    for (Index round = 0; round < rounds; ++round) {
      if (!descend(limit)) return infeasible();
      refined = refine(set_);
      // Should doubles and refinement contradict each other in turn, doubles are trusted less and less.
      if (refined.contraction < 1)
        seen_noise_ = round < patient_rounds ? std::max(seen_noise_, refined.first) : 2 * w_noise_;
      if (!(refined.contraction < 1)) return answer(refined, false);
      if (drop_negative(refined)) continue;
      const Outcome outcome = admit_violated(refined);
      if (outcome == Outcome::infeasible) return infeasible();
      if (outcome == Outcome::unchanged && !let_weak_go(refined)) return answer(refined, true);
    }
    set_.solve();
    return answer(refine(set_), false);
  }

  /// Judges what rounding may have done to w (`w_noise_`): the sums of its terms, and R⁻ᵀs, which the
  /// condition of S amplifies; and what a refinement has seen, which has the condition of A in it.
  void judge_noise() {
    double terms = set_.w_free().norm() + set_.w().norm();
    for (Index k = 0; k < set_.size(); ++k) terms += std::abs(set_.lambda()[k]) * set_.factor().length(k);
    row_condition_ = std::max(1.0, set_.factor().inverse_norm());
    w_noise_ = std::max(seen_noise_, rounding_of_w * terms * row_condition_);
  }

  /// What that does to any lambda_k |v_k|.
  double multiplier_noise() const { return w_noise_ * row_condition_; }

  /// False when the two-sided rows contradict each other.
  bool hold_two_sided() {
    set_.append_block(problem_.two_sided, block_dependence);
    bool is_solved = false;  // what rounding makes of a gap is relative to the motion that the rows ask for
    for (Index p : problem_.two_sided) {
      if (set_.holds(p)) continue;
      set_.split(p, split_);
      if (split_.rho > 0) {
        set_.append(p, split_, 0);
        is_solved = false;
        continue;
      }
      if (!std::exchange(is_solved, true)) set_.solve();
      if (const double gap = contradiction(set_, p, split_); std::abs(gap) > 0) {
        farkas_ = contradiction_weights(set_, p, split_, gap > 0 ? 1 : -1);
        return false;
      }
    }
    set_.solve();
    judge_noise();
    return true;
  }

  /// Drops rows with negative multipliers, the most negative first, until none is left.
  void drop_until_dual_feasible() {
    while (true) {
      set_.solve();
      judge_noise();
      const Index worst = most_negative(set_, set_.lambda(), multiplier_noise());
      if (worst < 0) break;
      set_.remove(worst);
      ++steps_;
    }
    for (Index k = 0; k < set_.size(); ++k)
      if (set_.one_sided(k)) set_.lambda()[k] = std::max(0.0, set_.lambda()[k]);
  }

  /// One-sided rows outside S with u_a·q < s_a beyond what rounding may make of a zero.
  std::vector<Index> violated_rows() {
    slack_ = problem_.U.times(set_.point()) - problem_.s;
    std::vector<Index> rows;
    for (Index a = 0; a < problem_.rows(); ++a) {
      const double zero = row_scale_[a] * w_noise_ + rounding_of_w * std::abs(problem_.s[a]);
      const auto i = at(a);
      if (slack_[a] < -zero && !set_.holds(a) && !two_sided_[i] && !passed_[i]) rows.push_back(a);
    }
    return rows;
  }

  void sort_by_violation(std::vector<Index>& rows) const {
    const auto depth = [&](Index a) {
      return slack_[a] / std::max(row_scale_[a], std::numeric_limits<double>::min());
    };
    std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return depth(a) < depth(b); });
  }

  /// Takes in the rows guessed, as far as they are independent with multipliers >= 0.
  void start(std::vector<Index> rows) {
    std::erase_if(rows, [&](Index a) { return two_sided_[at(a)]; });
    set_.append_block(rows, block_dependence);
    steps_ += static_cast<Index>(rows.size());
    drop_until_dual_feasible();
  }

  /// Steps of Goldfarb and Idnani in doubles until no row is violated beyond rounding, or the limit is
  /// reached. False when a violated row cannot be satisfied.
  bool descend(Index limit) {
    while (steps_ < limit) {
      std::vector<Index> rows = violated_rows();
      if (rows.empty()) return true;
      sort_by_violation(rows);
      bool moved = false;
      for (Index p : rows) {
        set_.split(p, split_);
        if (-slack_[p] <= w_noise_ * split_.length) continue;
        const Outcome outcome = admit(p, -slack_[p], w_noise_);
        if (outcome == Outcome::infeasible) return false;
        if (outcome == Outcome::changed) {
          moved = true;
          break;
        }
      }
      if (!moved) return true;
    }
    return true;
  }

  /// Takes in the violated row p, whose split is at hand, dropping the rows that block it on the way.
  Outcome admit(Index p, double violation, double w_noise) {
    double multiplier = 0;
    bool changed = false;
    while (true) {
      const bool dependent = !(split_.rho > 0);
      if (dependent) {
        const double gap = contradiction(set_, p, split_);
        // A row that is not quite a combination of S takes the place of one that can give way: where nothing
        // else stops them that is a step of rounding, else the next rows tell.
        const bool takes_place = w_noise == 0 && !changed && !is_exact_combination(set_, split_);
        if (gap > 0 || !takes_place || blocking_row(set_, split_).place < 0) violation = gap;
        if (!(violation > 0)) {
          // Consistent with S to rounding: it holds as well as S does.
          passed_[at(p)] = true;
          flat_vertex_ = flat_vertex_ || is_flat_vertex(set_, split_);
          left_outside_ += split_.rest / split_.length;
          return changed ? finish_change() : Outcome::unchanged;
        }
      }
      const double full = dependent ? infinity : violation / (split_.rho * split_.rho);
      const auto [blocking, partial] = blocking_row(set_, split_);
      if (full == infinity && partial == infinity) {
        farkas_ = contradiction_weights(set_, p, split_, 1);
        return Outcome::infeasible;
      }
      const double step = std::min(full, partial);
      set_.lambda().head(set_.size()) -= step * split_.coefficients.head(set_.size());
      multiplier += step;
      if (!dependent) {
        set_.w() += step * split_.direction;
        violation -= step * split_.rho * split_.rho;
      }
      ++steps_;
      changed = true;
      if (full <= partial) {
        set_.append(p, split_, multiplier);
        return finish_change();
      }
      set_.remove(blocking);
      set_.split(p, split_);
      if (violation <= w_noise * split_.length) {
        // Both steps end here as far as rounding tells: the row stays, with the multiplier that it has
        // gained.
        if (split_.rho > 0) set_.append(p, split_, multiplier);
        return finish_change();
      }
    }
  }

  Outcome finish_change() {
    drop_until_dual_feasible();
    std::fill(passed_.begin(), passed_.end(), false);
    flat_vertex_ = false;
    left_outside_ = 0;
    return Outcome::changed;
  }

  /// Drops the row whose refined multiplier is most negative; false when there is none.
  bool drop_negative(const RefinedPoint& refined) {
    const Index worst = most_negative(set_, refined);
    if (worst < 0) return false;
    set_.remove(worst);
    ++steps_;
    return finish_change() == Outcome::changed;
  }

  /// Lets rows with multipliers that are 0 for all that S's condition tells go, once: their slacks say more.
  bool let_weak_go(const RefinedPoint& refined) {
    if (problem_.radii || std::exchange(weak_went_, true)) return false;
    const Index before = set_.size();
    for (Index k = before - 1; k >= 0; --k)
      if (set_.one_sided(k) && refined.lambda.hi[k] <= 0) set_.remove(k);
    return set_.size() < before && finish_change() == Outcome::changed;
  }

  /// Takes in a row that the refined point violates.
  Outcome admit_violated(RefinedPoint& refined) {
    slack_ = refined_slacks(set_, refined, row_scale_);
    const double left = refined.remaining();
    std::vector<Index> rows;
    for (Index a = 0; a < problem_.rows(); ++a)
      if (slack_[a] < 0 && !two_sided_[at(a)]) rows.push_back(a);
    sort_by_violation(rows);
    for (Index p : rows) {
      if (passed_[at(p)]) continue;
      set_.split(p, split_);
      if (split_.rho > 0 && -slack_[p] <= 2 * left * split_.length) continue;
      set_.lambda().head(set_.size()) = refined.lambda.hi;
      const Outcome outcome = admit(p, -slack_[p], 0);
      if (outcome != Outcome::unchanged) return outcome;
    }
    return Outcome::unchanged;
  }

  Solution answer(const RefinedPoint& refined, bool finished) {
    if (!finished || slack_.size() != problem_.rows()) slack_ = problem_.U.times(refined.q.hi) - problem_.s;
    const std::string_view open =
        finished ? decide_degenerate_rows(set_, refined, row_scale_, slack_) : open_question::conditioning;
    const bool is_kept = open.empty() || open == open_question::zero_slacks;
    const double outside = is_kept ? 0 : finished && !flat_vertex_ ? left_outside_ : infinity;
    Solution solution = certified_answer(set_, refined, slack_, row_scale_, outside, accuracy_, steps_);
    solution.undecided = open;
    return solution;
  }

  const NearestPointProblem& problem_;
  const Accuracy accuracy_;
  WorkingSet set_;
  Vector row_scale_;  // ||u_a||_(D⁻¹), D the diagonal of A: a length that costs n instead of n²
  std::vector<bool> two_sided_, passed_;
  Vector slack_, farkas_;
  Split split_;
  bool flat_vertex_ = false, weak_went_ = false;
  Index steps_ = 0;
  // left_outside_: parts of the rows passed over that S does not span
  double w_noise_ = 0, seen_noise_ = 0, row_condition_ = 1, left_outside_ = 0;
};

}  // namespace

Solution active_set_near(const NearestPointProblem& problem, const std::vector<Index>& rows,
                         const Vector& lambda, Index most_changes) {
  return DualActiveSet(problem, {.limit = 0}).run_near(rows, lambda, most_changes);
}

Solution active_set_of_valid(const NearestPointProblem& problem, const Accuracy& accuracy,
                             const std::vector<Index>& guess) {
  GramOutcome quick = solve_by_gram_matrix(problem, accuracy, guess);
  if (quick.is_answer) return with_open_signs(problem, std::move(quick.solution), accuracy);
  Solution found = DualActiveSet(problem, accuracy).run(quick.rows);
  if (found.undecided.empty() && (found.status == Status::inaccurate || found.status == Status::gave_up))
    found.undecided = open_question::conditioning;
  return with_open_signs(problem, decided_in_fractions(problem, std::move(found), accuracy), accuracy);
}

}  // namespace convex::inline dual_active_set
