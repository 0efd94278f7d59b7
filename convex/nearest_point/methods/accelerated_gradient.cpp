#include "convex/nearest_point/methods/every_method.hpp"

#include <cmath>
#include <utility>

#include "convex/nearest_point/methods/iteration.hpp"

namespace convex::inline algorithms {
namespace {

constexpr Index most_steps = 1000000;

/// A step is tested for its length when it is longer than this part of the point.
constexpr double shortest = 1e-7;

/// Steps of the power method, and by how much its estimate of the largest eigenvalue is raised.
constexpr int power_steps = 30;
constexpr double margin = 1.05;

/// The operator y -> F⁻¹Uᵀy and its transpose.
class Whitening {
 public:
  explicit Whitening(const NearestPointProblem& problem) : problem_(problem), dense_(is_dense_size(problem)) {
    if (dense_) V_ = whitened_rows(problem, indices_below(problem.rows()));
  }
  Vector times(const Vector& y) const {
    return dense_ ? Vector(V_ * y) : problem_.A.whiten(problem_.U.transpose_times(y));
  }
  Vector transpose_times(const Vector& d) const {
    return dense_ ? Vector(V_.transpose() * d) : problem_.U.times(problem_.A.unwhiten(d));
  }

 private:
  const NearestPointProblem& problem_;
  bool dense_;
  Matrix V_;
};

double largest_eigenvalue(const Whitening& V, Index k) {
  Vector x(k);
  for (Index a = 0; a < k; ++a) x[a] = 1 + 0.5 * std::sin(static_cast<double>(a));
  double found = 1;
  for (int step = 0; step < power_steps; ++step) {
    x /= x.norm();
    x = V.transpose_times(V.times(x));
    found = x.norm();
    if (!(found > 0)) return 1;
  }
  return found;
}

}  // namespace

Solution accelerated_gradient(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "accelerated-gradient", accuracy)) return *found;
  const ScaledProblem scaled(problem);
  const NearestPointProblem& within = scaled.problem;
  const Whitening V(within);
  const Index k = within.rows();
  const Vector b = within.s - within.U.times(within.A.solve(within.z));
  double steepest = margin * largest_eigenvalue(V, k);
  Vector y = Vector::Zero(k), ahead = y, before = y, Vy = V.times(y), Vahead = Vy;
  double momentum = 1;
  return iterate(
      problem, accuracy, affordable_steps(within, most_steps, 1e5),
      [&](Index) {
        const Vector gradient = V.transpose_times(Vahead) - b;
        Vector next, Vnext;
        // The step is short enough when the quadratic model about `ahead` lies above at `next`.
        while (true) {
          next = ahead - gradient / steepest;
          for (Index a = 0; a < k; ++a)
            if (!scaled.two_sided[at(a)]) next[a] = std::max(0.0, next[a]);
          Vnext = V.times(next);
          const double moved = (next - ahead).norm();
          // What rounding leaves of a short step tells nothing of the curvature.
          if (!(moved > shortest * next.norm()) || (Vnext - Vahead).squaredNorm() <= steepest * moved * moved)
            break;
          steepest *= 1.5;
        }
        if ((ahead - next).dot(next - y) > 0) momentum = 1;
        const double following = 0.5 * (1 + std::sqrt(1 + 4 * momentum * momentum));
        const double push = (momentum - 1) / following;
        ahead = next + push * (next - y);
        Vahead = Vnext + push * (Vnext - Vy);
        y = next;
        Vy = Vnext;
        momentum = following;
        return false;
      },
      [&](Index) { return unscaled("accelerated-gradient", scaled, {}, y, y - std::exchange(before, y)); });
}

}  // namespace convex::inline algorithms
