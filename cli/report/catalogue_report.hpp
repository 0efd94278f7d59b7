#pragma once

#include <string>
#include <vector>

#include "convex/catalogue/catalogue.hpp"

namespace cli::inline reports {

/// An entry of the catalogue and the facts of what its first example makes.
struct CatalogueLine {
  const convex::CatalogueEntry* entry;
  convex::Facts facts;
};

CatalogueLine catalogue_line(const convex::CatalogueEntry&);
/// All entries, in the order of the catalogue.
std::vector<CatalogueLine> catalogue_lines();

/// A line each, the name first: name, arguments, formula, facts, and how the prox is found.
std::string catalogue_text(const std::vector<CatalogueLine>&);

/// Everything about one entry.
std::string catalogue_details(const CatalogueLine&);

/// {"functions": […]} on one line.
std::string catalogue_json(const std::vector<CatalogueLine>&);

/// docs/functions.md, whole.
std::string catalogue_markdown(const std::vector<CatalogueLine>&);

/// "set", "function", "operation".
const char* name(convex::EntryKind);
const char* name(convex::ParameterKind);

/// "radius=1, center=0": what stands between the parentheses, defaults with their =.
std::string arguments_text(const convex::CatalogueEntry&);

/// The facts that hold, in words.
std::vector<std::string> fact_words(const convex::Facts&);

}  // namespace cli::inline reports
