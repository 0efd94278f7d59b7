#include "mechanics/motion/arc.hpp"

#include <algorithm>
#include <cstring>

#include "convex/processor.hpp"
#include "mechanics/motion/eight.hpp"
#include "mechanics/motion/polynomial_root.hpp"

namespace mechanics::inline motions {
namespace {

/// Without the zeros at the end, of which a polynomial has many.
std::span<const double> trimmed(std::span<const double> c) {
  std::size_t count = c.size();
  while (count > 0 && c[count - 1] == 0) --count;
  return c.first(count);
}

}  // namespace

Vector Arc::position(double tau) const {
  Vector sum = Vector::Zero(q.rows());
  for (Index k = q.cols(); k-- > 0;) sum = sum * tau + q.col(k);
  return sum;
}

Vector Arc::velocity(double tau) const {
  Vector sum = Vector::Zero(q.rows());
  for (Index k = q.cols(); k-- > 1;) sum = sum * tau + static_cast<double>(k) * q.col(k);
  return sum;
}

namespace {

/// Polynomials of so many coefficients are summed one term after the other.
constexpr std::size_t few_coefficients = 10;

/// What the coefficients from that of τ³ on are weighed by in q, q' and q'', over τ³, τ² and τ: eight of them
/// at a time, the last eight so that they end with the last one. Those that are among the eight before weigh
/// nothing there.
struct Weights {
  static constexpr std::size_t first = 3, most = most_coefficients + Eight::count;
  std::size_t whole, rest;  // blocks, and coefficients beyond them
  alignas(Eight) double of[3][most];
};

MOREAU_CLONES void find_weights(std::size_t count, double tau, Weights& to) {
  const double square = tau * tau, cube = square * tau, fourth = square * square;
  Wide power{1, tau, square, cube, fourth, fourth * tau, fourth * square, fourth * cube};
  Wide k{3, 4, 5, 6, 7, 8, 9, 10};
  const std::size_t terms = count - Weights::first;
  to.whole = terms / Eight::count;
  to.rest = terms % Eight::count;
  const auto put = [&](std::size_t which, std::size_t block, const Wide& weight)
      __attribute__((always_inline)) {
    std::memcpy(to.of[which] + block * Eight::count, &weight, sizeof weight);
  };
  for (std::size_t b = 0; b <= to.whole; ++b) {
    put(0, b, power);
    put(1, b, power * k);
    put(2, b, power * k * (k - 1));
    power *= fourth * fourth;
    k += static_cast<double>(Eight::count);
  }
  if (to.rest == 0) return;
  for (auto& weights : to.of) {
    double* const block = weights + to.whole * Eight::count;
    std::copy_backward(block, block + to.rest, block + Eight::count);
    std::fill_n(block, Eight::count - to.rest, 0.0);
  }
}

MOREAU_CLONES void weigh(const double* c, std::size_t count, const Weights& by, double* sums) {
  Wide sum[3]{}, part, weight;
  const auto add = [&](const double* from, std::size_t block) __attribute__((always_inline)) {
    std::memcpy(&part, from, sizeof part);
    for (std::size_t which = 0; which < 3; ++which) {
      std::memcpy(&weight, by.of[which] + block * Eight::count, sizeof weight);
      sum[which] += part * weight;
    }
  };
  for (std::size_t b = 0; b < by.whole; ++b) add(c + Weights::first + b * Eight::count, b);
  if (by.rest > 0) add(c + count - Eight::count, by.whole);
  for (std::size_t which = 0; which < 3; ++which) {
    Eight x;
    std::memcpy(x.of, &sum[which], sizeof x);
    sums[which] = ((x.of[0] + x.of[4]) + (x.of[2] + x.of[6])) + ((x.of[1] + x.of[5]) + (x.of[3] + x.of[7]));
  }
}

}  // namespace

void Arc::state(double tau, State& at, Vector& q2) const {
  const Index n = q.rows();
  const auto count = static_cast<std::size_t>(q.cols());
  at.t = t + tau;
  at.q.resize(n);
  at.v.resize(n);
  q2.resize(n);
  Weights by;
  bool are_known = false;
  for (Index i = 0; i < n; ++i) {
    const std::span<const double> c = trimmed(coefficients(q, i));
    if (c.size() > few_coefficients) {
      if (!are_known) find_weights(count, tau, by);
      are_known = true;
      double sum[3];
      weigh(c.data(), count, by, sum);
      at.q[i] = c[0] + tau * (c[1] + tau * (c[2] + tau * sum[0]));
      at.v[i] = c[1] + tau * (2 * c[2] + tau * sum[1]);
      q2[i] = 2 * c[2] + tau * sum[2];
      continue;
    }
    double value = 0, slope = 0, second = 0;
    for (std::size_t k = c.size(); k-- > 0;) {
      second = second * tau + slope;
      slope = slope * tau + value;
      value = value * tau + c[k];
    }
    at.q[i] = value;
    at.v[i] = slope;
    q2[i] = 2 * second;
  }
}

void Arc::state(double tau, State& at) const {
  Vector q2;
  state(tau, at, q2);
}

State Arc::state(double tau) const {
  State at;
  state(tau, at);
  return at;
}

Vector Arc::acceleration(double tau) const {
  State at;
  Vector q2;
  state(tau, at, q2);
  return q2;
}

Vector Arc::multipliers(double tau) const {
  Vector sum = Vector::Zero(lambda.rows());
  for (Index k = lambda.cols(); k-- > 0;) sum = sum * tau + lambda.col(k);
  return sum;
}

}  // namespace mechanics::inline motions
