#include "convex/catalogue/catalogue.hpp"

namespace convex {

std::vector<CatalogueEntry> operation_entries() { return {}; }

}  // namespace convex
