#include "convex/linear_quadratic/polish.hpp"

#include <cmath>
#include <limits>

#include "convex/linear_quadratic/stationarity.hpp"
#include "convex/nearest_point/kkt_residual.hpp"
#include "convex/nearest_point/working_set.hpp"

namespace convex {
namespace {

using Set = WorkingSet<Eigen::Dynamic>;

constexpr int most_corrections = 30;

/// Corrections that shrink less than this are no longer worth their while.
constexpr double slowest_gain = 0.25;

/// Corrections end when x moves by less than this part of ||z||_W + ||x||_W: its rounding is then all that is
/// left.
constexpr double enough = 0x1p-70;

/// Negative multipliers up to this part of the largest change are rounding about 0.
constexpr double sign_noise = 1e-10;

}  // namespace

PolishedPoint polish(const LinearQuadratic& f, const Metric& W, const Vector& z,
                     const NearestPointProblem& round, const std::vector<Index>& rows, const Vector& start,
                     const Vector& multipliers) {
  Set set(round);
  Matrix whitened = whitened_rows(round, rows);
  set.append_block(rows, whitened, 0);
  const Index held = set.size();
  PolishedPoint found;
  if (held != static_cast<Index>(rows.size())) return found;

  DoubleDoubleVector xi(start), lambda(held);
  for (Index k = 0; k < held; ++k) lambda.hi[k] = multipliers[set.rows()[static_cast<std::size_t>(k)]];
  Set::Column dw, dlambda, r2(held);
  const double scale = W.norm(z) + W.norm(start.head(f.n));
  double last = std::numeric_limits<double>::infinity(), gain = 1;
  for (int step = 0; step < most_corrections; ++step) {
    DoubleDoubleVector balance = gradient(f, W, z, xi);
    for (Index k = 0; k < held; ++k)
      round.U.add_multiple(set.rows()[static_cast<std::size_t>(k)], {-lambda.hi[k], -lambda.lo[k]}, balance);
    for (Index k = 0; k < held; ++k)
      r2[k] = -slack(round, set.rows()[static_cast<std::size_t>(k)], xi).value();
    set.correct(round.A.whiten(-balance.value()), r2, dw, dlambda);
    const Vector dxi = round.A.unwhiten(dw);
    const double size = round.A.norm(dxi), x_size = W.norm(dxi.head(f.n));
    gain = size / last;
    if (step > 0 && !(gain <= slowest_gain)) {
      found.converged = last <= enough * round.A.norm(xi.hi);
      found.missing = last;
      break;
    }
    xi.add(dxi);
    lambda.add(dlambda);
    found.missing = step > 0 ? x_size * gain : x_size;
    last = size;
    found.converged = step > 0 && found.missing <= enough * scale;
    if (found.converged || size == 0) break;
  }
  found.converged = found.converged || last == 0;
  if (!found.converged) return found;
  found.xi = xi.hi;
  found.missing += W.norm(xi.lo.head(f.n));
  found.lambda = Vector::Zero(f.rows());
  double largest = 0;
  for (Index k = 0; k < held; ++k) largest = std::max(largest, std::abs(lambda.hi[k]));
  std::vector<bool> free(static_cast<std::size_t>(f.rows()), false);
  for (Index a : f.two_sided) free[static_cast<std::size_t>(a)] = true;
  for (Index k = 0; k < held; ++k) {
    const Index a = set.rows()[static_cast<std::size_t>(k)];
    const bool falls = lambda.hi[k] < 0 && !free[static_cast<std::size_t>(a)];
    if (falls && lambda.hi[k] < -sign_noise * largest) found.converged = false;
    found.lambda[a] = falls ? 0 : lambda.hi[k];
  }
  return found;
}

}  // namespace convex
