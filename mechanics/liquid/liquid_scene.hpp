#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/liquid/domain.hpp"

namespace mechanics::liquid {

/// A part of the boundary. Free: the pressure there. A wall: the acceleration, along the outward normal, of a
/// liquid particle that stays on it.
struct BoundaryPart {
  std::string name;
  bool is_free = true;
  Condition where;
  Field value;
  convex::Place place;
};

/// An incompressible liquid at an instant. Its acceleration Γ has ρΓ = ρF - ∇p; it can part but not overlap,
/// div Γ >= tr((∇u)²); p >= 0, and p = 0 where the inequality is strict. So p is the least p >= 0 with
///   -Δp >= h := ρ (tr((∇u)²) - div F) inside,  p = p0 on free parts,  ∂p/∂n >= ρ (F·n - a) on walls.
struct LiquidScene {
  std::vector<std::string> coordinates;
  Domain domain;
  double density = 1;
  expression::Rounded written_density = 1;
  Field h;                          ///< derived from the text of u and F
  std::vector<Field> velocity;      ///< u; empty when it is 0
  std::vector<Field> force;         ///< F
  std::vector<Field> stretching;    ///< ∂u_i/∂x_i, whose sum is div u
  std::vector<BoundaryPart> parts;  ///< free parts, then walls, each in the order of the file
  std::optional<long> cells;
  bool radial = false;  ///< said to be
  Bound bound = Bound::none;

  std::size_t dimension() const { return coordinates.size(); }
  /// The first part that the point fits.
  const BoundaryPart* part_at(const Point&) const;
  /// The same for a point of the boundary, which must fit one.
  const BoundaryPart& boundary_part(const Point&) const;
  /// p0 of a free part; below 0 it is refused.
  double free_pressure(const BoundaryPart&, const Point&) const;
  /// ρ (F·n - a), which ∂p/∂n is at least.
  double wall_flux(const BoundaryPart&, const Point&, const Point& n) const;
  /// Whether ρ (F·n - a) < 0 at the boundary's point nearest to one on a chord of a wall, by more than n,
  /// from differences, is known to.
  bool wall_leaves(const BoundaryPart&, const Point& near) const;
  /// About how large p is: the largest, at some points of the domain, of what free parts give, of |h| L²/8
  /// and of what walls ask for times L, the longest side.
  double pressure_scale() const;
  bool has_free_part() const;
  bool has_wall() const;
  /// The same as an enclosure.
  expression::Range wall_flux_range(const BoundaryPart&, const Region&, const Point& n) const;
  /// Of a text with a range: the scene whose loads and pressures are below, or above, those of all its
  /// values, so that its pressure is (the equations have an M-matrix). The domain is that of one value.
  LiquidScene bounded(Bound) const;
  /// Throws InvalidInput where div u is not 0 beyond rounding.
  void require_no_divergence(const Point&) const;
  /// In one dimension: all that ∫ h over a part of an interval may be, by F at its ends; where h has no
  /// bound.
  expression::Range load_range(const expression::Range& x) const;
  /// What d(div u)/dt is where p = 0: -h/ρ.
  double growth(const Point& x) const { return -h(x) / density; }
};

/// Throws InvalidInput with the place.
LiquidScene read_scene(const LiquidText&);

/// The same text with another value of a parameter.
LiquidText with_parameter(LiquidText, const std::string& name, double value);

/// The value of a parameter in the text.
double parameter_value(const LiquidText&, const std::string& name);

}  // namespace mechanics::liquid
