#include "clock.hpp"

#include <algorithm>
#include <ctime>
#include <limits>
#include <utility>

namespace speed {
namespace {

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds_of(const std::function<void()>& run, int times) {
  const double start = processor_seconds();
  for (int i = 0; i < times; ++i) run();
  return (processor_seconds() - start) / times;
}

}  // namespace

void Clock::add(std::function<void()> run, double calls) {
  run();
  const double once = seconds_of(run, 1);
  const int batch = static_cast<int>(std::clamp(200e-6 / once, 1.0, 1000.0));
  works_.push_back({std::move(run), calls, std::numeric_limits<double>::infinity(), batch});
}

void Clock::run(int rounds) {
  for (int round = 0; round < rounds; ++round)
    for (std::size_t k = 0; k < works_.size(); ++k) {
      Work& work = works_[round % 2 ? k : works_.size() - 1 - k];
      if (work.batch > 1) work.run();
      work.least = std::min(work.least, seconds_of(work.run, work.batch) / work.calls);
    }
}

}  // namespace speed
