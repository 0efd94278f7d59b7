#include "convex/nearest_point/optimality/farkas_circuit.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/active_set/dependent_row.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"

namespace convex::inline optimality {
namespace {

/// A weight this small beside the largest (times the lengths of the rows) is left out.
constexpr double support = 1e-9;

}  // namespace

std::optional<Vector> farkas_circuit(const NearestPointProblem& problem, const Vector& w, double reach) {
  using Set = WorkingSet;
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const Vector length = problem.U.lengths(problem.A.diagonal().cwiseInverse());
  const Vector weight = w.cwiseAbs().cwiseProduct(length);
  if (problem.rows() == 0 || !weight.allFinite() || !(weight.maxCoeff() > 0)) return std::nullopt;
  std::vector<Index> rows;
  for (Index a = 0; a < problem.rows(); ++a)
    if (weight[a] > support * weight.maxCoeff() && (w[a] > 0 || two_sided[at(a)])) rows.push_back(a);
  std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return weight[a] > weight[b]; });
  Set set(problem);
  Set::Split split;
  const auto one_sided = [&](Index k) { return !two_sided[at(set.rows()[static_cast<std::size_t>(k)])]; };
  for (Index p : rows) {
    double rest = w[p];
    bool gone = false;
    set.split(p, split);
    while (!gone && !(split.rho > 0)) {
      const double gap = contradiction(set, p, split), sign = gap < 0 ? -1 : 1;
      // The weights move by sign (1, -r); the first one-sided weight that comes to 0 stops them.
      double step = std::numeric_limits<double>::infinity();
      Index blocking = -1;
      if (sign < 0 && !two_sided[at(p)]) step = rest;
      for (Index k = 0; k < set.size(); ++k) {
        const double change = -sign * split.coefficients[k];
        if (!one_sided(k) || change >= 0 || is_noise(set, k, split)) continue;
        const double ratio = std::max(0.0, set.lambda()[k]) / -change;
        if (ratio >= step) continue;
        step = ratio;
        blocking = k;
      }
      if (!std::isfinite(step)) {
        if (!(std::abs(gap) > 0)) break;  // a dependence that proves nothing
        const Vector weights = contradiction_weights(set, p, split, sign);
        if (proves_infeasibility(problem, weights, reach)) return weights;
        break;
      }
      set.lambda().head(set.size()) -= sign * step * split.coefficients.head(set.size());
      rest += sign * step;
      gone = blocking < 0;
      if (gone) break;
      set.remove(blocking);
      set.split(p, split);
    }
    if (!gone && split.rho > 0) set.append(p, split, rest);
  }
  return std::nullopt;
}

}  // namespace convex::inline optimality
