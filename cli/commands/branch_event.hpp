#pragma once

#include <optional>

#include "mechanics/motion/orbit.hpp"

namespace cli::inline commands {

/// What a branch passes: at a fold it turns around; multipliers cross the unit circle at 1 where it goes on
/// (another branch crosses it: symmetry breaking), at -1, or as a pair; the number of impacts changes; a
/// contact that is held opens.
enum class BranchEvent { none, fold, branching, flip, torus, grazing, opening };

/// As the table tells it: "fold", "flip", "torus", "grazing", "opening", else "".
const char* table_name(BranchEvent);
/// As the picture tells it.
const char* event_name(BranchEvent);

/// How many impacts of that constraint an orbit has; none are counted where they come to their end in either
/// one, for infinitely many are no number.
long impacts_of(const mechanics::Orbit& orbit, convex::Index constraint, const mechanics::Orbit& other);

/// The contact that one of them opens more often than the other, which holds it there, or -1.
convex::Index opened_contact(const mechanics::Orbit& before, const mechanics::Orbit& now);

/// What a branch passes between two orbits that do not lie on two sides of a fold. Of an orbit of free period
/// the multiplier 1 along it crosses nothing.
BranchEvent event_between(const mechanics::Orbit& before, const mechanics::Orbit& now, bool is_free);

/// A number that is 0 at that event, which multipliers tell, negative on one side of it and positive on the
/// other: how far the one that crosses between these orbits is outside the unit circle. Nothing where it is
/// not told from others.
class Crossing {
 public:
  Crossing(BranchEvent, const mechanics::Orbit& before, const mechanics::Orbit& now, bool is_free);
  std::optional<double> operator()(const mechanics::Orbit&) const;

 private:
  BranchEvent event_;
  bool is_free_;
  std::size_t which_;  // among those of its kind, the outermost first
};

}  // namespace cli::inline commands
