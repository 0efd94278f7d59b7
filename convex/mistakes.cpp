#include "convex/mistakes.hpp"

namespace convex {

void Mistakes::add(const InvalidInput& error) {
  const Place place = error.place().value_or(Place{});
  found_.try_emplace({place.line, place.column}, error.what(), error.place());
  for (const InvalidInput& other : error.others()) add(other);
}

void Mistakes::tell() const {
  if (none()) return;
  std::vector<InvalidInput> others;
  for (auto next = std::next(found_.begin()); next != found_.end(); ++next) others.push_back(next->second);
  throw InvalidInput(found_.begin()->second, std::move(others));
}

}  // namespace convex
