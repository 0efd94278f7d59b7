#include "convex/nearest_point/multipliers/largest_move.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "convex/infinity.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// Of problems too large for dense factors, rows are held as softly as this part of their length squared:
/// errors along rows that depend on others, which no motion can follow, do not count.
constexpr double softness = 1e-12;

constexpr int most_climbs = 5;

/// Rademacher's functions: where all push the same way, and where those push back whose place has a binary
/// digit. Climbs end where the pushes of one stiff direction are in step (balance along a v with A ≈ v vᵀ):
/// any two of the first 64 places are against each other in one of them, of more nearly all.
constexpr int digits = 6;
std::array<Vector, digits + 1> starts(const Vector& size) {
  std::array<Vector, digits + 1> signed_sizes;
  signed_sizes.fill(size);
  for (Index i = 0; i < size.size(); ++i) {
    Index folded = 0;
    for (Index rest = i; rest > 0; rest >>= digits) folded ^= rest;
    for (int k = 0; k < digits; ++k)
      if (folded >> k & 1) signed_sizes[at(k + 1)][i] = -size[i];
  }
  return signed_sizes;
}

Vector with_signs(const Vector& size, const Vector& of) {
  return size.binaryExpr(of, [](double r, double x) { return x < 0 ? -r : r; });
}

/// A dq - U_Sᵀ dlambda = r1, U_S dq = r2, of the rows S that are independent.
class HeldEquations {
 public:
  HeldEquations(const NearestPointProblem& problem, const std::vector<Index>& held) : A_(problem.A) {
    if (is_dense_size(problem))
      hold(set_.emplace(problem), held);
    else
      hold_softly(problem, held);
  }
  bool is_known() const { return is_known_; }

  void solve(const Vector& r1, const Vector& r2, Vector& dq, Vector& dlambda) const {
    if (!set_) return soft_->solve(r1, r2, dq, dlambda);
    Vector dw, of_set;
    set_->correct(A_.whiten(r1), r2(place_), dw, of_set);
    dq = A_.unwhiten(dw);
    dlambda = Vector::Zero(r2.size());
    dlambda(place_) = of_set;
  }

 private:
  void hold(WorkingSet& set, const std::vector<Index>& held) {
    set.append_block(held, block_dependence);
    WorkingSet::Split split;
    for (const Index a : held) {
      if (set.holds(a)) continue;
      set.split(a, split);
      if (split.rho > 0) set.append(a, split, 0);
    }
    for (const Index a : set.rows()) place_.push_back(std::find(held.begin(), held.end(), a) - held.begin());
  }

  void hold_softly(const NearestPointProblem& problem, const std::vector<Index>& held) {
    const Vector length = dual_lengths(problem, held);
    Vector theta(static_cast<Index>(held.size()));
    for (Index k = 0; k < theta.size(); ++k) {
      const double of_row = length[held[at(k)]];
      theta[k] = of_row > 0 ? softness * of_row * of_row : 1;
    }
    is_known_ = soft_.emplace(problem).factor(held, theta);
  }

  const Metric& A_;
  std::optional<WorkingSet> set_;
  std::vector<Index> place_;  // of the rows of the set among those held
  std::optional<RegularisedKkt> soft_;
  bool is_known_ = true;
};

}  // namespace

LargestMove largest_move(const NearestPointProblem& problem, const std::vector<Index>& held,
                         const Vector& balance, const Vector& rows) {
  const LargestMove unknown{infinity, Vector::Constant(rows.size(), infinity)};
  if (!balance.allFinite() || !rows.allFinite()) return unknown;
  LargestMove largest{0, Vector::Zero(rows.size())};
  if (balance.isZero(0) && rows.isZero(0)) return largest;
  const HeldEquations equations(problem, held);
  if (!equations.is_known()) return unknown;
  const auto pushes = starts(balance), gaps = starts(rows);
  for (std::size_t start = 0; start < pushes.size(); ++start) {
    if (start > 0 && pushes[start] == pushes[0] && gaps[start] == gaps[0]) continue;
    Vector r1 = pushes[start], r2 = gaps[start], dq, dlambda;
    double reached = -1;
    for (int climb = 0; climb < most_climbs; ++climb) {
      equations.solve(r1, r2, dq, dlambda);
      const double move = problem.A.norm(dq);
      if (!std::isfinite(move)) return unknown;
      largest.of_multipliers = largest.of_multipliers.cwiseMax(dlambda.cwiseAbs());
      if (!(move > reached)) break;
      reached = move;
      equations.solve(problem.A.multiply(dq), Vector::Zero(rows.size()), dq, dlambda);
      r1 = with_signs(balance, dq);
      r2 = with_signs(rows, -dlambda);
    }
    largest.of_point = std::max(largest.of_point, reached);
  }
  return largest;
}

double largest_move(const Metric& A, const Vector& balance) {
  if (!balance.allFinite()) return infinity;
  if (is_diagonal(A)) return A.dual_norm(balance);
  double largest = 0;
  const auto pushes = starts(balance);
  for (std::size_t start = 0; start < pushes.size(); ++start) {
    Vector push = pushes[start];
    if (start > 0 && push == pushes[0]) continue;
    double reached = -1;
    for (int climb = 0; climb < most_climbs; ++climb) {
      const Vector dq = A.solve(push);
      const double move = std::sqrt(std::max(0.0, push.dot(dq)));
      if (!std::isfinite(move)) return infinity;
      if (!(move > reached)) break;
      reached = move;
      push = with_signs(balance, dq);
    }
    largest = std::max(largest, reached);
  }
  return largest;
}

}  // namespace convex::inline multiplier_sets
