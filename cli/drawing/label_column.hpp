#pragma once

#include <vector>

namespace cli::inline drawings {

/// Positions for labels in a column: as near to the wanted ones as they can be with `apart` between
/// neighbours and all within [low, high], in the order of the wanted positions. Where there is no room for
/// all, they stand closer.
std::vector<double> label_positions(const std::vector<double>& wanted, double apart, double low, double high);

}  // namespace cli::inline drawings
