#include "mechanics/motion/polynomial_root.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "convex/invariant.hpp"
#include "mechanics/motion/terms.hpp"

namespace mechanics::inline motions {
namespace {

/// Numbers where they stand: the search is made for each constraint in each step.
class Coefficients {
 public:
  explicit Coefficients(std::size_t size) : size_(size) {
    convex::invariant(size <= most_coefficients, "series of a motion have fewer coefficients");
  }
  explicit Coefficients(std::span<const double> c) : Coefficients(c.size()) {
    std::copy(c.begin(), c.end(), begin());
  }
  Coefficients(const Coefficients& other) : Coefficients(std::span<const double>(other)) {}
  Coefficients& operator=(const Coefficients&) = delete;
  std::size_t size() const { return size_; }
  double& operator[](std::size_t k) { return of_[k]; }
  double operator[](std::size_t k) const { return of_[k]; }
  double* begin() { return of_.data(); }
  double* end() { return of_.data() + size_; }
  const double* begin() const { return of_.data(); }
  const double* end() const { return of_.data() + size_; }
  double front() const { return of_[0]; }
  double back() const { return of_[size_ - 1]; }

 private:
  std::size_t size_;
  std::array<double, most_coefficients> of_;
};

/// A Bernstein coefficient is rounded about so many times, relative to what a value of p is the sum of.
constexpr double roundings_of_coefficients = 8;

/// Halvings after which an interval has no double inside.
constexpr int deepest = 60;

/// Σ c_k (end x)^k on [0, 1] by its Bernstein coefficients: b_j = Σ_k C(j,k)/C(d,k) c_k end^k.
Coefficients bernstein(std::span<const double> c, double end) {
  const std::size_t size = c.size();
  Coefficients b(size);
  // Rows of differences: Δ^k b_0 = c_k end^k / C(d,k), summed up from the highest difference down.
  double power = 1, binomial = 1;
  for (std::size_t k = 0; k < size; ++k) {
    b[k] = c[k] * power / binomial;
    power *= end;
    binomial *= static_cast<double>(size - 1 - k) / static_cast<double>(k + 1);
  }
  std::size_t level = size - 1;
  // Four levels at once, each one number behind the one before it.
  for (; level >= 4; level -= 4) {
    double first = b[level - 1], second = b[level - 2], third = b[level - 3], fourth = b[level - 4];
    for (std::size_t j = level; j < size + 3; ++j) {
      fourth += third;
      third += second;
      second += first;
      if (j < size) first += b[j];
      b[j - 3] = fourth;
    }
  }
  for (; level > 0; --level)
    for (std::size_t j = level; j < size; ++j) b[j] += b[j - 1];
  return b;
}

/// Cuts at the middle (de Casteljau): `b` becomes the left half, the right one is returned.
Coefficients split(Coefficients& b) {
  const std::size_t size = b.size();
  Coefficients right(size);
  for (std::size_t level = 0; level < size; ++level) {
    right[size - 1 - level] = b[size - 1];
    for (std::size_t j = size - 1; j > level; --j) b[j] = 0.5 * (b[j - 1] + b[j]);
  }
  return right;
}

/// p(x) and p'(x).
struct Tangent {
  double value = 0, slope = 0;
};

Tangent tangent(std::span<const double> c, double x) {
  Tangent of;
  if (c.empty()) return of;
  for (std::size_t k = c.size(); k-- > 1;) {
    of.value = of.value * x + c[k];
    of.slope = of.slope * x + static_cast<double>(k) * c[k];
  }
  of.value = of.value * x + c[0];
  return of;
}

/// The zero between a point where p >= 0 and one where p <= 0: Newton's method from x, kept inside by
/// bisection.
double between(std::span<const double> c, double low, double high, double x) {
  for (int i = 0; i < 200; ++i) {
    const Tangent p = tangent(c, x);
    if (p.value == 0) return x;
    (p.value > 0 ? low : high) = x;
    double next = x - p.value / p.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x || next == low || next == high) return next;
    x = next;
  }
  return x;
}

/// Where p is least in an interval in which it falls at first and rises at last: the zero of p'.
double least(std::span<const double> c, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (tangent(c, middle).slope < 0 ? low : high) = middle;
  }
  return low;
}

/// The coefficients of p(at + τ).
void shift(Coefficients& c, double at) {
  if (at == 0) return;
  for (std::size_t level = 0; level + 1 < c.size(); ++level)
    for (std::size_t k = c.size() - 1; k-- > level;) c[k] += at * c[k + 1];
}

/// The least of p by its Bernstein coefficients, which enclose it; what is within `rounding` is not looked
/// at.
double least_enclosed(Coefficients& b, double known, double rounding, int depth) {
  known = std::min({known, b.front(), b.back()});
  if (depth == 0 || *std::min_element(b.begin(), b.end()) >= known - rounding) return known;
  Coefficients right = split(b);
  return least_enclosed(right, least_enclosed(b, known, rounding, depth - 1), rounding, depth - 1);
}

/// How often the signs of numbers change, zeros left out; from 2 on it does not matter.
int sign_changes(const Coefficients& b) {
  int changes = 0;
  double last = 0;
  for (const double x : b) {
    if (x == 0) continue;
    if (x * last < 0 && ++changes == 2) break;
    last = x > 0 ? 1 : -1;
  }
  return changes;
}

/// The first x in [low, low + width] where p goes below 0; infinite if it does not. b: the Bernstein
/// coefficients of p there; c: its coefficients.
double first_below(Coefficients& b, const Coefficients& c, double low, double width, int depth) {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (b.front() < 0) return low;
  const int changes = sign_changes(b);
  if (changes == 0) return never;
  if (changes == 1 && b.back() < 0) return between(c, low, low + width, low);
  const double middle = low + 0.5 * width;
  if (depth == 0 || middle == low) return low;
  Coefficients right = split(b);
  const double found = first_below(b, c, low, 0.5 * width, depth - 1);
  return found != never ? found : first_below(right, c, middle, 0.5 * width, depth - 1);
}

/// The first τ in [0, end] with p(τ) < level (sense 1) or p(τ) > level (sense -1); infinite if there is none.
double first_beyond(Coefficients c, double end, double level, double sense) {
  c[0] -= level;
  for (double& x : c) x *= sense;
  Coefficients b = bernstein(c, end);
  return first_below(b, c, 0, end, deepest);
}

std::size_t first_change(const Coefficients& c) {
  std::size_t k = 1;
  while (k < c.size() && c[k] == 0) ++k;
  return k;
}

bool rises_at_first(const Coefficients& c) {
  const std::size_t k = first_change(c);
  return k == c.size() || c[k] > 0;
}

/// Where p, which rises at first, comes back to p(0).
double first_return(const Coefficients& c, double end) {
  return first_beyond(Coefficients(std::span<const double>(c).subspan(first_change(c))), end, 0, 1);
}

/// What the Bernstein coefficients of p alone tell: they stay above `rounding`, and so does p; or they come
/// from there to below -rounding without turning back across either, and p has one zero, at `crossing`.
struct Outline {
  bool stays = false, crosses = false;
  double crossing = 0;
};

Outline outline(std::span<const double> c, double end, double rounding) {
  Outline of;
  of.stays = c[0] - sum_of_terms(c, end) > rounding;
  if (of.stays) return of;
  const Coefficients b = bernstein(c, end);
  std::size_t high = 0, low = 0;  // the first ones not above rounding, and below -rounding
  while (high < b.size() && b[high] > rounding) ++high;
  of.stays = high == b.size();
  if (of.stays || high == 0) return of;
  low = high;
  while (low < b.size() && b[low] >= -rounding && b[low] <= rounding) ++low;
  std::size_t last = low;
  while (last < b.size() && b[last] < -rounding) ++last;
  if (low == b.size() || last < b.size()) return of;
  of.crosses = true;
  const double part = b[high - 1] / (b[high - 1] - b[low]);
  const auto before = static_cast<double>(high - 1), after = static_cast<double>(low);
  of.crossing = end * (before + part * (after - before)) / static_cast<double>(b.size() - 1);
  return of;
}

}  // namespace

double least_value(std::span<const double> c, double end, double known) {
  while (c.size() > 1 && c.back() == 0) c = c.first(c.size() - 1);
  if (c.empty() || c[0] - sum_of_terms(c, end) >= known) return known;
  double rising = std::abs(c[0]), falling = 0, power = end;
  for (const double x : c.subspan(1)) {
    (x < 0 ? falling : rising) += std::abs(x * power);
    power *= end;
  }
  const double rounding =
      roundings_of_coefficients * std::numeric_limits<double>::epsilon() * (rising + falling);
  if (c[0] - falling >= known - rounding) return known;
  Coefficients b = bernstein(c, end);
  return std::min(known, least_enclosed(b, known - rounding, rounding, deepest) + rounding);
}

std::optional<FirstZero> first_zero(std::span<const double> coefficients, double end, double rounding) {
  if (coefficients.empty() || !(end > 0)) return std::nullopt;
  while (coefficients.size() > 1 && coefficients.back() == 0)
    coefficients = coefficients.first(coefficients.size() - 1);
  const Outline of = outline(coefficients, end, rounding);
  if (of.stays) return std::nullopt;
  if (of.crosses) return FirstZero{between(coefficients, 0, end, of.crossing), false};
  Coefficients c(coefficients);
  double begin = 0;
  while (begin < end) {
    const double enter = first_beyond(c, end - begin, rounding, 1);
    if (!(enter <= end - begin)) return std::nullopt;
    shift(c, enter);
    begin += enter;
    const double rest = end - begin;
    const double leave = first_beyond(c, rest, 2 * rounding, -1);
    // A p that rises from a 0 that rounding has put below itself is 0 again where it comes back.
    const bool rises = enter == 0 && rises_at_first(c);
    const double below = first_beyond(c, rest, (rises ? std::min(c[0], 0.0) : 0) - rounding, 1);
    if (below < leave) {
      if (c[0] > 0) return FirstZero{begin + between(c, 0, below, 0), false};
      return FirstZero{begin + (rises ? first_return(c, below) : 0), false};
    }
    if (!(leave <= rest)) {
      if (const Tangent last = tangent(c, rest); last.value > 0 || last.slope >= 0) return std::nullopt;
      return FirstZero{end, false};
    }
    if (!rises) return FirstZero{begin + least(c, 0, leave), true};
    shift(c, leave);
    begin += leave;
  }
  return std::nullopt;
}

}  // namespace mechanics::inline motions
