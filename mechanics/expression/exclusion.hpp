#pragma once

#include <optional>
#include <vector>

#include "mechanics/expression/range.hpp"
#include "mechanics/expression/rounded.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// f = 0, or f >= 0.
struct Demand {
  NodeId f = no_node;
  bool is_equation = false;
};

/// Is it proved that no values of the coordinates meet all demands? `held`: the value of a coordinate that is
/// fixed; the others may be any number. False where nothing is proved.
///
/// First by Farkas' lemma in fractions: coordinates, and terms that are not linear in them, count as
/// unknowns, each within the range that it can have; weights of demands and bounds that cancel all unknowns
/// and leave 0 >= c > 0. Then by ranges: a box is dropped where a demand cannot hold in it, made smaller by
/// what demands leave of it, and else cut in two (Benhamou et al. 1999). A coordinate that occurs in sines
/// and cosines of whole multiples alone runs over one turn.
bool excludes(const Tape& tape, const std::vector<Demand>& demands,
              const std::vector<std::optional<double>>& held, Rounded t);

/// The first of the two; `ranges`: of every node, over the whole box.
bool excludes_by_weights(const Tape& tape, const std::vector<Demand>& demands,
                         const std::vector<std::optional<double>>& held, const std::vector<Range>& ranges);

}  // namespace mechanics::expression
