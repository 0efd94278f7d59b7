#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "mechanics/liquid/condition.hpp"
#include "mechanics/liquid/liquid_text.hpp"

namespace mechanics::liquid {

/// What the liquid fills at t0.
struct Domain {
  enum class Shape { box, ball, polygon, inequalities };
  Shape shape = Shape::box;
  std::size_t dimension = 1;
  Point low{}, high{};  ///< a box around it, the least one but for inequalities
  std::function<double(const Point&)>
      level;  ///< below 0 inside, above outside; a distance but for inequalities
  Point centre{};
  double radius = 0;  ///< of a ball
  /// Of an interval its ends, of a ball its radius twice: as written, with what rounding may have done.
  std::array<expression::Rounded, 2> written{};
  Ray written_centre{};                         ///< of a ball
  std::vector<std::array<double, 2>> vertices;  ///< of a polygon, counterclockwise
  std::optional<Condition> condition;           ///< of inequalities

  double longest() const;
  /// To what a point of the boundary is known.
  double reach() const { return 1e-11 * longest(); }
  /// Of inequalities that all hold: the level of each; else empty.
  std::vector<std::function<double(const Point&)>> sheets;

  /// The point of the boundary nearest to one near it; for inequalities, where Newton's steps lead.
  Point foot(const Point&) const;
  Point outward(const Point&) const;  ///< the unit normal of `level` there
  /// The point of the segment from `inside` to `outside` where the level is 0.
  Point crossing(const Point& inside, const Point& outside) const;
};

/// interval(low=, high=) | box(low=, high=) | disc(center=, radius=) | ball(…) | polygon(vertices=) |
/// {relations}. Throws InvalidInput for what is none of them, is empty or has another dimension.
Domain read_domain(LiquidLanguage&, const LiquidText&);

}  // namespace mechanics::liquid
