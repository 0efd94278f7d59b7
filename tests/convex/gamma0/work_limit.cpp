#include "convex/gamma0/work_limit.hpp"

#include <doctest/doctest.h>

using convex::WorkLimit;

namespace {

/// So many evaluations, counted until the limit is passed.
long work_until_passed() {
  long done = 0;
  for (; !WorkLimit::passed(); ++done) WorkLimit::count();
  return done;
}

}  // namespace

TEST_CASE("a part of a question takes its share of the work and leaves the rest to the others") {
  const WorkLimit question;
  long first = 0;
  {
    const WorkLimit part(0.25);
    first = work_until_passed();
  }
  CHECK_FALSE(WorkLimit::passed());
  CHECK(work_until_passed() >= 2 * first);
  CHECK(WorkLimit::passed());
}

TEST_CASE("parts of a question take no more than it has left, and the next question starts anew") {
  long whole = 0;
  {
    const WorkLimit question;
    whole = work_until_passed();
    const WorkLimit part(0.5);
    CHECK(WorkLimit::passed());
  }
  const WorkLimit next;
  CHECK_FALSE(WorkLimit::passed());
  CHECK(work_until_passed() == whole);
}
