#include "cli/problem_file/numbers_by_constraint.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;
using convex::InvalidInput;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<std::int64_t> integer(std::string_view text) {
  text = trimmed(text);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// What one index of a key asks for.
struct IndexRange {
  std::int64_t low = std::numeric_limits<std::int64_t>::min(),
               high = std::numeric_limits<std::int64_t>::max();
  bool is_all() const { return low == std::numeric_limits<std::int64_t>::min(); }
};

/// A constraint's or a key's name in parts: "gap[i in 2..5, 1]" is gap, [2, 5], [1, 1].
struct FamilyName {
  std::string family;
  std::vector<IndexRange> indices;
};

IndexRange index_range(std::string_view text, const std::string& where, const NamedNumber& source) {
  if (const auto one = integer(text)) return {*one, *one};
  const std::size_t in = text.find(" in "), dots = text.find("..");
  if (in == std::string_view::npos) return {};
  const auto low = integer(text.substr(in + 4, dots - in - 4));
  const auto high = dots == std::string_view::npos ? std::nullopt : integer(text.substr(dots + 2));
  if (!low || !high)
    throw InvalidInput(where + ": \"" + source.constraint +
                           "\": the ends of its range are not integers; give numbers such as 2..5",
                       source.place);
  return {*low, *high};
}

FamilyName parts(const std::string& name, const std::string& where, const NamedNumber& source) {
  const std::size_t open = name.find('[');
  FamilyName found{std::string(trimmed(name.substr(0, open))), {}};
  if (open == std::string::npos || name.back() != ']') return found;
  std::string_view rest = std::string_view(name).substr(open + 1, name.size() - open - 2);
  while (true) {
    const std::size_t comma = rest.find(',');
    found.indices.push_back(index_range(trimmed(rest.substr(0, comma)), where, source));
    if (comma == std::string_view::npos) return found;
    rest.remove_prefix(comma + 1);
  }
}

/// 0: the key does not name the constraint; else the larger the more special.
int speciality(const FamilyName& key, const FamilyName& constraint) {
  constexpr int family = 1, part = 2, member = 3;
  if (key.family != constraint.family) return 0;
  if (key.indices.empty()) return constraint.indices.empty() ? member : family;
  if (key.indices.size() != constraint.indices.size()) return 0;
  bool all = true, single = true;
  for (std::size_t k = 0; k < key.indices.size(); ++k) {
    const IndexRange& range = key.indices[k];
    const std::int64_t at = constraint.indices[k].low;
    if (at < range.low || at > range.high) return 0;
    all = all && range.is_all();
    single = single && range.low == range.high;
  }
  return all ? family : single ? member : part;
}

}  // namespace

convex::Vector numbers_by_constraint(const std::string& where, double otherwise,
                                     const std::vector<NamedNumber>& entries,
                                     const std::vector<std::string>& constraints) {
  convex::Vector numbers = convex::Vector::Constant(static_cast<Index>(constraints.size()), otherwise);
  std::vector<int> so_far(constraints.size(), 0);
  for (const NamedNumber& named : entries) {
    const FamilyName key = parts(named.constraint, where, named);
    bool found = false;
    for (std::size_t a = 0; a < constraints.size(); ++a) {
      const int special = speciality(key, parts(constraints[a], where, named));
      found = found || special > 0;
      if (special == 0 || special < so_far[a]) continue;
      so_far[a] = special;
      numbers[static_cast<Index>(a)] = named.value;
    }
    if (!found)
      throw InvalidInput(where + ": no constraint \"" + named.constraint + "\"; " +
                             convex::suggestion(named.constraint, constraints),
                         named.place);
  }
  return numbers;
}

}  // namespace cli::inline problem_files
