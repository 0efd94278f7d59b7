#pragma once

#include <optional>
#include <string>

#include "cli/problem_file/problem.hpp"
#include "cli/report/answer.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/proved_prox/proved_split.hpp"

namespace cli {
class JsonWriter;
}

namespace cli::inline reports {

/// A point split in two, as its reports need it.
struct SplitPoint {
  const DecompositionProblem& problem;
  convex::Decomposition split;
  double seconds = 0;                             ///< of the two proxes, without reading the function
  std::optional<convex::ProvedSplit> proof = {};  ///< where one was asked for
  std::optional<convex::ExactSplit> exact = {};   ///< by method "exact"

  Exit exit() const;
};

/// Throws InvalidInput when a setting of the file or an option means nothing for a decomposition.
void require_applicable(const SolveSettings&, const AccuracyOptions&);

/// Builds f in the metric of the problem and splits z; `certify` asks for a proof. Throws InvalidInput with
/// the place in f's text.
SplitPoint split_point(const DecompositionProblem&, const SolveSettings&, const AccuracyOptions&,
                       bool certify = false);

/// The keys of docs/problem-files.md, into the object that is open. `file` is "" for a split that comes from
/// the command line.
void write_split(JsonWriter&, const SplitPoint&, const std::string& file);

/// The object, one line without its end.
std::string split_json(const SplitPoint&, const std::string& file);

/// The readable result below a heading.
std::string split_text(const SplitPoint&);

}  // namespace cli::inline reports
