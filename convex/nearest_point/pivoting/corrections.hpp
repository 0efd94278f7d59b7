#pragma once

#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline pivoting {

/// What corrections with residuals in twice the working precision make of the point of some rows held: how
/// they converge, what of q and lambda is 0 as far as they tell, and the bound that is left.
class Corrections {
 public:
  /// Before the first correction of a point.
  void begin() { count_ = 0; }
  /// A correction, of ||dq||_A = `step`, which changed the multipliers times the lengths of their rows by
  /// `pull` in all; fresh: the first with these rows.
  struct Correction {
    double step, pull;
    bool is_fresh;
    double factor_condition;
    double gram_condition;  ///< of the Gram matrix of the rows held, each divided by its length
    double growth;          ///< what enlarges rounding in its inverse; 0 where there is a factor instead
    double scale;
  };
  /// Notes it. False when corrections shrink too slowly.
  bool note(const Correction&);

  /// A point after a correction: q = q + q_low (n), D the diagonal of A; lambda of the k rows held, what the
  /// correction added to it, and the lengths ||v|| of the rows, 0 in `pull` where a multiplier has no sign.
  struct Point {
    Index n;
    double *q, *q_low;
    const double *dq, *diagonal, *unit;  // unit: 1 over the root of the diagonal
    Index k;
    double* lambda;
    const double *change, *length, *pull;
  };
  /// Takes what cancels for 0; or false, if `more`, when another correction may tell some of it from 0.
  /// `wrong` becomes the size of a negative multiplier, if there is one.
  bool take_noise_for_zero(const Point&, bool more);

  /// What may be missing in the slack of a row of this length.
  double missing_slack(double row_scale) const { return margin * row_scale * (remaining + silenced); }

  double remaining = 0;  ///< an estimate of what is still missing, ||·||_A
  double silenced = 0;   ///< at least ||·||_A of what cancelled and was taken for 0
  double rounding = 0;   ///< of q to doubles
  double bound = 0;
  double wrong = 0;  ///< the largest wrong multiplier, times its length, or slack, over it
  double scale = 0;  ///< max(||q||_A, ||z||_(A⁻¹))

 private:
  /// What is missing in a point may show this many times as large in a slack: ||u_a||_(D⁻¹), D the diagonal
  /// of A, stands for the row's length, and what is missing is an estimate.
  static constexpr double margin = 16;

  double floor_of_residuals() const;

  double step_ = 0, likely_ = 0, factor_condition_ = 1, gram_condition_ = 0;
  int count_ = 0;
  bool is_fresh_ = true;
};

/// Rows whose signs the first correction tells have this part of their squared length outside the span of
/// those held, so that they may come in.
inline constexpr double least_independent = 1e-6;

/// What slacks at a corrected point say of it; violated: beyond rounding, by `Corrections::wrong`.
enum class Slacks { kept, violated, doubtful };

/// Corrects the point of the rows held by an engine until all is told. What multipliers and slacks are wrong
/// then, by rounding, is the scale of a problem of the same kind, for those that are that small: pivoting
/// goes on there, on the same Gram matrix, until nothing is wrong. Those that doubles leave open at once have
/// a part in the first correction (`near_scale`). False when something is in doubt.
template <class Engine>
bool finish(Engine& engine, const Accuracy& accuracy, Solution& solution) {
  constexpr double room_for_change = 256;  // wrong numbers and those up to so many times them change sides
  constexpr double small_in_doubles =
      0x1p-36;                        // of the scale: violations that do not count in doubles are less
  constexpr double plenty = 0x1p-76;  // corrections are cheap here: so little of the scale is to be left
  constexpr int most_more = 3;        // corrections beyond what is enough, for entries that are close to 0
  constexpr int most_passes = 12;     // before pivoting has lost its way
  Corrections& known = engine.corrections();
  known.begin();
  double small = engine.near_scale(small_in_doubles);
  int more = most_more;
  for (int pass = 0; pass < most_passes; ++pass) {
    if (!engine.correct(pass == 0, small)) return false;
    small = 0;
    if (!(known.remaining <= plenty * known.scale)) continue;
    known.wrong = 0;
    if (!engine.take_noise_for_zero(more > 0)) {
      more -= 1;
      continue;
    }
    if (engine.measure_slacks() == Slacks::doubtful) return false;
    if (known.wrong > 0) {
      small = room_for_change * known.wrong;
      continue;
    }
    return engine.write(accuracy, solution);
  }
  return false;
}

}  // namespace convex::inline pivoting
