#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace convex::inline function_catalogue {

/// A work that the catalogue cites: "Condat 2016", and where to find it.
struct Reference {
  std::string_view name, text;
};

/// All of them, by name.
std::span<const Reference> references();

/// The works that a source of the catalogue cites, "Moreau 1963; Rockafellar 1970, Theorem 16.4": one for
/// each of its parts with a year in it. InvalidInput when one is not among `references()`.
std::vector<Reference> references_of(std::string_view source);

}  // namespace convex::inline function_catalogue
