#include "convex/prox_formulas/isotonic.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/running_sums.hpp"

namespace convex::prox_formulas {

namespace {

/// A run of entries that share their weighted mean.
struct Pool {
  Index first;
  DoubleDouble weight, sum;
  double mean;
};

Pool merged(const Pool& left, const Pool& right) {
  Pool both{left.first, add(left.weight, right.weight), add(left.sum, right.sum), 0};
  both.mean = both.sum.value() / both.weight.value();
  return both;
}

/// sign: 1 for an increasing answer, -1 for a decreasing one; entry(i): the pool of i alone.
template <class Entry>
Blocks pooled(Index n, double sign, Entry entry) {
  std::vector<Pool> pools;
  pools.reserve(64);
  for (Index i = 0; i < n; ++i) {
    Pool last = entry(i);
    for (; !pools.empty() && sign * pools.back().mean >= sign * last.mean; pools.pop_back())
      last = merged(pools.back(), last);
    pools.push_back(last);
  }
  Blocks blocks{Vector(n), {}};
  blocks.first.reserve(pools.size());
  for (std::size_t k = 0; k < pools.size(); ++k) {
    const Index end = k + 1 < pools.size() ? pools[k + 1].first : n;
    blocks.first.push_back(pools[k].first);
    blocks.x.segment(pools[k].first, end - pools[k].first).setConstant(pools[k].mean);
  }
  return blocks;
}

Blocks plain(const Vector& z, double sign) {
  return pooled(z.size(), sign, [&](Index i) { return Pool{i, {1, 0}, {z[i], 0}, z[i]}; });
}

Blocks weighted(const Vector& z, const Vector& d, double sign) {
  if (d.size() != z.size())
    throw InvalidInput("metric: " + std::to_string(d.size()) + " weights for a point of " +
                       std::to_string(z.size()) + "; give one an entry");
  if (d.size() == 0) return {z, {}};
  if (!(d.minCoeff() > 0 && std::isfinite(d.maxCoeff())))
    throw InvalidInput("metric: a weight is not positive and finite; give positive weights");
  const int k = -std::ilogb(d.maxCoeff());  // so that products with z are safe
  return pooled(z.size(), sign, [&, k](Index i) {
    const double w = std::ldexp(d[i], k), product = w * z[i];
    return Pool{i, {w, 0}, {product, std::fma(w, z[i], -product)}, z[i]};
  });
}

}  // namespace

Blocks proj_monotone(const Vector& z) { return plain(z, 1); }
Blocks proj_monotone(const Vector& z, const Vector& d) { return weighted(z, d, 1); }
Blocks proj_decreasing(const Vector& z) { return plain(z, -1); }
Blocks proj_decreasing(const Vector& z, const Vector& d) { return weighted(z, d, -1); }

void keep_normal_to_monotone(Vector& x, Vector& u) {
  for (Index i = 1; i < x.size(); ++i) x[i] = std::max(x[i], x[i - 1]);
  keep_running_sums(u, [&](Index i, double sum) {
    return i + 1 < x.size() && x[i + 1] == x[i] ? std::max(0.0, sum) : 0.0;
  });
}

Vector prox_sorted_norm1(const Vector& z, const Vector& w) {
  const Index n = z.size();
  if (w.size() != n)
    throw InvalidInput("sorted_norm1: " + std::to_string(w.size()) + " weights for a point of " +
                       std::to_string(n) + "; give one an entry");
  for (Index i = 0; i < n; ++i)
    if (!(w[i] >= 0 && (i == 0 || w[i] <= w[i - 1])))
      throw InvalidInput("sorted_norm1: weight " + std::to_string(i) +
                         " is negative or above the one before; sort the weights downwards");
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index i, Index j) { return std::abs(z[i]) > std::abs(z[j]); });
  Vector sorted(n);
  for (Index k = 0; k < n; ++k) sorted[k] = std::abs(z[order[static_cast<std::size_t>(k)]]);
  // In this order the answer is the decreasing point nearest to |z| - w, cut at 0.
  const Vector magnitude = pooled(n, -1, [&](Index k) {
                             const DoubleDouble rest = two_sum(sorted[k], -w[k]);
                             return Pool{k, {1, 0}, rest, rest.hi};
                           }).x;
  Vector x(n);
  for (Index k = 0; k < n; ++k) {
    const Index i = order[static_cast<std::size_t>(k)];
    x[i] = magnitude[k] > 0 ? std::copysign(magnitude[k], z[i]) : 0;
  }
  return x;
}

}  // namespace convex::prox_formulas
