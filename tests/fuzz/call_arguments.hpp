#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>

#include "tests/fuzz/call_value.hpp"

/// What the oracle of values reads from a call, and its two halves: functions and sets.
namespace fuzz {

using convex::Argument;
using convex::Call;
using convex::NamedArgument;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

inline thread_local Real slack_of_sets = rounded;

/// `call_value` and the value of a set's indicator, with the slack that is set.
std::optional<CallValue> value_of_call(const Call& f, const Point& x);
std::optional<CallValue> set_value(const Call& set, const Point& x);

inline Real number(const Call& call, std::size_t index, Real fallback) {
  if (index >= call.arguments.size()) return fallback;
  const double* given = std::get_if<double>(&call.arguments[index].value);
  return given ? static_cast<Real>(*given) : fallback;
}

inline const convex::Matrix* matrix(const Call& call, std::size_t index) {
  return index < call.arguments.size() ? std::get_if<convex::Matrix>(&call.arguments[index].value) : nullptr;
}

/// A vector, or a number for one with equal entries.
inline Point vector(const Call& call, std::size_t index, std::size_t n, Real fallback) {
  if (index < call.arguments.size())
    if (const auto* given = std::get_if<convex::Vector>(&call.arguments[index].value))
      return Point(given->begin(), given->end());
  return Point(n, number(call, index, fallback));
}

inline const Call& nested(const Call& call, std::size_t index) {
  return *std::get<std::shared_ptr<const Call>>(call.arguments[index].value);
}

inline Real norm(const Point& x) {
  Real sum = 0;
  for (const Real v : x) sum += v * v;
  return std::sqrt(sum);
}

/// A·x + b, and the size of what it is a sum of.
inline Point affine(const convex::Matrix& A, const Point& x, const Point& b, Real& size) {
  Point image(static_cast<std::size_t>(A.rows()));
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = i < b.size() ? b[i] : 0;
    size = std::max(size, std::abs(image[i]));
    for (std::size_t j = 0; j < x.size(); ++j) {
      const Real part = A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * x[j];
      image[i] += part;
      size = std::max(size, std::abs(part));
    }
  }
  return image;
}

inline CallValue constant(Real value) { return {value, true, std::abs(value)}; }

inline CallValue allowed(bool inside) { return {inside ? 0 : infinity, true, 0}; }

}  // namespace fuzz
