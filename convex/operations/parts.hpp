#pragma once

#include <optional>
#include <span>
#include <vector>

#include "convex/composite/graph_form.hpp"
#include "convex/gamma0/function.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

/// The parts of an operation, all together.
namespace convex::inline operations {

/// The parts on n entries as programs, when all are.
std::optional<std::vector<LinearQuadratic>> programs(std::span<const Function> parts, Index n);

/// The parts on n entries as graph forms, when all are, for slopes of such a size.
std::optional<std::vector<GraphForm>> graphs(std::span<const Function> parts, Index n, double slope);

/// Does the fact hold for all parts?
bool all_of(std::span<const Function> parts, bool Facts::*fact);

/// The one number of entries that all of these take, 0 when any will do. Throws InvalidInput "where: …".
Index common_dimension(std::span<const Function> parts, const char* where);

/// That number, or where any will do one of 2, 4, 8, … or of those up to 64 that all of these take: functions
/// of any number of entries show their kind on a few. 0 when there is none up to a million.
Index telling_size(std::span<const Function> parts, Index dimension);

/// The sum of the constants beside their entries, where all are known.
std::optional<Value> sum_of_constants(std::span<const Function> parts);

/// Is some part not finite, and another one too? Then their domains need not meet.
bool domains_may_miss(std::span<const Function> parts);

}  // namespace convex::inline operations
