#pragma once

#include <string>
#include <vector>

namespace cli::inline drawings {

/// A set of contacts in a key: those that persist; of most of them those that do not; beyond the room of a
/// key the first, and how many of how many.
std::string contact_set_name(const std::vector<std::string>& held, const std::vector<std::string>& all);

/// The names, those that read alike told apart by what is told of them beside.
std::vector<std::string> told_apart(const std::vector<std::string>& names,
                                    const std::vector<std::string>& beside);

/// Sets with a fill of their own.
inline constexpr std::size_t most_fills = 28;

/// gnuplot's fill of the k-th set, its border in `border`'s words: pale colours, apart in grey too, then the
/// same colours in stripes, at last crossed ones.
std::string set_fill(std::size_t k, const std::string& border);

}  // namespace cli::inline drawings
