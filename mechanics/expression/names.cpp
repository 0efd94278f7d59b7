#include "mechanics/expression/names.hpp"

#include <algorithm>

#include "convex/nearest_name.hpp"
#include "mechanics/expression/operation.hpp"

namespace mechanics::expression {

std::string_view article_and_kind(Name::Kind kind) {
  switch (kind) {
    case Name::Kind::parameter:
      return "a parameter";
    case Name::Kind::coordinate:
      return "a coordinate";
    case Name::Kind::definition:
      return "a definition";
    default:
      return "a constraint";
  }
}

bool is_reserved(std::string_view name) {
  // Names that files may have used before these were functions; a parenthesis tells which is meant.
  if (name == "min" || name == "max" || name == "ln") return false;
  return name == "pi" || name == "t" || name == "sum" || name == "in" || function_named(name).has_value();
}

void Names::declare(std::string_view name, Name meaning, const Source& source, std::size_t offset) {
  declare_unlisted(name, meaning, source, offset);
  in_order_.emplace_back(name);
}

void Names::declare_unlisted(std::string_view name, Name meaning, const Source& source, std::size_t offset) {
  if (is_reserved(name))
    source.fail(offset,
                "the name " + quoted(name) + " belongs to the language of expressions; choose another");
  const auto [known, is_new] = meanings_.emplace(name, meaning);
  if (!is_new)
    source.fail(offset, "the name " + quoted(name) + " is taken, it is already " +
                            std::string(article_and_kind(known->second.kind)) + "; rename one of the two");
}

const Name* Names::find(std::string_view name) const {
  const auto found = meanings_.find(std::string(name));
  return found == meanings_.end() ? nullptr : &found->second;
}

std::string Names::suggestion(std::string_view unknown, const std::vector<Name::Kind>& kinds,
                              const std::vector<std::string>& also, bool language) const {
  std::vector<std::string> candidates = also;
  for (const std::string& name : in_order_)
    if (std::count(kinds.begin(), kinds.end(), meanings_.at(name).kind) > 0) candidates.push_back(name);
  if (candidates.empty() && !language) return "; there is none";
  const std::size_t known = candidates.size();
  if (language)
    for (const char* name : {"sin",   "cos", "tan",  "asin", "acos",  "atan", "atan2", "sinh", "cosh", "tanh",
                             "exp",   "log", "sqrt", "abs",  "sum",   "pi",   "t",     "min",  "max",  "sign",
                             "hypot", "ln",  "step", "if",   "table", "dot",  "cross", "norm", "point"})
      candidates.emplace_back(name);
  const std::string nearest = convex::nearest_name(unknown, candidates);
  if (!nearest.empty()) return "; did you mean " + quoted(nearest) + "?";
  constexpr std::size_t most_listed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(known, most_listed); ++i) list += (i == 0 ? "" : ", ") + candidates[i];
  if (known == 0) return "; declare it first";
  return "; known are " + list + (known > most_listed ? ", …" : "");
}

}  // namespace mechanics::expression
