#pragma once

#include "convex/catalogue/catalogue.hpp"

/// The parts of the catalogue.
namespace convex::inline catalogue_entries {

std::vector<CatalogueEntry> set_entries();
std::vector<CatalogueEntry> cone_entries();
std::vector<CatalogueEntry> function_entries();
std::vector<CatalogueEntry> norm_entries();
std::vector<CatalogueEntry> operation_entries();

}  // namespace convex::inline catalogue_entries
