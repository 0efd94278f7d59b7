#include "convex/linear_quadratic/minimise.hpp"

#include <cmath>
#include <optional>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_quadratic/definite_part.hpp"
#include "convex/linear_quadratic/polish.hpp"
#include "convex/linear_quadratic/stationarity.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"

namespace convex::linear_quadratic {
namespace {

/// The part of the natural curvature that holds soft variables in the first round: each round then leaves
/// about this part of the error.
constexpr double first_softness = 0x1p-12;

/// By what it shrinks when a round gains less than that, and down to where: beyond, the rounding of the
/// factor of H + W + softness would be felt.
constexpr double softness_step = 0x1p-6;
constexpr double least_softness = 0x1p-36;
/// Without definite variables there is nothing that it could be small against.
constexpr double least_pure_softness = 0x1p-300;

/// Stationarity holds when each of its entries is within so many roundings of its terms.
constexpr double still = 16 * unit_roundoff;

/// A defect that no longer shrinks, but is below this part of its terms, is the rounding of the multipliers;
/// what it does to x is seen from round to round and enters the error bound.
constexpr double stagnant_defect = 1e-9;

/// Where z and x are 0, an error is as good as none below the first part of the terms of stationarity; the
/// second is what corrections then aim at a small part of.
constexpr double zero_of_terms = 0x1p-70, less = 0x1p-20;

/// A round whose error estimate is above this part of its scale does not count.
constexpr double rough = 1e-9;

/// A point whose error estimate is above this part of ||z||_W + ||x||_W is reported as inaccurate.
constexpr double accurate = 1e-11;

constexpr int most_rounds = 60;
/// A program that is not solved after this many rounds is looked at for being unbounded.
constexpr int patient_rounds = 6;

/// The rows of the data below this density are kept sparse in larger problems.
constexpr Index dense_columns = 96;

ConstraintRows constraint_rows(const SparseRows& G) {
  if (G.cols() <= dense_columns) return ConstraintRows(RowMatrix(G));
  return ConstraintRows(G);
}

/// The rows that the answer rests on, and where a method does not tell a basis of them those that press.
std::vector<Index> pressing_rows(const Solution& solution) {
  std::vector<Index> rows = solution.basis;
  if (rows.empty())
    for (Index a = 0; a < solution.lambda.size(); ++a)
      if (solution.lambda[a] != 0) rows.push_back(a);
  return rows;
}

class ProximalPoint {
 public:
  ProximalPoint(const LinearQuadratic& f, const Metric& W, const Vector& z)
      : f_(f),
        W_(W),
        z_(z),
        soft_(soft_variables(f, W)),
        softness_(first_softness),
        least_(soft_.mixed ? least_softness : least_pure_softness),
        problem_{W, Vector(), constraint_rows(f.G), f.h, f.two_sided},
        z_norm_(W.norm(z)) {
    if (f.n == 0) measure_bounds();
    if (soft_.any && !soft_.mixed) scale_linear_program();
    point_.xi = Vector::Zero(f.variables());
  }

  ProgramPoint run() {
    if (!soften()) {
      point_.status = Status::gave_up;
      return point_;
    }
    std::vector<Index> guess;
    for (point_.rounds = 1; point_.rounds <= most_rounds; ++point_.rounds) {
      const Solution solution = round(guess);
      if (solution.q.size() != f_.variables()) {
        point_.status = solution.status == Status::infeasible ? Status::infeasible : Status::gave_up;
        if (solution.status == Status::infeasible) point_.defect = Defect::empty_domain;
        return point_;
      }
      guess = pressing_rows(solution);
      if (settled(solution)) return finished(solution);
      if (point_.rounds == patient_rounds && soft_.any) {
        point_.ray = descent_ray(f_);
        if (point_.ray.size() > 0) {
          point_.status = Status::infeasible;
          point_.defect = Defect::unbounded_below;
          return point_;
        }
      }
    }
    --point_.rounds;
    point_.v = subgradient_of_multipliers(f_, point_.xi, point_.lambda);
    point_.error_bound = infinity;
    return judged();
  }

 private:
  void measure_bounds() {
    for (Index a = 0; a < f_.rows(); ++a) {
      const double length = f_.G.row(a).norm();
      if (length > 0) bounds_ = std::max(bounds_, std::abs(f_.h[a]) / length);
    }
  }

  /// Without definite variables: the curvature at which the costs move a variable by its natural size.
  void scale_linear_program() {
    const double cost = f_.c.norm();
    soft_.curvature *= (cost > 0 ? cost : 1) / (bounds_ > 0 ? bounds_ : 1) / soft_.curvature.maxCoeff();
  }

  /// False where no softness makes the program definite: the metric is lost in the rounding of H.
  bool soften() {
    while (true) {
      try {
        problem_.A = curvature_metric(f_, W_, softness_ * soft_.curvature);
        return true;
      } catch (const InvalidInput&) {  // as a sum of rounded numbers it is not definite: hold faster
        if (!soft_.any || softness_ > 1) return false;
        softness_ /= softness_step;
        least_ = softness_;
      }
    }
  }

  /// The nearest-point problem around the present point: its linear term is Aξ - (gradient at ξ), so that A
  /// enters by differences only.
  Solution round(const std::vector<Index>& guess) {
    DoubleDoubleVector pull = gradient(f_, W_, z_, DoubleDoubleVector(point_.xi));
    pull.hi = -pull.hi;
    pull.lo = -pull.lo;
    add_product(problem_.A, DoubleDoubleVector(point_.xi), pull);
    problem_.z = pull.value();
    rounded_off_ = pull.hi - problem_.z + pull.lo;
    // Rounds after the first have derived data, which fractions would take at their word.
    const bool is_the_program = !soft_.any && f_.polyhedral();
    const Accuracy accuracy{.reduce = false, .limit = is_the_program ? 1.0 : 0.0};
    // Many sparse variables are first told apart by a method that need not go from row to row.
    Solution solution = guess.empty() ? automatic(problem_, accuracy) : active_set(problem_, accuracy, guess);
    round_scale_ = std::max(solution.acceleration_norm, solution.force_norm);
    rough_ = !(solution.error_bound <= rough * round_scale_);
    return solution;
  }

  /// Takes the solution of a round; true when it is a fixed point, or as near to one as rounding lets it.
  bool settled(const Solution& solution) {
    const Vector move = (solution.q - point_.xi).head(f_.n);
    const double last_move = move_, last_ratio = point_.defect_ratio;
    const bool frozen = point_.rounds > 1 && solution.q == point_.xi && softness_ <= least_;
    move_ = W_.norm(move);
    point_.xi = solution.q;
    point_.lambda = solution.lambda;
    const Vector defect = stationarity_defect(f_, W_, z_, point_.xi, point_.lambda);
    const Vector terms = defect_terms(f_, point_.xi, point_.lambda) +
                         softness_ * soft_.curvature.cwiseProduct(point_.xi.cwiseAbs());
    const double scale = z_norm_ + W_.norm(point_.xi.head(f_.n));
    point_.defect_ratio = 0;
    largest_defect_ = 0;
    double motion_ratio = 0, transfer = 0;
    terms_norm_ = W_.dual_norm(terms.head(f_.n));
    for (Index j = f_.n; j < f_.variables(); ++j) {
      const double off = std::abs(defect[j]), stiffness = std::sqrt(soft_.curvature[j]);
      largest_defect_ = std::max(largest_defect_, off);
      if (off > 0) point_.defect_ratio = std::max(point_.defect_ratio, off / terms[j]);
      if (!(stiffness > 0)) continue;
      // What a defect may do to x, and that relative to x, or to the costs when there is no x.
      transfer += off / stiffness;
      terms_norm_ = std::max(terms_norm_, terms[j] / stiffness);
      const double natural =
          f_.n > 0 ? stiffness * (scale + terms_norm_) : f_.c.norm() + soft_.curvature[j] * bounds_;
      motion_ratio = std::max(motion_ratio, off / natural);
    }
    const bool second = point_.rounds > 1;
    const double gain = second && last_move > 0 ? move_ / last_move : second ? 0 : 1;
    // The defect holds the rounding of x; that of the auxiliary variables does not matter.
    point_.error_bound =
        W_.dual_norm(defect.head(f_.n)) + (solution.error_bound - solution.rounding) + transfer;
    if (second) point_.error_bound += gain < 0.5 ? move_ * gain / (1 - gain) : move_;

    if (rough_) return !harden();
    if (!soft_.any && f_.polyhedral()) {  // the round was the program itself
      point_.error_bound = solution.error_bound + W_.dual_norm(rounded_off_.head(f_.n));
      return true;
    }
    if (!second) return false;
    const bool at_rest = move_ <= still * (scale + terms_norm_),
               stuck = gain > 0.5 && move_ <= accurate * scale;
    const bool slow = point_.defect_ratio > softness_step * last_ratio;
    const bool stagnant =
        !goes_down() && point_.defect_ratio <= stagnant_defect && point_.defect_ratio >= 0.5 * last_ratio;
    idle_ = (at_rest || (stuck && softness_ <= least_)) && slow && motion_ratio <= still;
    if (idle_ || ((at_rest || stuck) && (point_.defect_ratio <= still || stagnant))) return true;
    if (slow) shrink();
    return frozen;
  }

  /// Without an x, whether a defect that stays is a small slope, down which rounds still go: those that hold
  /// fast go a short way each.
  bool goes_down() {
    if (f_.n > 0) return false;
    const double last = height_;
    height_ = objective(f_, point_.xi);
    const double rounding = unit_roundoff * f_.c.cwiseAbs().dot(point_.xi.cwiseAbs());
    return softness_ > std::max(least_, least_softness) || last - height_ > rounding;
  }

  void shrink() {
    if (!soft_.any || softness_ <= least_) return;
    const double before = softness_;
    softness_ *= softness_step;
    if (!soften()) softness_ = before;
  }

  /// After a round that was not solved well: holds the soft variables faster, for good. False when there are
  /// none.
  bool harden() {
    if (!soft_.any || softness_ > 1) return false;
    softness_ /= softness_step;
    least_ = std::max(least_, softness_);
    return soften();
  }

  /// Sharpens a settled point with its working set.
  ProgramPoint finished(const Solution& solution) {
    point_.v = subgradient_of_multipliers(f_, point_.xi, point_.lambda);
    sharpened_ = !soft_.any && f_.polyhedral();
    if (sharpened_) return judged();
    if (!rough_) {
      const double scale = f_.n > 0 ? z_norm_ + W_.norm(point_.xi.head(f_.n)) + less * terms_norm_
                                    : problem_.A.norm(point_.xi) + less * round_scale_;
      const PolishedPoint better =
          polish(f_, W_, z_, problem_, solution.basis, point_.xi, point_.lambda, scale);
      const double moved = better.converged ? W_.norm((better.xi - point_.xi).head(f_.n)) : infinity;
      // A polished point far from the settled one rests on other rows than the best.
      const double near =
          4 * point_.error_bound + still * (z_norm_ + W_.norm(point_.xi.head(f_.n)) + terms_norm_);
      if (better.converged && moved <= near) {
        point_.xi = better.xi;
        point_.lambda = better.lambda;
        point_.v = better.v;
        point_.defect_ratio = 0;
        const double open = solution.error_bound - solution.rounding;
        sharpened_ = open <= still * scale;
        point_.error_bound = better.missing + open + (sharpened_ ? 0 : open_in_covector());
        return judged();
      }
    }
    point_.error_bound += open_in_covector();
    return judged();
  }

  /// What multipliers that nothing has sharpened leave open of v: the rounding of its terms, and what they
  /// miss of stationarity in the auxiliary variables, which tie its entries together.
  double open_in_covector() const {
    const Vector terms = defect_terms(f_, point_.xi, point_.lambda);
    const double tied = f_.auxiliaries() > 0 ? terms.tail(f_.auxiliaries()).maxCoeff() : 0;
    const double least = std::max(largest_defect_, unit_roundoff * tied);
    return (unit_roundoff * terms.head(f_.n)).cwiseMax(least).dot(softness_of_entries(W_));
  }

  ProgramPoint judged() {
    const double scale = z_norm_ + W_.norm(point_.xi.head(f_.n));
    const bool exact = point_.error_bound <= std::max(accurate * scale, zero_of_terms * terms_norm_);
    // Without x only the value counts, which its own duality gap judges.
    const bool balanced = point_.defect_ratio <= stagnant_defect || idle_;
    point_.status = (exact || f_.n == 0) && balanced && !rough_ ? Status::solved : Status::inaccurate;
    // What rounds that do not come to rest say of their distance to the end is no bound where W may be nearly
    // singular.
    const bool is_full = W_.kind() == MetricKind::dense || W_.kind() == MetricKind::sparse;
    if (point_.status != Status::solved && !sharpened_ && is_full) point_.error_bound = infinity;
    return point_;
  }

  const LinearQuadratic& f_;
  const Metric& W_;
  const Vector& z_;
  SoftVariables soft_;
  double softness_, least_;
  NearestPointProblem problem_;
  double z_norm_, move_ = 0;
  double height_ = infinity;  ///< without an x, the objective of the last round
  double bounds_ = 0;         // the size of the variables that the rows ask for, when there is no x
  double terms_norm_ =
      0;  // the terms of stationarity in the units of x: its rounding is relative to them too
  double round_scale_ = 0;
  double largest_defect_ = 0;  ///< of stationarity in the auxiliary variables
  Vector rounded_off_;         ///< what the linear term of a round left out of its double
  bool rough_ = false, idle_ = false;
  bool sharpened_ = false;  ///< ξ is that of its rows to rounding
  ProgramPoint point_;
};

}  // namespace

ProgramPoint minimise(const LinearQuadratic& f, const Metric& W, const Vector& z) {
  return ProximalPoint(f, W, z).run();
}

Vector descent_ray(const LinearQuadratic& f) {
  /// Slopes below this part of the costs are rounding.
  constexpr double slope_noise = 1e-10;
  const Index k = f.auxiliaries();
  const Vector costs = f.c.tail(k);
  if (k == 0 || costs.cwiseAbs().maxCoeff() == 0) return {};  // no costs at all, as given
  const SparseRows rows = f.G.rightCols(k), bends = SparseRows(f.H.bottomRightCorner(k, k));
  RowMatrix U(rows.rows() + k, k);
  U << RowMatrix(rows), RowMatrix(bends);
  std::vector<Index> two_sided = f.two_sided;
  for (Index j = 0; j < k; ++j) two_sided.push_back(rows.rows() + j);
  const Solution solution = active_set({Metric::identity(k), Vector(-costs / costs.norm()), ConstraintRows(U),
                                        Vector::Zero(U.rows()), two_sided},
                                       {.limit = 0});
  if (solution.q.size() != k || solution.q.norm() <= slope_noise) return {};
  Vector ray = Vector::Zero(f.variables());
  ray.tail(k) = solution.q;
  return ray;
}

}  // namespace convex::linear_quadratic
