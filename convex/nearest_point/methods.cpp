#include "convex/nearest_point/methods.hpp"

#include <array>

#include "convex/nearest_point/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"

namespace convex {
namespace {

std::string always(const NearestPointProblem&) { return {}; }

Solution solve_by_active_set(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return active_set(problem, accuracy);
}

Solution solve_automatically(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return automatic(problem, accuracy);
}

constexpr std::array table{
    Method{"auto", "no more than the problem needs: islands, structure, dense or sparse (the default)",
           MethodKind::direct, always, solve_automatically},
    Method{"active-set", "dual active set with an updated orthogonal factor, refined in twice the precision",
           MethodKind::direct, always, solve_by_active_set},
};

}  // namespace

std::string_view name(MethodKind kind) {
  constexpr std::array<std::string_view, 3> names{"direct", "iterative", "for comparison"};
  return names[static_cast<std::size_t>(kind)];
}

std::span<const Method> methods() { return table; }

const Method* find_method(std::string_view name) {
  for (const Method& method : table)
    if (method.name == name) return &method;
  return nullptr;
}

}  // namespace convex
