#pragma once

#include <optional>
#include <string>

#include "cli/options.hpp"
#include "cli/problem_file/problem.hpp"
#include "convex/cones/cone_split.hpp"
#include "convex/cones/polyhedral_cone.hpp"

namespace cli {
class JsonWriter;
}

namespace cli::inline reports {

/// A cone by both descriptions with its polar, and the point split between them.
struct SolvedCone {
  const ConeProblem& problem;
  convex::PolyhedralCone cone, polar;
  std::optional<convex::ConeSplit> split;
  double seconds = 0;
};

/// Throws InvalidInput when a setting of the file or an option means nothing for a cone.
void require_cone_settings(const SolveSettings&, const AccuracyOptions&);

SolvedCone solve_cone(const ConeProblem&);

/// The keys of docs/problem-files.md, into the object that is open.
void write_cone(JsonWriter&, const SolvedCone&, const std::string& file);

/// The object, one line without its end.
std::string cone_json(const SolvedCone&, const std::string& file);

/// The readable result below a heading.
std::string cone_text(const SolvedCone&);

}  // namespace cli::inline reports
