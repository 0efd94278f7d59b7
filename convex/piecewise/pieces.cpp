#include "convex/piecewise/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "convex/counted.hpp"
#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"
#include "convex/piecewise/curve_builder.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/piece_cursor.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  message.precision(17);
  message << "plq: ";
  (message << ... << parts);
  throw InvalidInput(message.str());
}

/// The rows and breaks as they were given.
struct Table {
  const Vector& breaks;
  const Matrix& rows;
  Index first = 0, last = 0;  ///< the finite pieces, set by `check`

  bool is_infinite(Index i) const { return std::isinf(rows(i, 0)) && rows(i, 0) > 0; }
  double slope(Index i, double x) const { return std::fma(rows(i, 0), x, rows(i, 1)); }
  double value(Index i, double x) const { return 0.5 * rows(i, 0) * x * x + rows(i, 1) * x + rows(i, 2); }
  double largest_slope_term(Index i, double x) const {
    return std::max(std::abs(rows(i, 0) * x), std::abs(rows(i, 1)));
  }
  double largest_term(Index i, double x) const {
    return std::max({std::abs(0.5 * rows(i, 0) * x * x), std::abs(rows(i, 1) * x), std::abs(rows(i, 2))});
  }
  Segment line(Index i) const { return anchored(1, rows(i, 0), 0, rows(i, 1), rows(i, 2)); }

  void check();
  void check_rows() const;
  void check_joint(Index i) const;
};

void Table::check_rows() const {
  if (rows.cols() != 3 || rows.rows() != breaks.size() + 1)
    refuse("the coefficients are ", rows.rows(), "x", rows.cols(),
           "; give a row [c2, c1, c0] for each of the ", breaks.size() + 1, " pieces that ",
           counted(breaks.size(), "break makes", "breaks make"));
  for (Index i = 0; i < breaks.size(); ++i)
    if (!std::isfinite(breaks[i])) refuse("break ", i, " is not finite; leave it out");
  for (Index i = 0; i < rows.rows(); ++i) {
    if (is_infinite(i)) {
      if (rows(i, 1) != 0 || rows(i, 2) != 0) refuse("piece ", i, " is +inf; write it as [inf, 0, 0]");
      continue;
    }
    if (!rows.row(i).allFinite())
      refuse("a coefficient of piece ", i, " is not finite; +inf is written as [inf, 0, 0]");
    if (rows(i, 0) < 0) refuse("piece ", i, " has c2 = ", rows(i, 0), ", it is not convex; give c2 >= 0");
  }
}

void Table::check_joint(Index i) const {
  const double x = breaks[i];
  const double jump = value(i + 1, x) - value(i, x), bend = slope(i + 1, x) - slope(i, x);
  const double size = std::max(largest_term(i, x), largest_term(i + 1, x));
  const double slope_size = std::max(largest_slope_term(i, x), largest_slope_term(i + 1, x));
  if (!std::isfinite(size) || !std::isfinite(slope_size))
    refuse("the pieces at break ", i, " overflow there; rescale the data");
  if (!(std::abs(jump) <= joint_tolerance * size))
    refuse("pieces ", i, " and ", i + 1, " differ by ", jump, " at their break x = ", x,
           ", it is not convex; change a c0");
  if (!(bend >= -joint_tolerance * slope_size))
    refuse("the slope falls by ", -bend, " from piece ", i, " to ", i + 1, " at x = ", x,
           ", it is not convex; let slopes increase");
}

void Table::check() {
  check_rows();
  const Index count = rows.rows();
  while (first < count && is_infinite(first)) ++first;
  if (first == count) refuse("every piece is +inf, it is improper; make one finite");
  last = count - 1;
  while (is_infinite(last)) --last;
  for (Index i = first; i < last; ++i)
    if (is_infinite(i)) refuse("piece ", i, " is +inf between finite ones, it is not convex");
  for (Index i = 0; i + 1 < breaks.size(); ++i) {
    const bool is_point = first == i + 1 && last == first && breaks[i] == breaks[i + 1];
    if (!(breaks[i] < breaks[i + 1]) && !is_point)
      refuse("breaks ", i, " and ", i + 1, " are ", breaks[i], " and ", breaks[i + 1],
             "; breaks must increase");
  }
  for (Index i = first; i < last; ++i) check_joint(i);
}

}  // namespace

PiecewiseQuadratic piecewise_quadratic(const Vector& breaks, const Matrix& coefficients) {
  Table table{breaks, coefficients};
  table.check();
  const auto [first, last] = std::pair(table.first, table.last);
  const bool bounded_below = first > 0, bounded_above = last < breaks.size();
  if (bounded_below && bounded_above && breaks[first - 1] == breaks[last])
    return piecewise::point(breaks[last], table.value(first, breaks[last]));
  CurveBuilder curve(2 * static_cast<std::size_t>(breaks.size()));
  if (bounded_below) {
    const double x = breaks[first - 1], y = table.slope(first, x);
    curve.segment(vertical(x, table.value(first, x)));
    curve.corner(x, y);
  }
  for (Index i = first; i < last; ++i) {
    const double x = breaks[i];
    curve.segment(table.line(i));
    curve.joint(x, table.slope(i, x), table.slope(i + 1, x), table.value(i, x));
  }
  curve.segment(table.line(last));
  if (bounded_above) {
    const double x = breaks[last], y = table.slope(last, x);
    curve.corner(x, y);
    curve.segment(vertical(x, table.value(last, x)));
  }
  return curve.finish("plq");
}

namespace {

/// [c2, c1, c0] of a line: c1 and then c0 such that the rounded row goes through the anchor.
Eigen::RowVector3d row(const Segment& line) {
  const double c2 = line.rise / line.run, c1 = std::fma(-c2, line.x, line.y);
  if (line.x == 0) return {c2, line.y, line.f};
  const DoubleDouble square = two_product(-0.5 * c2 * line.x, line.x), product = two_product(-c1, line.x);
  const double c0 = add(add(square, product), DoubleDouble{line.f, 0}).value();
  if (!std::isfinite(c2) || !std::isfinite(c1) || !std::isfinite(c0))
    refuse("a coefficient leaves the range of doubles; rescale the data");
  return {c2, c1 + 0.0, c0 + 0.0};
}

}  // namespace

Pieces pieces(const PiecewiseQuadratic& f) {
  const Eigen::RowVector3d infinite(std::numeric_limits<double>::infinity(), 0, 0);
  std::vector<double> breaks;
  std::vector<Eigen::RowVector3d> rows;
  const Interval where = domain(f);
  if (where.low == where.high) {
    breaks = {where.low, where.low};
    rows = {infinite, {0, 0, f(where.low)}, infinite};
  } else {
    PieceCursor cursor(f);
    if (std::isfinite(where.low)) {
      breaks.push_back(where.low);
      rows.push_back(infinite);
    }
    rows.push_back(row(cursor.piece()));
    while (cursor.has_next()) {
      breaks.push_back(cursor.end());
      cursor.next();
      rows.push_back(row(cursor.piece()));
    }
    if (std::isfinite(where.high)) {
      breaks.push_back(where.high);
      rows.push_back(infinite);
    }
  }
  Pieces found{Vector(static_cast<Index>(breaks.size())), Matrix(static_cast<Index>(rows.size()), 3)};
  for (std::size_t i = 0; i < breaks.size(); ++i) found.breaks[static_cast<Index>(i)] = breaks[i];
  for (std::size_t i = 0; i < rows.size(); ++i) found.coefficients.row(static_cast<Index>(i)) = rows[i];
  return found;
}

}  // namespace convex::inline piecewise_quadratics
