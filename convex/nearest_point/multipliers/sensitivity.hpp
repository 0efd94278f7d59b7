#pragma once

#include <optional>
#include <vector>

#include "convex/nearest_point/multipliers/multipliers.hpp"

namespace convex::inline multiplier_sets {

/// How a solution answers to a change of the data: q(t) = q + t acceleration for small t > 0, exactly so
/// until the active rows change; likewise lambda, where multipliers are unique and stay so.
struct Derivative {
  Vector acceleration;                ///< dq/dt: n
  Vector reaction;                    ///< dR/dt, R = Σ lambda_a u_a: n
  std::optional<Vector> multipliers;  ///< dlambda/dt: m
};

/// The derivative when z moves at the rate dz and s at the rate ds. The solution is piecewise linear in both
/// (Haraux 1977; Mignot 1976): d = dq/dt minimises ½ d·Ad - dz·d over u_a·d = ds_a for rows with a positive
/// multiplier or two-sided, u_a·d >= ds_a for the other tight rows. Where multipliers are not unique, those
/// count that make lambda·ds largest (Gauvin and Dubeau 1982): with them R·d is least among all d that keep
/// the tight rows. dz: n; ds: m; weak: one-sided rows whose multiplier is 0 but for the rounding of data.
/// None when the change makes rows contradict each other, or doubles keep fewer than three digits of A⁻¹.
std::optional<Derivative> directional_derivative(const NearestPointProblem&, const Solution&,
                                                 const Multipliers&, const Vector& dz, const Vector& ds,
                                                 const std::vector<Index>& weak = {});

/// How far the active rows are from changing: the least ||dz||_(A⁻¹) of a change of z that makes row a
/// open (lambda_a becomes 0) or close (u_a·q - s_a becomes 0), as long as nothing else changes. 0 for a weak
/// row, infinite for two-sided rows and for those that no change reaches. None when multipliers are not
/// unique, or doubles keep fewer than three digits of A⁻¹.
std::optional<Vector> margins(const NearestPointProblem&, const Solution&, const Multipliers&,
                              const std::vector<Index>& weak = {});

/// The first row that opens or closes as z moves along dz, and how far that is.
struct FirstChange {
  double by = 0;
  Index row = 0;
  bool closes = false;
};

/// Along a derivative by dz alone. None when no row ever does, or multipliers are not unique or do not stay
/// so.
std::optional<FirstChange> first_change(const NearestPointProblem&, const Solution&, const Multipliers&,
                                        const Vector& dz, const Derivative& by);

}  // namespace convex::inline multiplier_sets
