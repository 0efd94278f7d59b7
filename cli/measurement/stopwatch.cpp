#include "cli/measurement/stopwatch.hpp"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

namespace cli::inline measurement {
namespace {

/// Reading the clock costs some hundred nanoseconds; a batch of this length is known to a part in a hundred.
constexpr double shortest_batch = 2e-5;

/// Enough when the quartiles are within this part of the median, at least and at most so many batches.
constexpr double known_spread = 0.02;
constexpr std::size_t fewest = 5, most = 101;

/// The processor time of this process: what others do on the machine does not count.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& work, int calls) {
  const double start = processor_seconds();
  for (int call = 0; call < calls; ++call) work();
  return (processor_seconds() - start) / calls;
}

/// The entry at part p of the sorted samples.
double quantile(const std::vector<double>& sorted, double p) {
  return sorted[static_cast<std::size_t>(std::lround(p * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

Timing timed(const std::function<void()>& work, double budget) {
  const double warming = seconds_of(work, 1);
  if (warming > budget) return {warming, warming, warming, 1};
  const int calls = std::max(1, static_cast<int>(std::ceil(shortest_batch / std::max(warming, 1e-9))));
  std::vector<double> samples;
  double spent = warming;
  while (samples.size() < most && (samples.empty() || spent < budget)) {
    samples.push_back(seconds_of(work, calls));
    spent += samples.back() * calls;
    if (samples.size() < fewest) continue;
    std::sort(samples.begin(), samples.end());
    const double median = quantile(samples, 0.5);
    if (samples.size() >= 3 * fewest &&
        quantile(samples, 0.75) - quantile(samples, 0.25) <= known_spread * median)
      break;
  }
  std::sort(samples.begin(), samples.end());
  return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75),
          static_cast<int>(samples.size()) * calls};
}

void pin_to_one_processor() {
  const int here = sched_getcpu();
  if (here < 0) return;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(here), &one);
  sched_setaffinity(0, sizeof one, &one);
}

}  // namespace cli::inline measurement
