#pragma once

#include <functional>

namespace cli::inline measurement {

/// Processor seconds of one call: the median of several measurements and their quartiles.
struct Timing {
  double median = 0, lower = 0, upper = 0;
  int repetitions = 0;
};

/// Times the work after one call to warm up: batches long enough for the clock's resolution, as many as its
/// spread asks for, until `budget` seconds are spent. Work that takes longer
/// than the budget is timed by the first call alone.
Timing timed(const std::function<void()>& work, double budget);

/// Keeps this process on one processor, where the system lets it.
void pin_to_one_processor();

}  // namespace cli::inline measurement
