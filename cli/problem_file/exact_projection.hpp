#pragma once

#include <memory>

#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/toml_document.hpp"

namespace cli::inline problem_files {

/// Whether every number of a [projection] is the double that was read for it, and A is symmetric as written.
bool is_made_of_doubles(const TomlValue& table);

/// The radii of rows and right sides of a [projection] as doubles: 0 where what was written is the doubles.
convex::DataRadii rounded_rows(const TomlValue& table, const convex::NearestPointProblem&);

/// A as written, its factor from fractions: where doubles cannot tell that it is positive definite. None
/// where it is not, or cannot be read, or fractions would take too long.
std::optional<convex::Metric> metric_as_written(const TomlValue& A, const MetricKey& key);

/// The numbers of a [projection] as written, where `rounded` has them as doubles; matrix files hold doubles.
/// Throws InvalidInput with the place when A is not positive definite.
convex::ExactProblem read_exact_projection(const TomlValue& table,
                                           const convex::NearestPointProblem& rounded);

}  // namespace cli::inline problem_files
