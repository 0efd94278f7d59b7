#include "convex/operations/image_prox.hpp"

#include <algorithm>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/double_double.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"

namespace convex::inline operations {
namespace {

/// c - W⁻¹q, with what is left of it: ||W(x - c) + q||_(W⁻¹).
struct Shifted {
  DoubleDoubleVector x;
  double left = 0;
};

Shifted shifted(const Metric& W, const Vector& c, const DoubleDoubleVector& q) {
  constexpr int refinements = 3;
  Shifted made{DoubleDoubleVector(c)};
  const auto residual = [&]() -> Vector {
    DoubleDoubleVector sum = q;
    add_metric_difference(W, made.x.hi, c, sum);
    return sum.value() + W.multiply(made.x.lo);
  };
  made.x.add(-W.solve(q.hi));
  for (int pass = 0; pass < refinements; ++pass) made.x.add(-W.solve(residual()));
  made.left = W.dual_norm(residual());
  return made;
}

/// Mᵀp.
DoubleDoubleVector transposed_product(const Matrix& M, const DoubleDoubleVector& p) {
  DoubleDoubleVector made(M.cols());
  for (Index j = 0; j < M.cols(); ++j) {
    const DoubleDouble entry = dot(M.rows(), M.col(j).data(), p.hi.data(), p.lo.data());
    made.hi[j] = entry.hi;
    made.lo[j] = entry.lo;
  }
  return made;
}

/// What one prox in the image tells.
struct Step {
  Prox part;
  DoubleDoubleVector x, v;
  Vector e;
  double missed = 0;  ///< ||x - x*||_W but for the part's own bound, x not yet rounded
};

}  // namespace

DoubleDoubleVector accurate_image(const Matrix& A, const DoubleDoubleVector& x, const Vector& b) {
  DoubleDoubleVector sum(b);
  for (Index j = 0; j < x.size(); ++j)
    add_multiple(A.rows(), A.col(j).data(), x[j], sum.hi.data(), sum.lo.data());
  sum.add(Vector::Zero(b.size()));
  return sum;
}

Prox image_prox(const Function& f, const Matrix& A, const Vector& b, const ImageMetric& image,
                const Vector& z, const Metric& W, const Look& look) {
  constexpr int most_steps = 8, moves = 2;
  constexpr double roundings_left = 4;  // so much is not worth another prox
  constexpr double slow = 0.5, small_part = 0.1;
  const Metric& S = image.metric;
  const auto step_from = [&](const Vector& y) {
    Step step{f.prox(y, S, look), DoubleDoubleVector(z.size()), DoubleDoubleVector(z.size()), {}};
    if (step.part.x.size() == 0) return step;
    DoubleDoubleVector p(A.rows());
    add_metric_difference(S, y, step.part.x, p);
    p.add(Vector::Zero(p.size()));
    step.v = transposed_product(A, p);
    Shifted found = shifted(W, z, step.v);
    step.x = std::move(found.x);
    const auto off_image = [&]() -> Vector {
      DoubleDoubleVector e = accurate_image(A, step.x, b);
      e.add(-step.part.x);
      return e.value();
    };
    step.e = off_image();
    step.missed = S.norm(step.e) + found.left;
    // Far from z, e leaves Ax + b outside the domain of f by more than the rounding of x.
    for (int pass = 0; pass < moves; ++pass)
      step.x.add(-(image.lift * S.multiply(pass == 0 ? step.e : off_image())));
    return step;
  };
  Vector y = accurate_image(A, DoubleDoubleVector(z), b).value();
  Step best = step_from(y);
  for (int count = 1; count < most_steps && best.part.x.size() > 0; ++count) {
    const double rounding = roundings_left * unit_roundoff * (W.norm(z) + W.norm(best.x.hi));
    if (!(best.missed > std::max(rounding, small_part * best.part.error_bound))) break;
    y += best.e;
    Step next = step_from(y);
    if (!(next.part.x.size() > 0 &&
          next.missed + next.part.error_bound < best.missed + best.part.error_bound))
      break;
    const bool stands_still = next.missed > slow * best.missed;
    best = std::move(next);
    if (stands_still) break;
  }
  const Prox& part = best.part;
  if (part.x.size() == 0 || part.status == Status::infeasible) return part;
  // S is rounded by some parts u of its condition: I - A W⁻¹Aᵀ S.
  constexpr double roundings_of_inverse = 8;
  const double off = roundings_of_inverse * static_cast<double>(A.rows()) * unit_roundoff * image.condition *
                     image.condition;
  constexpr double most_off = 0.5;  // beyond, S may be another matrix
  const double bound = off < most_off ? (part.error_bound + best.missed) / (1 - off) : infinity;
  const Vector own = A.transpose() * part.v;
  // The part's own covector proves more than what y - u gives, where its rounding leaves it as near.
  const bool is_near = W.dual_norm(stationarity(z, W, best.x.hi, own)) <= bound;
  return with_values(moved(part, best.x.hi, is_near ? own : best.v.hi, bound, z, W), part.values, {},
                     product(part.v, -b));
}

}  // namespace convex::inline operations
