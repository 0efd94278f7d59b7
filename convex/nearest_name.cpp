#include "convex/nearest_name.hpp"

#include <algorithm>
#include <numeric>

namespace convex {
namespace {

constexpr std::size_t longest_compared = 64;  // bytes; longer names are no slips of the finger

/// The insertions, deletions and replacements that turn one name into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view unknown, const std::vector<std::string>& known,
                         std::size_t farthest) {
  std::string nearest;
  std::size_t least = farthest + 1;
  const std::string_view compared = unknown.substr(0, longest_compared);
  for (const std::string& name : known) {
    if (name.size() > longest_compared || name.size() >= compared.size() + least) continue;
    const std::size_t distance = edit_distance(compared, name);
    if (distance < least) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

}  // namespace convex
