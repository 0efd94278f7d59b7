#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tests {

/// What a run of the program left behind.
struct Outcome {
  int code = -1;  ///< 128 + the signal when one ended it
  std::string out, err;
};

/// Runs the program as a shell would, `input` on its standard input. The path is that of the environment
/// variable MOREAU_PROGRAM, or the program of this build. A run that hangs fails the test.
Outcome run(const std::vector<std::string>& arguments, const std::string& input = "");

/// A command of the shell in which "$0" "$@" stands for the program with its arguments.
Outcome run_by_shell(const std::string& command, std::vector<std::string> arguments);

/// The same as `run` with so much memory and no more; without a limit under the address sanitizer.
Outcome run_within(int megabytes, std::vector<std::string> arguments);

/// A folder of its own for one test, gone with it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Writes a file into it; returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// `moreau COMMAND --json FILE` or without --json, on a file with these bytes.
Outcome run_on(const std::string& command, const std::string& bytes);
Outcome run_json_on(const std::string& command, const std::string& bytes);

/// Lines to put in place of those with these numbers, from 1.
using Changes = std::map<int, std::string>;

/// A point of mass 2 at rest on a floor, with 9.81 of gravity; its multiplier is 19.62. Lines: 1 [system],
/// 2 coordinates, 3 kinetic, 4 potential, 5 [system.parameters], 6 m, 7 g, 8 [system.constraints], 9 floor,
/// 10 [state], 11 position, 12 velocity, 13 [solve], 14 empty.
std::string point_on_floor(const Changes& changes = {});

/// Two wheels coupled by a rod, stretched out with a' = b' = 2, of which the second pushes a third; 1.2 turns
/// the first. That a'' = b'', third derivatives tell alone. Lines: 7 the force, 12 to 14 a', b' and c'.
std::string pushing_at_dead_centre(const Changes& changes = {});

/// The projection of (0, -9.81) with A = diag(2, 1) on two rows. Lines: 1 [projection], 2 A, 3 z, 4 U, 5 s,
/// 6 two_sided, 7 empty.
std::string two_rows(const Changes& changes = {});

}  // namespace tests
