#include "convex/nearest_point/pivoting/gram_solve.hpp"

#include <algorithm>
#include <cmath>

#include "convex/dense/dense_kernels.hpp"
#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/optimality/held_residuals.hpp"
#include "convex/nearest_point/pivoting/critical_region.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// What may be missing of the scale, so that the bound is that of rounding the answer.
constexpr double beside_rounding = 0x1p-57;

}  // namespace

GramSolve::GramSolve(GramWorkingSet& set)
    : set_(set), problem_(set.problem()), p_(set.point()), rows_(p_.all * p_.n, p_.U) {}

bool GramSolve::solve_again(const Accuracy& accuracy, Solution& solution) {
  if (!set_.settle_again() || !answer(accuracy, solution)) return false;
  set_.follow_working_set();
  return true;
}

bool GramSolve::solve_in_critical_region(const Accuracy& accuracy, Solution& solution) {
  const CriticalRegion* const region = set_.take_affine_point();
  if (!region) return false;
  set_held_slacks_apart();
  known_ = Corrections();
  known_.scale = p_.norm();
  known_.remaining = region->remaining;
  known_.rounding = std::sqrt(static_cast<double>(p_.n)) * region->rounded;
  known_.bound = 2 * known_.remaining + known_.rounding;
  moved_ = touched_violation_ = 0;
  return region->least > near_zero * std::max(known_.scale, p_.magnitude) &&
         known_.remaining <= beside_rounding * known_.scale &&
         known_.bound <= accuracy.tolerance * std::max(1.0, p_.acceleration_norm) &&
         (region->has_all || is_clear(known_.scale)) && write(accuracy, solution) &&
         solution.status == Status::solved;
}

bool GramSolve::answer(const Accuracy& accuracy, Solution& solution) {
  known_ = Corrections();
  known_.scale = p_.norm();
  moved_ = touched_violation_ = 0;
  const double close = accuracy.tolerance * std::max(1.0, p_.acceleration_norm);
  return !accuracy.refine && doubles_do(close) ? write(accuracy, solution)
                                               : correct_until_told(accuracy, solution);
}

/// Whether the answer in doubles is within so much, no row close to tipping over.
bool GramSolve::doubles_do(double close) {
  set_.measure();
  set_held_slacks_apart();
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

/// Corrects the point of the rows held until all is told. What multipliers and slacks are wrong then, by
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
  set_held_slacks_apart();
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

/// ||q||_A is that of w, which is what is left of z and the pushes of the rows: where these cancel, of q
/// itself.
void GramSolve::measure_again_where_it_cancels() {
  constexpr double much = 0x1p-20;
  double largest = known_.scale;
  for (Index k = 0; k < p_.size; ++k) largest = std::max(largest, std::abs(p_.lambda[k]) * p_.length[k]);
  if (p_.acceleration_norm > much * largest) return;
  const bool is_zero = std::all_of(p_.q, p_.q + p_.n, [](double x) { return x == 0; });
  p_.acceleration_norm = is_zero ? 0 : problem_.A.norm(Eigen::Map<const Vector>(p_.q, p_.n));
}

bool GramSolve::write(const Accuracy& accuracy, Solution& solution) {
  measure_again_where_it_cancels();
  const double close = accuracy.tolerance * std::max(1.0, p_.acceleration_norm);
  // As many rows are held as there are coordinates, by the doubles q, without rounding: whatever the
  // multipliers are, so far as their signs are told, the point is that one.
  if (!(known_.bound <= close) && p_.size == p_.n && !problem_.radii && keeps_close(0)) known_.bound = 0;
  // `convex::residuals`, to which only the rows held and touched matter; measured in doubles.
  double most = 0;
  for (Index k = 0; k < p_.size; ++k) most = std::max(most, std::abs(p_.lambda[k]));
  HeldResiduals held(p_.stationarity, p_.acceleration_norm, known_.scale, most);
  for (Index k = 0; k < p_.size; ++k)
    held.add(problem_.s[p_.rows[k]], p_.length[k], p_.lambda[k], p_.held_slack[k], !(p_.pull[k] > 0));
  solution.residuals = held.all();
  solution.residuals.feasibility = std::max(solution.residuals.feasibility, touched_violation_);
  solution.method = "active-set";
  solution.undecided = problem_.radii && touches_rows() ? open_question::touched : std::string_view();
  solution.model.islands.clear();
  solution.steps = p_.steps;
  solution.farkas.resize(0);
  solution.q = Eigen::Map<const Vector>(p_.q, p_.n);
  solution.lambda.setZero(p_.all);
  solution.slack = Eigen::Map<const Vector>(p_.slack, p_.all);
  for (Index k = 0; k < p_.size; ++k) {
    solution.lambda[p_.rows[k]] = p_.lambda[k];
    solution.slack[p_.rows[k]] = 0;
  }
  solution.basis.assign(p_.rows, p_.rows + p_.size);
  solution.acceleration_norm = p_.acceleration_norm;
  solution.force_norm = p_.z_norm;
  solution.rounding = known_.rounding;
  solution.error_bound = known_.bound + moved_;
  solution.status = solution.is_within(accuracy) ? Status::solved : Status::inaccurate;
  return true;
}

}  // namespace convex::inline pivoting
