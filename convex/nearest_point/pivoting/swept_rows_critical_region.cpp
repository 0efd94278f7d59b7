#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/nearest_point/pivoting/corrections.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Corrections of a column of a critical region, before it is given up.
constexpr int most_corrections = 6;

/// Splits the columns, in twice the working precision before. False when an entry is not finite.
bool split(CriticalRegion& region, Index n) {
  const double count = static_cast<double>(region.columns);
  double square = 0;
  for (Index i = 0; i < region.stride; ++i) {
    double most = 0, sum = 0;
    for (Index j = 0; j < region.columns; ++j) {
      const double size = std::abs(region.leading(i, j));
      most = std::max(most, size);
      sum += size;
    }
    if (!std::isfinite(sum)) return false;
    const double shift = CriticalRegion::leaves_leading * most;
    for (Index j = 0; j < region.columns; ++j) {
      double &leading = region.leading(i, j), &rest = region.rest(i, j);
      const double whole = leading;
      leading = (whole + shift) - shift;
      rest += whole - leading;
    }
    const double length = i < n ? region.length[i] * (sum + count * most) : 0;
    square += length * length;
  }
  // Each sum of products with a rest is added up in doubles.
  region.error_of_sums = (count + 4) * unit_roundoff * CriticalRegion::beyond_leading *
                         std::sqrt(static_cast<double>(n) * square);
  return std::isfinite(region.error_of_sums);
}

}  // namespace

/// After a solve with pivots and corrections. The region of a working set costs about as much as a solve for
/// each of its columns: it is found when so many solves have kept the set, so that it at most doubles what
/// all have cost, whatever comes after.
void SweptRows::follow_working_set() {
  const SmallTableau& t = tableau_;
  sweeps_ += t.steps;
  if (t.steps > 0) kept_ = 0;
  if (++kept_ == t.n + t.size && !find_critical_region()) region_.reset();
}

/// False when a column cannot be told to twice the working precision.
bool SweptRows::find_critical_region() {
  SmallTableau& t = tableau_;
  if (!region_) region_ = std::make_unique_for_overwrite<CriticalRegion>();
  CriticalRegion& region = *region_;
  const Index n = t.n;
  region.columns = n + t.size;
  region.stride = padded(region.columns);
  for (double* x : {region.unit, region.error, region.length, region.pull, region.x})
    fill_packs(region.stride, 0, x);
  fill_packs(2 * region.stride * region.columns, 0, region.split);
  std::copy_n(t.rows, t.size, region.rows);
  double largest_unit = 0;  // the largest ||·||_D of a coordinate
  const auto unit = [](double length) { return std::ldexp(1.0, -std::ilogb(length)); };
  for (Index i = 0; i < n; ++i) {
    region.length[i] = std::sqrt(t.diagonal[i]);
    region.pull[i] = -region.length[i];
    region.unit[i] = unit(region.length[i]);
    largest_unit = std::max(largest_unit, region.length[i]);
  }
  for (Index k = 0; k < t.size; ++k) {
    region.length[n + k] = t.length[k];
    region.pull[n + k] = t.pull[k] > 0 ? t.pull[k] : -t.length[k];
    region.unit[n + k] = unit(t.length[k]);
  }
  for (Index j = 0; j < region.columns; ++j) {
    double* const column = region.balance + j * t.ld;
    fill_packs(t.ld, 0, column);
    std::copy_n(j < n ? t.A + j * n : t.U + t.rows[j - n] * n, n, column);
  }
  // A row of zeros has no length that its slack could be compared with.
  bool is_known = std::all_of(t.scale_at, t.scale_at + t.m, [](double length) { return length > 0; });
  // No row changes sides, whatever its sign.
  fill_packs(t.stride, 0, t.leave);
  fill_packs(t.stride, 0, t.enter);
  const double root = std::sqrt(static_cast<double>(n));
  Vector z = Vector::Zero(n), s = Vector::Zero(t.all);
  t.linear = z.data();
  t.s = s.data();
  for (Index j = 0; j < region.columns && is_known; ++j) {
    double& entry = j < n ? z[j] : s[t.rows[j - n]];
    entry = 1;
    is_known = small_kernels().begin_again(t) && small_kernels().settle(t);
    double before[SmallTableau::most];
    Corrections known;
    for (int pass = 0; is_known && (pass < 2 || t.step > at_rounding * known.scale); ++pass) {
      std::copy_n(t.lambda, t.size, before);
      is_known = pass < most_corrections && correct(pass == 0, 0) && known.note(t);
    }
    const double over = 1 / region.unit[j];
    for (Index i = 0; i < n; ++i) {
      region.leading(i, j) = over * t.q[i];
      region.rest(i, j) = over * t.q_low[i];
    }
    for (Index k = 0; k < t.size; ++k) {
      const DoubleDouble sum = two_sum(before[k], t.change[k]);
      region.leading(n + k, j) = over * sum.hi;
      region.rest(n + k, j) = over * sum.lo;
    }
    // And of what underflows.
    region.error[j] = over * known.remaining + root * largest_unit * std::numeric_limits<double>::min();
    is_known = is_known && std::isfinite(region.error[j]) && std::isfinite(region.unit[j]);
    entry = 0;
  }
  take_linear_term();
  is_known = is_known && split(region, n);
  for (Index a = 0; a < t.stride; ++a) {
    t.leave[a] = t.held[a] && !t.two_sided[a] ? -t.scale_at[a] : 0;
    t.enter[a] = t.held[a] ? 0 : t.inverse_scale[a];
  }
  return is_known;
}

const CriticalRegion* SweptRows::take_affine_point() {
  SmallTableau& t = tableau_;
  if (!region_ || region_->columns != t.n + t.size || !std::equal(t.rows, t.rows + t.size, region_->rows))
    return nullptr;
  small_kernels().take_affine_point(t, *region_, problem_.z.data(), problem_.s.data());
  if (!looks_at_all()) measure_slacks_of_all();
  t.steps = 0;
  return region_.get();
}

}  // namespace convex::inline pivoting
