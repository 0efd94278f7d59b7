#pragma once

#include <functional>
#include <vector>

namespace speed {

/// Works that are timed in turn, so that what slows the machine slows all of them: processor time, the least
/// of the rounds.
class Clock {
 public:
  /// `calls`: answers that one run of the work gives.
  void add(std::function<void()> work, double calls = 1);
  /// Short works in batches of some 200 us, each batch after a run that fills the caches; the order turns
  /// round.
  void run(int rounds);
  /// Seconds an answer.
  double least(std::size_t work) const { return works_[work].least; }

 private:
  struct Work {
    std::function<void()> run;
    double calls, least;
    int batch;
  };
  std::vector<Work> works_;
};

}  // namespace speed
