#include "mechanics/expression/cubic_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/counted.hpp"
#include "mechanics/expression/number.hpp"

namespace mechanics::expression {

double CubicSpline::operator()(double at) const {
  if (!(at >= x.front() && at <= x.back())) return std::numeric_limits<double>::quiet_NaN();
  const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  const auto i = static_cast<std::size_t>(next - x.begin()) - 1;
  const double u = at - x[i];
  return ((jerk[i].value * u + bend[i].value) * u + slope[i].value) * u + y[i];
}

std::optional<std::string> fault_of_table(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size())
    return "has " + convex::counted(x.size(), "point", "points") + " and " +
           convex::counted(y.size(), "value", "values") + "; give as many of the one as of the other";
  if (x.size() < 2) return "has fewer than two points; give at least two";
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) return "has a number that is not finite; correct it";
  for (std::size_t i = 1; i < x.size(); ++i)
    if (!(x[i - 1] < x[i]))
      return "has points that do not increase, see number " + std::to_string(i + 1) + "; put them in order";
  return std::nullopt;
}

namespace {

/// The numbers of the pieces, in one arithmetic.
template <class Real>
struct Pieces {
  std::vector<Real> slope, bend, jerk;
};

/// Second derivatives M_i at the knots: h_(i-1) M_(i-1) + 2 (h_(i-1) + h_i) M_i + h_i M_(i+1) = 6 (d_i -
/// d_(i-1)) with the slopes d_i of the chords and M = 0 at both ends; the matrix is diagonally dominant.
template <class Real>
Pieces<Real> pieces_of(const std::vector<Real>& x, const std::vector<Real>& y) {
  const std::size_t n = x.size();
  const Real two = 2, six = 6;
  std::vector<Real> h(n - 1), chord(n - 1), M(n), upper(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    chord[i] = (y[i + 1] - y[i]) / h[i];
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Real pivot = two * (h[i - 1] + h[i]) - h[i - 1] * upper[i - 1];
    upper[i] = h[i] / pivot;
    M[i] = (six * (chord[i] - chord[i - 1]) - h[i - 1] * M[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) M[i] = M[i] - upper[i] * M[i + 1];
  Pieces<Real> found;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    found.slope.push_back(chord[i] - h[i] * (two * M[i] + M[i + 1]) / six);
    found.bend.push_back(M[i] / two);
    found.jerk.push_back((M[i + 1] - M[i]) / (six * h[i]));
  }
  return found;
}

std::vector<convex::Fraction> fractions_of(const std::vector<Number>& numbers) {
  std::vector<convex::Fraction> found;
  for (const Number& number : numbers) found.push_back(number.fraction());
  return found;
}

std::vector<long double> middles(std::span<const Rounded> numbers) {
  std::vector<long double> found;
  for (const Rounded number : numbers) found.push_back(number.value);
  return found;
}

/// The better of two values, with the bound of the other.
std::vector<Rounded> joined(const std::vector<long double>& precise, const std::vector<Rounded>& bounded) {
  std::vector<Rounded> found;
  for (std::size_t i = 0; i < precise.size(); ++i) {
    const auto value = static_cast<double>(precise[i]);
    found.emplace_back(value, widened(bounded[i].radius + std::abs(value - bounded[i].value)));
  }
  return found;
}

}  // namespace

ExactPieces exact_pieces(std::span<const convex::Fraction> x, std::span<const convex::Fraction> y) {
  const auto found =
      pieces_of(std::vector<Number>(x.begin(), x.end()), std::vector<Number>(y.begin(), y.end()));
  return {fractions_of(found.slope), fractions_of(found.bend), fractions_of(found.jerk)};
}

CubicSpline natural_cubic_spline(std::span<const Rounded> x, std::span<const Rounded> y) {
  const auto precise = pieces_of(middles(x), middles(y));
  const auto bounded =
      pieces_of(std::vector<Rounded>(x.begin(), x.end()), std::vector<Rounded>(y.begin(), y.end()));
  CubicSpline spline{{},
                     {},
                     joined(precise.slope, bounded.slope),
                     joined(precise.bend, bounded.bend),
                     joined(precise.jerk, bounded.jerk)};
  for (const Rounded number : x) spline.x.push_back(number.value);
  for (const Rounded number : y) spline.y.push_back(number.value);
  return spline;
}

CubicSpline natural_cubic_spline(std::span<const double> x, std::span<const double> y) {
  return natural_cubic_spline(std::vector<Rounded>(x.begin(), x.end()),
                              std::vector<Rounded>(y.begin(), y.end()));
}

}  // namespace mechanics::expression
