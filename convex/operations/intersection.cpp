#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"

namespace convex {
namespace {

std::vector<Function> indicators(std::span<const Set> sets) {
  std::vector<Function> all;
  for (const Set& set : sets) all.push_back(set.indicator);
  return all;
}

/// The sum of the indicators, under the name of the set.
class Intersection : public Sum {
 public:
  explicit Intersection(std::span<const Set> sets) : Sum(indicators(sets)) {
    call_.name = "intersection";
    for (const Set& set : sets) call_.arguments.push_back(argument(set.call));
  }
  Call call() const override { return {"indicator", {argument(call_)}}; }

 private:
  Call call_;
};

}  // namespace

Function intersection(std::span<const Set> sets, Index n) {
  if (sets.empty()) throw InvalidInput("intersection: no sets; give at least one");
  if (sets.size() == 1) return sets[0].indicator;
  const Function made(std::make_shared<Intersection>(sets));
  if (made.dimension() != 0) n = made.dimension();
  if (n != 0) require_proper(made, n, "intersection");
  return made;
}

}  // namespace convex
