#pragma once

#include <string_view>

/// The words for how a prox is found, the same in every entry of the catalogue.
namespace convex::inline catalogue_entries::routes {

inline constexpr std::string_view closed = "closed form";
inline constexpr std::string_view active = "exact by active set";
inline constexpr std::string_view iterative = "iterative to 1e-12";
inline constexpr std::string_view as_parts = "as its parts";

}  // namespace convex::inline catalogue_entries::routes
