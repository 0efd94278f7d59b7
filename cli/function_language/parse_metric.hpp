#pragma once

#include <string_view>

#include "convex/exact_program/exact_gram.hpp"
#include "convex/metric.hpp"

namespace cli::inline function_language {

/// A metric as it is written on a command line: a matrix [[2, 1], [1, 2]], or diagonal [1, 2]. Throws
/// InvalidInput, also when it is not symmetric positive definite.
convex::Metric parse_metric(std::string_view text);

/// The same text, which has been read, with its numbers as they are written.
convex::ExactGram parse_exact_metric(std::string_view text);

}  // namespace cli::inline function_language
