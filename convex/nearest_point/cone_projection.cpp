#include "convex/nearest_point/cone_projection.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/linear_algebra/orthogonal_factor.hpp"

namespace convex {
namespace {

/// A generator that makes an angle with the rest b - V lambda whose cosine (times |rest| / |b|) is below this
/// is at right angles to it, to rounding.
constexpr double right_angle = 64 * unit_roundoff;

/// A generator this close to the span of those in use adds nothing: this part of its length, and of what its
/// coefficients, where those in use nearly depend on each other, make of rounding.
constexpr double dependent_part = 1e-14;

class PassiveSet {
 public:
  PassiveSet(const Matrix& V, const Vector& b)
      : V_(V), b_(b), factor_(V.rows(), std::min(V.rows(), V.cols())), c_(factor_.capacity()) {}

  const std::vector<Index>& members() const { return members_; }
  bool add(Index a) {
    Vector d = V_.col(a);
    const double rho = factor_.split(d, c_);
    if (factor_.size() == factor_.capacity()) return false;
    if (!(rho > unseen_part(V_.col(a).norm()))) return false;
    factor_.append(c_, d, rho);
    members_.push_back(a);
    return true;
  }
  void remove(Index k) {
    factor_.remove(k);
    members_.erase(members_.begin() + k);
  }
  /// The multipliers of the least-squares point over the members.
  Vector solve() const {
    Vector y = factor_.Q().transpose() * b_;
    factor_.solve_upper(y);
    return y;
  }
  /// Up to which size what is left of the last generator that was split may be rounding.
  double unseen_part(double length) const {
    Vector coefficients = c_.head(factor_.size());
    factor_.solve_upper(coefficients);
    double terms = length;
    for (Index k = 0; k < factor_.size(); ++k) terms += std::abs(coefficients[k]) * factor_.length(k);
    return dependent_part * terms;
  }
  /// The part of a generator's length outside the span of the members, 1 where that may be rounding.
  double part_outside(Index a) {
    Vector d = V_.col(a);
    const double length = d.norm(), rho = factor_.split(d, c_);
    return rho > unseen_part(length) ? rho / length : 1;
  }
  /// b minus its projection on the span of the members.
  Vector rest() const {
    Vector d = b_;
    for (int pass = 0; pass < 2; ++pass) d -= factor_.Q() * (factor_.Q().transpose() * d).eval();
    return d;
  }

 private:
  const Matrix& V_;
  const Vector& b_;
  linear_algebra::OrthogonalFactor factor_;
  Vector c_;
  std::vector<Index> members_;
};

}  // namespace

ConeProjection cone_projection(const Matrix& V, const Vector& b, const std::vector<Index>& free_generators) {
  const Index m = V.cols();
  // A cone does not change with the lengths of its generators; of those without squares it cannot be told.
  Vector unit = Vector::Ones(m);
  for (Index a = 0; a < m; ++a)
    if (const auto v = V.col(a); !has_squares(v.norm()) && !v.isZero(0) && v.allFinite())
      unit[a] = std::ldexp(1, std::max(-1000, std::ilogb(v.cwiseAbs().maxCoeff())));
  if ((unit.array() != 1).any()) {
    ConeProjection found = cone_projection(V * unit.cwiseInverse().asDiagonal(), b, free_generators);
    found.lambda = found.lambda.cwiseQuotient(unit);
    return found;
  }
  std::vector<bool> is_free(static_cast<std::size_t>(m), false), barred(static_cast<std::size_t>(m), false);
  bool untold = false;
  PassiveSet passive(V, b);
  for (Index a : free_generators) {
    is_free[static_cast<std::size_t>(a)] = true;
    passive.add(a);
  }
  const Vector lengths = V.colwise().norm();
  ConeProjection found;
  found.lambda = Vector::Zero(m);
  Vector multipliers = passive.solve();
  for (Index step = 0; step < 100 + 10 * m; ++step) {
    const Vector rest = passive.rest();
    const Vector pull = V.transpose() * rest;
    Index entering = -1;
    double strongest = right_angle * b.norm();
    for (Index a = 0; a < m; ++a) {
      if (is_free[static_cast<std::size_t>(a)] || barred[static_cast<std::size_t>(a)] || !(lengths[a] > 0))
        continue;
      const double strength = pull[a] / lengths[a];
      if (strength > strongest &&
          std::find(passive.members().begin(), passive.members().end(), a) == passive.members().end()) {
        strongest = strength;
        entering = a;
      }
    }
    if (entering < 0) {
      // A generator too close to the span of the others to take in, but not at right angles to what is left,
      // is one that this factor cannot tell from them: then the answer is not known.
      found.finished = !untold;
      break;
    }
    if (!passive.add(entering)) {
      barred[static_cast<std::size_t>(entering)] = true;
      // What rounding may have left of it outside the span pulls no more than this.
      const double of_rounding = passive.unseen_part(lengths[entering]) * rest.norm();
      untold = untold || strongest * lengths[entering] > of_rounding;
      continue;
    }
    Vector previous(multipliers.size() + 1);
    previous << multipliers, 0;
    // Back to the boundary of the cone along the segment from the old multipliers to the new ones.
    while (true) {
      multipliers = passive.solve();
      double fraction = 1;
      for (Index k = 0; k < multipliers.size(); ++k)
        if (!is_free[static_cast<std::size_t>(passive.members()[static_cast<std::size_t>(k)])] &&
            multipliers[k] <= 0)
          fraction = std::min(fraction, previous[k] / (previous[k] - multipliers[k]));
      if (fraction >= 1) break;
      previous += std::max(0.0, fraction) * (multipliers - previous);
      const double noise = right_angle * previous.cwiseAbs().maxCoeff();
      Index kept = 0;
      for (Index k = 0, at = 0; k < previous.size(); ++k) {
        const bool free_one =
            is_free[static_cast<std::size_t>(passive.members()[static_cast<std::size_t>(at)])];
        if (!free_one && multipliers[k] <= 0 && previous[k] <= noise) {
          passive.remove(at);
        } else {
          previous[kept++] = previous[k];
          ++at;
        }
      }
      previous.conservativeResize(kept);
    }
    std::fill(barred.begin(), barred.end(), false);
    untold = false;
  }
  for (std::size_t k = 0; k < passive.members().size(); ++k)
    found.lambda[passive.members()[k]] = multipliers[static_cast<Index>(k)];
  found.point = b - passive.rest();
  const Vector pull = V.transpose() * (b - found.point);
  for (Index a = 0; a < m; ++a)
    if (lengths[a] > 0 && b.norm() > 0) {
      const double size = lengths[a] * b.norm();
      const double wrong = is_free[static_cast<std::size_t>(a)] ? std::abs(pull[a]) : std::max(0.0, pull[a]);
      found.slack = std::max(found.slack, wrong / size);
      if (found.lambda[a] == 0 && pull[a] >= -right_angle * size)
        found.thinnest = std::min(found.thinnest, passive.part_outside(a));
    }
  return found;
}

}  // namespace convex
