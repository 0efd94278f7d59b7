#include "convex/dense/recycled.hpp"

#include <doctest/doctest.h>

#include <thread>

namespace {

struct Counted {
  static inline int alive = 0, made = 0;
  int size = 1;
  Counted() { ++alive, ++made; }
  ~Counted() { --alive; }
};

bool is_small(const Counted& object) { return object.size < 10; }

using OneOf = convex::dense::Recycled<Counted, is_small>;

}  // namespace

TEST_CASE("what is given up is given out again, one at a time, and what is large is not kept") {
  std::thread([] {
    const int before = Counted::made;
    for (int k = 0; k < 3; ++k) OneOf::one()->size = 2;
    CHECK(Counted::made == before + 1);
    CHECK(OneOf::one()->size == 2);
    OneOf::one()->size = 20;
    CHECK(Counted::alive == 0);
  }).join();
  CHECK(Counted::alive == 0);
}

TEST_CASE("what outlives the thread that made it, or what that thread keeps, ends once") {
  std::shared_ptr<Counted> elsewhere;
  std::thread([&] {
    thread_local std::shared_ptr<Counted> late;  // ends after what is made for the first that is given up
    late = OneOf::one();
    elsewhere = OneOf::one();
    OneOf::one().reset();
    CHECK(Counted::alive == 3);
  }).join();
  CHECK(Counted::alive == 1);
  std::thread([&] { elsewhere.reset(); }).join();
  CHECK(Counted::alive == 0);
}
