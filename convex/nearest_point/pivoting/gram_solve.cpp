#include "convex/nearest_point/pivoting/gram_solve.hpp"

#include <algorithm>
#include <cmath>

#include "convex/dense/dense_kernels.hpp"
#include "convex/nearest_point/optimality/refinement.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
GramSolve::GramSolve(GramWorkingSet& set)
    : set_(set), problem_(set.problem()), p_(set.point()), rows_(p_.all * p_.n, p_.U) {}

bool GramSolve::solve_again(const Accuracy& accuracy, Solution& solution) {
  return set_.settle_again() && answer(accuracy, solution);
}

bool GramSolve::answer(const Accuracy& accuracy, Solution& solution) {
  known_ = Corrections();
  known_.scale = p_.norm();
  moved_ = degenerate_violation_ = 0;
  const double close = accuracy.tolerance * std::max(1.0, p_.acceleration_norm);
  return !accuracy.refine && doubles_do(close) ? write(accuracy, solution)
                                               : correct_until_told(accuracy, solution);
}

/// Whether the answer in doubles is within so much, no row close to tipping over.
bool GramSolve::doubles_do(double close) {
  set_.measure();
  set_held_slacks_apart(p_);
  Index weak = 0;
  double missing = 0;
  for (Index k = 0; k < p_.size; ++k) {
    weak += p_.pull[k] > 0 && !(p_.lambda[k] * p_.length[k] > near_zero * known_.scale);
    missing += p_.held_slack[k] * p_.held_slack[k];
  }
  if (weak > 0 || !is_clear(known_.scale)) return false;
  set_.measure_balance();
  const double condition = p_.factor_condition * (1 + std::sqrt(p_.gram_condition));
  known_.bound = bound_of_doubles(p_.n, p_.size, p_.stationarity, p_.inverse_norm * std::sqrt(missing),
                                  condition * (known_.scale + p_.magnitude));
  return known_.bound <= close;
}

/// Whether no row outside is close, of ||q||_A or that size if it is larger.
bool GramSolve::is_clear(double size) {
  return close_rows(near_zero, near_zero * std::max(size, p_.magnitude) + known_.missing_slack(1), 0) == 0;
}

/// Corrects the point of the working set until all is told. What multipliers and slacks are wrong then, by
/// rounding, is the scale of a problem of the same kind, for those that are that small: pivoting goes on
/// there, on the same Gram matrix, until nothing is wrong. Those that doubles leave open at once have a part
/// in the first correction (`near_scale`). False when something is in doubt.
bool GramSolve::correct_until_told(const Accuracy& accuracy, Solution& solution) {
  constexpr double room_for_change = 256;  // wrong numbers and those up to so many times them change sides
  constexpr double small_in_doubles =
      0x1p-36;                        // of the scale: violations that do not count in doubles are less
  constexpr double plenty = 0x1p-76;  // corrections are cheap here: so little of the scale is to be left
  constexpr int most_more = 3;        // corrections beyond what is enough, for entries that are close to 0
  constexpr int most_passes = 12;     // before pivoting has lost its way
  double small = near_scale(small_in_doubles);
  int more = most_more;
  for (int pass = 0; pass < most_passes; ++pass) {
    if (!set_.correct(pass == 0, small) || !known_.note(p_)) return false;
    small = 0;
    if (!(known_.remaining <= plenty * known_.scale)) continue;
    known_.wrong = 0;
    if (!known_.take_noise_for_zero(p_, more > 0)) {
      more -= 1;
      continue;
    }
    if (measure_slacks() == Slacks::doubtful) return false;
    if (known_.wrong > 0) {
      small = room_for_change * known_.wrong;
      continue;
    }
    set_.measure_balance();
    return write(accuracy, solution);
  }
  return false;
}

/// This part of the scale where multipliers (times lengths) or slacks (over them) are smaller at the point
/// settled on: the first correction tells their signs already. 0 where there are none, or where one of these
/// rows, which are looked at for it, depends on those held.
double GramSolve::near_scale(double part) {
  constexpr Index few = 8;
  const double small = part * known_.scale;
  if (!set_.is_near(small)) return 0;
  set_held_slacks_apart(p_);
  const Index most = p_.size == p_.n ? 0 : set_.most_near();
  const Index near = close_rows(0, small, most);
  if (near > most) return 0;
  for (Index first = 0, end = std::min(few, near); first < near; first = end, end = near) {
    const std::span<const Index> rows(p_.close + first, p_.close + end);
    if (!set_.look_at(rows) || !set_.are_independent(rows, least_independent)) return 0;
  }
  bool any = near > 0;
  for (Index k = 0; k < p_.size; ++k) any = any || (p_.pull[k] > 0 && p_.lambda[k] * p_.length[k] <= small);
  return any ? small : 0;
}

bool GramSolve::write(const Accuracy& accuracy, Solution& solution) {
  const double close = accuracy.tolerance * std::max(1.0, p_.acceleration_norm);
  // As many rows are held as there are coordinates, by the doubles q, without rounding: whatever the
  // multipliers are, so far as their signs are told, the point is that one.
  if (!(known_.bound <= close) && p_.size == p_.n && !problem_.radii && keeps_close(0)) known_.bound = 0;
  const PointError known{
      known_.scale, known_.rounding, known_.bound + moved_, degenerate_violation_,
      problem_.radii && touches_rows() ? open_question::degenerate_rows : std::string_view()};
  pivoting::write(problem_, p_, known, accuracy, solution);
  return true;
}

}  // namespace convex::inline pivoting
