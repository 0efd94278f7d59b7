#include "convex/nearest_name.hpp"

#include <algorithm>
#include <cctype>

namespace convex {
namespace {

constexpr std::size_t longest_compared = 64;  // bytes; longer names are no slips of the finger
constexpr std::size_t shortest_beginning = 3, shortest_word = 5;
constexpr std::size_t most_listed = 12;

std::string lower(std::string_view text) {
  std::string made(text.substr(0, longest_compared));
  for (char& c : made) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return made;
}

/// Insertions, deletions, replacements and exchanges of neighbours that turn one name into the other.
std::size_t slips(const std::string& a, const std::string& b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> d((a.size() + 1) * width);
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& here = d[i * width + j];
      if (i == 0 || j == 0) {
        here = i + j;
        continue;
      }
      const std::size_t above = d[(i - 1) * width + j], left = d[i * width + j - 1];
      here = std::min({above + 1, left + 1, d[(i - 1) * width + j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        here = std::min(here, d[(i - 2) * width + j - 2] + 1);
    }
  return d.back();
}

/// The words that hyphens and underscores make of a name, when there are several.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= name.size();) {
    const std::size_t end = std::min(name.find_first_of("-_", at), name.size());
    words.push_back(name.substr(at, end - at));
    at = end + 1;
  }
  return words.size() > 1 ? words : std::vector<std::string>{};
}

}  // namespace

std::string nearest_name(std::string_view unknown, const std::vector<std::string>& known) {
  const std::string given = lower(unknown);
  std::string nearest, begun, by_word;
  std::size_t least = (given.size() + 1) / 3 + 1, nearest_word = least, beginnings = 0;
  for (const std::string& name : known) {
    if (name.size() > longest_compared) continue;
    const std::string other = lower(name);
    if (given.size() >= shortest_beginning && other.compare(0, given.size(), given) == 0) {
      begun = name;
      ++beginnings;
    }
    if (given.size() >= shortest_word)
      for (const std::string& word : words_of(other)) {
        if (word.size() >= given.size() + nearest_word) continue;
        const std::size_t distance = slips(given, word);
        if (distance >= nearest_word || 2 * distance > word.size()) continue;
        nearest_word = distance;
        by_word = name;
      }
    if (name.size() >= given.size() + least) continue;
    const std::size_t distance = slips(given, other);
    if (distance >= least || distance >= std::max(given.size(), other.size())) continue;
    least = distance;
    nearest = name;
  }
  if (!nearest.empty()) return nearest;
  return beginnings == 1 ? begun : by_word;
}

std::string suggestion(std::string_view unknown, const std::vector<std::string>& known,
                       std::string_view others) {
  const std::string nearest = nearest_name(unknown, known);
  if (!nearest.empty()) return "did you mean \"" + nearest + "\"?";
  if (known.empty()) return "there is none";
  if (!others.empty()) return std::string(others);
  std::string list = "known are ";
  const std::size_t listed = known.size() <= most_listed + 1 ? known.size() : most_listed;
  for (std::size_t i = 0; i < listed; ++i) list += (i == 0 ? "" : ", ") + known[i];
  if (listed < known.size()) list += " and " + std::to_string(known.size() - listed) + " more";
  return list;
}

}  // namespace convex
