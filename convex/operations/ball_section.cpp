#include "convex/operations/ball_section.hpp"

#include <cmath>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/functions/sets.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/sum.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

struct Ball {
  double radius = 0;
  Vector center;
};

std::optional<Ball> ball_of(const Function& f, Index m) {
  const Call call = f.call();
  if (call.name != "indicator" || call.arguments.size() != 1) return std::nullopt;
  const auto* set = std::get_if<std::shared_ptr<const Call>>(&call.arguments[0].value);
  if (!set || (*set)->name != "ball2" || (*set)->arguments.empty()) return std::nullopt;
  const auto& arguments = (*set)->arguments;
  const auto* radius = std::get_if<double>(&arguments[0].value);
  if (!radius) return std::nullopt;
  if (arguments.size() == 1) return Ball{*radius, Vector::Zero(m)};
  const auto* center = std::get_if<Vector>(&arguments[1].value);
  return center ? std::optional(Ball{*radius, *center}) : std::nullopt;
}

/// {x : |Ax + b - center| <= radius} where A's columns are orthogonal and of one length: a ball again.
std::optional<Ball> section_of(const Function& f, const Matrix& A, const Vector& b) {
  const auto ball = ball_of(f, A.rows());
  if (!ball || ball->center.size() != A.rows() || !std::isfinite(ball->radius)) return std::nullopt;
  const Index n = A.cols();
  const ExactRows columns = exact_rows(A.transpose());
  const Fraction alpha = dot(columns[0], columns[0]);
  if (sign(alpha) == 0) return std::nullopt;
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (!(dot(columns[i], columns[j]) == (i == j ? alpha : fraction(0)))) return std::nullopt;
  std::vector<Fraction> shift;
  for (Index i = 0; i < b.size(); ++i) shift.push_back(fraction(b[i]) - fraction(ball->center[i]));
  const ExactVector e = exact_vector(shift);
  Fraction square = fraction(ball->radius) * fraction(ball->radius) - dot(e, e);  // α radius²
  Vector at(n);
  for (Index i = 0; i < n; ++i) {
    const Fraction along = dot(columns[static_cast<std::size_t>(i)], e);
    square = square + along * along / alpha;
    at[i] = nearest_double(-along / alpha);
  }
  if (sign(square) < 0)
    throw InvalidInput(
        "precompose: no point has it finite, the plane of Ax + b misses the ball; give a b nearer to it");
  return Ball{sign(square) == 0 ? 0 : std::sqrt(nearest_double(square / alpha)), at};
}

}  // namespace

std::optional<Function> ball_section(const Function& f, const Matrix& A, const Vector& b) {
  if (const auto* sum = dynamic_cast<const Sum*>(&f.node())) {
    for (const Function& part : sum->parts()) {
      const auto section = section_of(part, A, b);
      if (!section || section->radius > 0) continue;
      const Value there =
          value_near(f, A * section->center + b, A.norm() * section->center.norm() + b.norm());
      if (std::isfinite(there.value) && std::isfinite(there.error))
        return raised(indicator_of_point(section->center), there.value);
    }
    return std::nullopt;
  }
  const auto section = section_of(f, A, b);
  if (!section) return std::nullopt;
  if (section->radius == 0) return indicator_of_point(section->center);
  return indicator(ball2(section->radius, section->center));
}

}  // namespace convex::inline operations
