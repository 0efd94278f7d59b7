#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cli {

/// Exit codes of the program (docs/commands.md).
enum class Exit { solved = 0, no_solution = 1, wrong_input = 2, inaccurate = 3 };

/// How results are printed.
struct Printing {
  bool json = false;
  bool quiet = false;
};

/// What a problem file says, said otherwise: "m=3", "position.x=0.2", "simulate.until=2".
struct Overrides {
  std::vector<std::string> settings;
};

/// Files answered one after the other.
struct FileOptions : Printing, Overrides {
  std::vector<std::string> files;
};

/// How an answer is to be found; wins over the file's own [solve].
struct AccuracyOptions {
  std::optional<std::string> method;
  std::optional<double> tolerance;
  std::optional<double> limit;  ///< of fractions, where doubles leave a decision open
};

/// The same for a nearest point.
struct SceneOptions : AccuracyOptions {
  bool ranges = false;      ///< of multipliers, also over many contacts
  bool full_model = false;  ///< without islands, special structure and leaving out
};

/// How a motion is followed; wins over the file's own [simulate].
struct MotionChoice {
  std::optional<std::string> method;
  std::optional<double> tolerance;
  std::optional<long> step_limit;
};

}  // namespace cli
