#pragma once

#include <functional>
#include <vector>

namespace cli::inline measurement {

/// What became of work done in a process of its own. interrupted: Ctrl-C was pressed.
enum class Ending { done, too_slow, crashed, interrupted };

struct ChildOutcome {
  Ending ending = Ending::crashed;
  std::vector<double> numbers;  ///< what the work returned, when done
};

/// Does the work in a child process, so that what hangs, aborts or eats all memory costs nobody else; after
/// `seconds` the child is killed. Its messages are dropped.
ChildOutcome in_child(double seconds, const std::function<std::vector<double>()>& work);

}  // namespace cli::inline measurement
