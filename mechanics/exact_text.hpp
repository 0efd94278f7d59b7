#pragma once

#include <optional>

#include "convex/nearest_point/proof/uncertain_problem.hpp"
#include "mechanics/expression/program.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace mechanics {

/// What the text proves of a constraint at the state: f = 0 and df/dt = 0 (it belongs to K); f > 0, or f = 0
/// and df/dt > 0 (it does not); it does not hold; or f or df/dt may or may not be 0, for all that balls tell.
enum class ContactVerdict { touches, apart, violated, undecided };

/// Gauss' problem straight from the text of a mechanism and its state: decimals and fractions count as
/// written (9.81 is 981/100), nothing is rounded without a bound.
struct TextProblem {
  convex::UncertainProblem problem;
  bool is_exact = false;                 ///< all numbers are fractions, all radii 0
  bool contacts_touch = false;           ///< f = 0 and df/dt = 0 of every contact of K is proved
  std::vector<ContactVerdict> contacts;  ///< by constraint
  long precision = 0;                    ///< of the balls, bits; 0: there are none
};

/// The verdicts alone, for a system of any size: in fractions where a constraint and the state have them,
/// else in balls, of more precision while nothing is decided: at last of as much as tells whether an
/// algebraic number is 0, up to `most_telling_precision`. `wanted`: the constraints that are asked for; the
/// others are `undecided`.
std::vector<ContactVerdict> contact_verdicts(const LagrangianSystem&, const StateText&,
                                             const std::vector<Index>& wanted);

/// `contacts`: the constraints of K, in order. In fractions where every function has a rational value and
/// rational derivatives; else in balls of `first_precision`, or of `last_precision` where those are too wide.
/// None when a derivative does not exist for all that balls tell, when there are no balls
/// (Ball::why_none), or when the system has more than `most_exact_coordinates` coordinates. Throws
/// InvalidInput when A, in fractions, is not positive definite.
std::optional<TextProblem> problem_from_text(const LagrangianSystem&, const StateText&,
                                             const std::vector<Index>& contacts);

/// The same where all numbers are fractions and every contact of K touches at the state as written; none
/// otherwise: where the digits of a state miss a contact, by however little, they miss what makes rows
/// dependent and consistent, too.
std::optional<convex::ExactProblem> fractions_from_text(const LagrangianSystem&, const StateText&,
                                                        const std::vector<Index>& contacts);

/// The numbers of nodes of the system at the state as written, the nearest doubles with their radii: 0 where
/// the text proves it. What it does not tell is left out.
std::vector<expression::KnownNode> numbers_as_written(const LagrangianSystem&, const StateText&,
                                                      const std::vector<expression::NodeId>&);

/// By contact, s of those whose gradient is 0 at the state as written, the nearest double with its radius;
/// none where the text does not prove that it is 0.
std::vector<std::optional<expression::Rounded>> where_gradients_vanish(const LagrangianSystem&,
                                                                       const StateText&,
                                                                       const std::vector<Index>& contacts);

inline constexpr std::size_t most_exact_coordinates = 40;
inline constexpr long first_precision = 192, last_precision = 768;
/// Of one number, and of all coordinates and constraints asked for together: a second or so.
inline constexpr double most_telling_precision = 200000, most_telling_bits = 2e7;

}  // namespace mechanics
