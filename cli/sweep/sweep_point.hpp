#pragma once

#include <string>
#include <vector>

#include "cli/problem_file/toml_document.hpp"
#include "cli/scene.hpp"
#include "cli/sweep/sweep_range.hpp"

namespace cli::inline sweeps {

/// The answer at one point of a sweep.
struct SweepPoint {
  std::vector<double> at;  ///< the parameters
  std::string status;      ///< as `solve` says it, or "error"
  Exit exit = Exit::solved;
  std::vector<convex::Index> active;    ///< constraints, in order
  std::vector<convex::Index> contacts;  ///< K
  std::vector<double> watched;          ///< NaN without an answer
  double error_bound = 0;
  bool has_unique_multipliers = true;  ///< without: those watched have the least norm
  std::string message;                 ///< of an error
  bool is_change = false;
  bool has_answer() const { return status == "solved" || status == "inaccurate"; }
};

/// What is watched of an answer: "x''", "lambda[floor]", "reaction[x]", "gauss", the state, "x" and "x'", and
/// how far a constraint is from closing, "f[floor]", "df[floor]", "ddf[floor]".
struct Watched {
  enum class Of { acceleration, multiplier, reaction, gauss, position, velocity, f, df, ddf };
  std::string name;
  Of of = Of::gauss;
  convex::Index index = 0;
};

/// Solves a problem file at values of some of its keys. Each thread has its own.
class SweepScene {
 public:
  SweepScene(TomlValue document, std::string file, std::vector<std::string> keys, SceneOptions options);

  /// All accelerations and multipliers when `names` is empty. Throws InvalidInput for a name that there is
  /// not.
  std::vector<Watched> watched(const std::vector<std::string>& names, const std::vector<double>& at);

  /// Of the first of these points that has some.
  std::vector<std::string> angles_in_degrees(const std::vector<std::vector<double>>& points);

  SweepPoint solve(const std::vector<double>& at, const std::vector<Watched>& watched);

  /// Signed numbers whose roots are where the contacts change: of the equations in which `held` persist, the
  /// multiplier of a contact held, or the slack of one that is not. NaN where there is none.
  struct Margins {
    std::vector<double> multiplier, slack, f, df;  ///< by constraint
    std::vector<double> zero_slack;                ///< a slack up to this is 0 by the tolerance
  };
  Margins margins(const std::vector<double>& at, const std::vector<convex::Index>& held);

  const std::vector<std::string>& constraints() const { return constraints_; }

 private:
  struct Names {
    std::vector<std::string> coordinates, constraints;
    bool is_mechanism = false;
  };
  Problem problem(const std::vector<double>& at);
  Names names(const std::vector<double>& at);
  Scene scene(const std::vector<double>& at);

  TomlValue document_;
  std::string file_;
  std::vector<std::string> keys_, constraints_;
  SceneOptions options_;
};

}  // namespace cli::inline sweeps
