#include "convex/cones/strict_functional.hpp"

#include <algorithm>
#include <cmath>

#include "convex/exact/elimination.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/invariant.hpp"

namespace convex::inline cones {
namespace {

bool is_strict(const IntegerVector& y, const IntegerRows& rows) {
  return std::all_of(rows.begin(), rows.end(), [&](const IntegerVector& g) { return dot(y, g).sign() > 0; });
}

/// v with entries of at most `size`, in about its direction.
IntegerVector coarse(const IntegerVector& v, double size) {
  double largest = 0;
  for (const Integer& entry : v) largest = std::max(largest, std::abs(nearest_quotient(entry, 1)));
  IntegerVector rounded;
  for (const Integer& entry : v) {
    const double ratio = size * (nearest_quotient(entry, 1) / largest);
    rounded.push_back(std::isfinite(ratio) ? std::llround(ratio) : 0);
  }
  return rounded;
}

/// The unit vectors and their opposites, then the sum of the rows, ever less rounded. Small numbers make the
/// section's coordinates short.
IntegerVector simple_functional(const IntegerRows& rows, std::size_t r) {
  IntegerVector sum(r, 0);
  for (const IntegerVector& g : rows)
    for (std::size_t i = 0; i < r; ++i) sum[i] += g[i];
  for (std::size_t i = r; i-- > 0;) {
    IntegerVector unit(r, 0);
    unit[i] = sum[i].sign();
    if (is_strict(unit, rows)) return unit;
  }
  for (double size : {1.0, 2.0, 4.0, 16.0, 256.0})
    if (IntegerVector y = coarse(sum, size); is_strict(y, rows)) return y;
  make_primitive(sum);
  return is_strict(sum, rows) ? sum : IntegerVector{};
}

class Simplex {
 public:
  Simplex(const IntegerRows& rows, std::size_t r) : rows_(rows), basis_(r, none) {
    inverse_ = {IntegerRows(r, IntegerVector(r, 0)), 1};
    for (std::size_t i = 0; i < r; ++i) inverse_.adjugate[i][i] = 1;
    std::size_t members = 0;
    for (std::size_t j = 0; j < rows.size() && members < r; ++j) {
      const IntegerVector c = times(rows[j], inverse_.adjugate);
      for (std::size_t k = 0; k < r; ++k) {
        if (basis_[k] != none || c[k].is_zero()) continue;
        exchange(inverse_, k, c);
        basis_[k] = j;
        ++members;
        break;
      }
    }
    invariant(members == r, "the rows span the space");
    target_.assign(r, 0);
    for (std::size_t j : basis_)
      for (std::size_t i = 0; i < r; ++i) target_[i] += rows[j][i];
  }

  StrictFunctional run() {
    bool stands_still = false;
    while (true) {
      IntegerVector y(basis_.size(), 0);  // y·g = determinant on the basis
      for (std::size_t i = 0; i < y.size(); ++i)
        for (const Integer& entry : inverse_.adjugate[i]) y[i] += entry;
      const std::size_t entering = choose(y, stands_still);
      if (entering == none) {
        make_primitive(y);
        return {y, {}};
      }
      const IntegerVector c = times(rows_[entering], inverse_.adjugate);
      const IntegerVector lambda = times(target_, inverse_.adjugate);
      const std::size_t leaving = ratio_test(c, lambda);
      if (leaving == none) return {{}, ray(entering, c)};
      stands_still = lambda[leaving].is_zero();
      exchange(inverse_, leaving, c);
      basis_[leaving] = entering;
    }
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// The row that y serves worst, or the first that it serves ill; none when y is positive on all.
  std::size_t choose(const IntegerVector& y, bool first_one) const {
    std::size_t chosen = none, first = none;
    Integer worst = inverse_.determinant;
    bool positive = true;
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      const Integer value = dot(y, rows_[j]);
      if (value < inverse_.determinant && first == none) first = j;
      if (value < worst) {
        worst = value;
        chosen = j;
      }
      positive = positive && value.sign() > 0;
    }
    return positive ? none : first_one ? first : chosen;
  }

  std::size_t ratio_test(const IntegerVector& c, const IntegerVector& lambda) const {
    std::size_t leaving = none;
    for (std::size_t k = 0; k < c.size(); ++k) {
      if (c[k].sign() <= 0) continue;
      if (leaving == none) {
        leaving = k;
        continue;
      }
      const auto order = lambda[k] * c[leaving] <=> lambda[leaving] * c[k];
      if (order < 0 || (order == 0 && basis_[k] < basis_[leaving])) leaving = k;
    }
    return leaving;
  }

  std::vector<std::size_t> ray(std::size_t entering, const IntegerVector& c) const {
    std::vector<std::size_t> members{entering};
    for (std::size_t k = 0; k < c.size(); ++k)
      if (c[k].sign() < 0) members.push_back(basis_[k]);
    return members;
  }

  const IntegerRows& rows_;
  std::vector<std::size_t> basis_;
  ExactInverse inverse_;
  IntegerVector target_;
};

}  // namespace

StrictFunctional strict_functional(const IntegerRows& rows, std::size_t r) {
  if (IntegerVector y = simple_functional(rows, r); !y.empty()) return {std::move(y), {}};
  return Simplex(rows, r).run();
}

}  // namespace convex::inline cones
