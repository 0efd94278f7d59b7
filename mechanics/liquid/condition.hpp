#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/liquid/liquid_language.hpp"

namespace mechanics::liquid {

/// "true", or relations < <= > >= between expressions in the coordinates, joined by `and` (or a comma) and
/// `or`; `and` binds closer, parentheses group, and a relation may go on: 0 <= x <= 1.
class Condition {
 public:
  /// Throws InvalidInput with the place.
  Condition(LiquidLanguage&, const Text&, const std::string& what);

  /// At a point of which each coordinate is known to `reach`: <= and >= hold if they do at one of the points
  /// so near, < and > if they do at all of them.
  bool holds(const Point&, double reach) const;
  /// Below 0 where every relation of the condition holds with room, above 0 where it does not hold: the
  /// largest (`and`) and least (`or`) of the differences of the sides. -1 for "true".
  double level(const Point&) const;
  /// What `holds` is at the boundary in a region, where that is known: by ranges, and of relations between
  /// sides that are equal along the boundary by these points of it.
  std::optional<bool> holds_all_over(const Region&, const std::vector<Point>& boundary, double reach) const;
  /// All values of the level in a region.
  expression::Range range(const Region&) const;
  /// The differences of the sides of all relations.
  std::vector<const Field*> fields() const;
  /// Of relations that all must hold: the level of each; of others the level of the whole.
  std::vector<std::function<double(const Point&)>> sheets() const;
  bool is_always() const { return kind_ == Kind::always; }

 private:
  enum class Kind { always, relation, all, any };
  Condition() = default;
  /// The least and the largest excess of a relation at points so near.
  expression::Range around(const Point&, double reach) const;
  friend class ConditionReading;
  Kind kind_ = Kind::always;
  bool strict_ = false;
  Field excess_;  // of a relation: below 0 where it holds
  std::size_t dimension_ = 0;
  std::vector<Condition> parts_;
};

}  // namespace mechanics::liquid
