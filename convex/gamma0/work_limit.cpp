#include "convex/gamma0/work_limit.hpp"

#include <algorithm>

namespace convex::inline gamma0 {
namespace {

/// Two or three seconds; a question with one root in another takes some ten thousand.
constexpr double most_evaluations = 1'000'000;

thread_local long evaluations = 0;
thread_local const WorkLimit* innermost = nullptr;

}  // namespace

WorkLimit::WorkLimit(double part)
    : outer_(innermost), end_(evaluations + static_cast<long>(part * most_evaluations)) {
  if (outer_) end_ = std::min(end_, outer_->end_);
  innermost = this;
}

WorkLimit::~WorkLimit() {
  innermost = outer_;
  if (!outer_) evaluations = 0;
}

void WorkLimit::count(long done) {
  if (innermost) evaluations += done;
}

double WorkLimit::rest() {
  if (!innermost) return 1;
  return static_cast<double>(std::max(0L, innermost->end_ - evaluations)) / most_evaluations;
}

bool WorkLimit::has(long more) { return !innermost || evaluations + more <= innermost->end_; }

bool WorkLimit::passed() { return innermost && evaluations > innermost->end_; }

}  // namespace convex::inline gamma0
