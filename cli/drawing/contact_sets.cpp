#include "cli/drawing/contact_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace cli::inline drawings {
namespace {

/// After white (Okabe and Ito 2008, lightened).
constexpr std::array set_colours{"#fbd9a5", "#bfe0f5", "#a9dcc8", "#f7f2ae", "#a9c7dd",
                                 "#eec1a3", "#e6c6d8", "#c8c8c8", "#8fb8a8"};
/// gnuplot's: full, stripes that fall, crossed. Those that rise mark what is wrong in an atlas.
constexpr std::array set_patterns{"solid 1", "pattern 5", "pattern 2"};

static_assert(most_fills == 1 + set_colours.size() * set_patterns.size());

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string contact_set_name(const std::vector<std::string>& held, const std::vector<std::string>& all) {
  constexpr std::size_t longest = 46;
  if (held.empty()) return "no contact";
  const std::string names = joined_names(held);
  if (names.size() <= longest) return names;
  std::vector<std::string> others;
  for (const std::string& name : all)
    if (std::find(held.begin(), held.end(), name) == held.end()) others.push_back(name);
  if (others.empty()) return fmt::format("all {} contacts", held.size());
  const std::string rest = "all but " + joined_names(others);
  if (rest.size() <= longest) return rest;
  return fmt::format("{}, … ({} of {})", names.substr(0, names.rfind(", ", longest - 14)), held.size(),
                     all.size());
}

std::vector<std::string> told_apart(const std::vector<std::string>& names,
                                    const std::vector<std::string>& beside) {
  std::vector<std::string> told = names;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (std::count(names.begin(), names.end(), names[k]) > 1) told[k] += ", " + beside[k];
  return told;
}

std::string set_fill(std::size_t k, const std::string& border) {
  const bool is_white = k == 0;
  const std::size_t other = is_white ? 0 : (k - 1) % (most_fills - 1);
  return fmt::format("fs {} {} fc rgb \"{}\"", set_patterns[other / set_colours.size()], border,
                     is_white ? "#ffffff" : set_colours[other % set_colours.size()]);
}

}  // namespace cli::inline drawings
