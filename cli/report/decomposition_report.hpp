#pragma once

#include <string>

#include "cli/problem_file/problem.hpp"
#include "cli/report/answer.hpp"
#include "convex/functions/decomposition.hpp"

namespace cli {

class JsonWriter;

/// A point split in two, as its reports need it.
struct SplitPoint {
  const DecompositionProblem& problem;
  convex::Decomposition split;
  double seconds = 0;  ///< of the two proxes, without reading the function
};

/// Throws InvalidInput when a setting of the file or an option means nothing for a decomposition.
void require_applicable(const SolveSettings&, const AccuracyOptions&, bool certify);

/// Builds f in the metric of the problem and splits z. Throws InvalidInput with the place in f's text.
SplitPoint split_point(const DecompositionProblem&, const SolveSettings&, const AccuracyOptions&);

/// The keys of docs/problem-files.md, into the object that is open. `file` is "" for a split that comes from
/// the command line.
void write_split(JsonWriter&, const SplitPoint&, const std::string& file);

/// The object, one line without its end.
std::string split_json(const SplitPoint&, const std::string& file);

/// The readable result below a heading.
std::string split_text(const SplitPoint&);

}  // namespace cli
