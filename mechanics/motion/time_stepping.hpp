#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"
#include "mechanics/motion/course.hpp"

namespace mechanics::inline motions {

/// Rows as a nearest-point problem wants them: sparse where there are many coordinates.
convex::ConstraintRows rows_to_solve(convex::SparseRows U);

/// A motion in steps of one length h: the scheme of Moreau (1988) and Jean (1999), with forces and contacts
/// at q + θ h v_θ, v_θ = (1 - θ) v + θ v+. Impacts and forces of a step are one impulse,
///   A (v+ - v) = h z + Σ P_a u_a,    0 <= P_a ⟂ f'_a(v+) + e_a f'_a(v) >= 0,    q+ = q + h v_θ,
/// over the contacts whose f is at most 0 at q + θ h v: the nearest point to v + h A⁻¹z in the kinetic
/// metric. Positions are brought back to f >= 0 by the least change in that metric; what this adds to V is
/// taken from the velocity along the change, as far as there is any.
class Motion::TimeStepping final : public Motion::Course {
 public:
  TimeStepping(const LagrangianSystem& system, const State& state, MotionOptions options);
  bool advance(double until) override;

 private:
  /// The contacts of a step, with what their rates are at its middle.
  struct Contacts {
    std::vector<Index> constraints;
    std::vector<Index> two_sided;  ///< of these, by their place
    convex::ConstraintRows U;
    Vector drift;                   ///< ∂f/∂t
    Vector before;                  ///< f'(v)
    std::vector<bool> closes_fast;  ///< faster than the forces of a step alone make it close
    Vector restitution;             ///< e as it counts: 0 for the others
  };
  /// One problem of a kind after another: the rows that pushed last are the first guess.
  struct Repeated {
    std::vector<Index> pushing;  ///< constraints
    Vector lambda;               ///< by constraint
    int pause = 0, waited = 0;   ///< problems between tries of the active set, where very many rows change
    std::optional<convex::NearestPointProblem> problem;
    convex::Solution solution;
  };

  void take_step(double h, double end);
  static double size_along(const State& at, const convex::SparseRows& U, Index k);
  std::vector<Index> closed(const State& ahead) const;
  void find_inertia(const State& at);
  void take_rounding_for_zero(const State& middle, const std::vector<Index>& constraints,
                              const ConstraintRates& rates, convex::SparseRows& U) const;
  Contacts contacts_at(const State& middle, const std::vector<Index>& closed, double h) const;
  struct Correction {
    std::vector<Index> constraints, two_sided;
    convex::ConstraintRows U;
    Vector s;
  };
  /// From here on the dense active set, to which the default turns where the sparse one gives up, is too slow
  /// for a step.
  static constexpr Index fewest_for_sparse_method = 300;
  /// How well a problem is solved where very many rows change in every step: exactly; so far as rows that
  /// are to be found anew deserve; to what the scheme makes of it, from multipliers that are nearly right; or
  /// roughly.
  enum class Effort { exact, first, warm, rough };
  const convex::Solution& solve(Repeated&, const std::vector<Index>& constraints,
                                const std::vector<Index>& two_sided, const convex::ConstraintRows& U,
                                const Vector& z, const Vector& s, Effort effort);
  convex::Solution solution_of(Repeated&, const convex::NearestPointProblem&,
                               const std::vector<Index>& constraints, Effort effort);
  /// Whether a contact stays, and pushed in the last step.
  bool pushes(Index a) const {
    const auto i = static_cast<std::size_t>(a);
    return rests_[i] && pushes_[i];
  }
  void note_pushing();
  Correction correction(const Vector& f, const std::vector<bool>& counts, bool held) const;
  void correct_velocity();
  /// v+ and P; false when the motion ends here.
  bool find_velocity(double h, double end);
  void tell_error(double error, double size);
  double linear_part_of_energy(const Vector& v) const;
  void tell_events(double h, const Vector& velocity_before);
  void take_near(const ConstraintRates& rates, std::vector<bool>& counts) const;
  void correct_position();

  double origin_;  // steps are counted from here
  long count_ = 0;
  bool is_first_ = true;
  convex::SparseMatrix gram_;
  std::optional<convex::Metric> A_;
  Vector z_;
  State middle_;  ///< of the step at hand: where its forces and contacts are taken
  Contacts now_;
  Vector velocity_, impulse_;  // v+, and P of `now_`
  std::vector<bool> rests_;    // by constraint: touched with f' = 0 at the end of the last step
  std::vector<bool> pushes_;   // by constraint, in the last step
  std::vector<Index> touch_at_start_;
  std::vector<bool> moves_;  // by constraint: t stands in f
  bool is_crowded_;          // very many coordinates and one-sided constraints
  Repeated velocities_, positions_, tangents_;
};

}  // namespace mechanics::inline motions
