#include "convex/operations/parts.hpp"

#include <algorithm>
#include <string>

#include "convex/counted.hpp"
#include "convex/gamma0/node.hpp"

namespace convex::inline operations {

std::optional<std::vector<LinearQuadratic>> programs(std::span<const Function> parts, Index n) {
  std::vector<LinearQuadratic> forms;
  if (!all_of(parts, &Facts::piecewise_quadratic)) return std::nullopt;
  for (const Function& f : parts) {
    auto form = f.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    forms.push_back(*std::move(form));
  }
  return forms;
}

std::optional<std::vector<GraphForm>> graphs(std::span<const Function> parts, Index n, double slope) {
  std::vector<GraphForm> forms;
  for (const Function& f : parts) {
    auto form = f.node().graph(n, slope);
    if (!form) return std::nullopt;
    forms.push_back(*std::move(form));
  }
  return forms;
}

bool all_of(std::span<const Function> parts, bool Facts::*fact) {
  return std::all_of(parts.begin(), parts.end(), [&](const Function& f) { return f.facts().*fact; });
}

Index common_dimension(std::span<const Function> parts, const char* where) {
  Index n = 0;
  for (const Function& f : parts) {
    const Index own = f.dimension();
    if (own != 0 && n != 0 && own != n)
      throw InvalidInput(std::string(where) + ": its functions take " + std::to_string(n) + " and " +
                         counted(own, "entry", "entries") + "; give functions of one size");
    if (own != 0) n = own;
  }
  return n;
}

Index telling_size(std::span<const Function> parts, Index dimension) {
  if (dimension != 0) return dimension;
  const auto all_take = [&](Index n) {
    try {
      for (const Function& f : parts) f.node().require_size(n);
      return true;
    } catch (const InvalidInput&) {
      return false;
    }
  };
  // sum_largest(5) takes no less than 5, groups of three a multiple of 3
  constexpr Index most = 1 << 20, few = 64;
  for (Index n = 2; n <= most; n *= 2)
    if (all_take(n)) return n;
  for (Index n = 3; n <= few; ++n)
    if (all_take(n)) return n;
  return 0;
}

std::optional<Value> sum_of_constants(std::span<const Function> parts) {
  Value total;
  for (const Function& f : parts) {
    const auto part = f.node().constant_beside_entries();
    if (!part) return std::nullopt;
    total = sum_of(total, *part);
  }
  return total;
}

bool domains_may_miss(std::span<const Function> parts) {
  return std::count_if(parts.begin(), parts.end(), [](const Function& f) { return !f.facts().finite; }) > 1;
}

}  // namespace convex::inline operations
