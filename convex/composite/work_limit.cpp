#include "convex/composite/work_limit.hpp"

namespace convex {
namespace {

/// Some seconds; a question with one root in another takes some ten thousand.
constexpr long most_evaluations = 1'000'000;

struct Work {
  long evaluations = 0;
  int standing = 0;
};

Work& work() {
  thread_local Work done;
  return done;
}

}  // namespace

WorkLimit::WorkLimit() { ++work().standing; }

WorkLimit::~WorkLimit() {
  if (--work().standing == 0) work().evaluations = 0;
}

void WorkLimit::count() {
  if (work().standing > 0) ++work().evaluations;
}

bool WorkLimit::passed() { return work().evaluations > most_evaluations; }

}  // namespace convex
