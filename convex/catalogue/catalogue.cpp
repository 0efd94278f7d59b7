#include "convex/catalogue/catalogue.hpp"

#include <algorithm>

#include "convex/catalogue/entries/entries.hpp"
#include "convex/gamma0/node.hpp"

namespace convex::inline function_catalogue {
namespace {

const CatalogueEntry& entry_of(const Call& call) {
  if (const CatalogueEntry* entry = find_entry(call.name)) return *entry;
  throw InvalidInput(unknown_entry(call.name), call.place);
}

/// f, checked to take the entries of the space.
Function fitting(Function f, const Call& call, const Space& space) {
  if (f.dimension() != 0 && f.dimension() != space.dimension())
    throw InvalidInput(call.name + ": it takes " + std::to_string(f.dimension()) +
                           " entries, the space has " + std::to_string(space.dimension()) +
                           "; give data of that size",
                       call.place);
  f.node().require_size(space.dimension());
  return f;
}

/// Makes it, with the place of the call on errors that have none, and the size of the space checked.
Function make(const CatalogueEntry& entry, const Call& call, const Space& space) {
  const Arguments arguments(entry, call, space);
  try {
    return fitting(entry.make(arguments), call, space);
  } catch (const InvalidInput& error) {
    if (error.place() || !call.place) throw;
    throw InvalidInput(error.what(), call.place);
  }
}

}  // namespace

std::span<const CatalogueEntry> catalogue() {
  static const std::vector<CatalogueEntry> entries = [] {
    std::vector<CatalogueEntry> all = set_entries();
    for (CatalogueEntry& entry : function_entries()) all.push_back(std::move(entry));
    for (CatalogueEntry& entry : operation_entries()) all.push_back(std::move(entry));
    return all;
  }();
  return entries;
}

const CatalogueEntry* find_entry(std::string_view name) {
  const auto entries = catalogue();
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const CatalogueEntry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

Function make_function(const Call& call, const Space& space) {
  if (call.made) return fitting(Function(call.made), call, space);
  return make(entry_of(call), call, space);
}

Set make_set(const Call& call, const Space& space) {
  const CatalogueEntry* const entry = call.made ? nullptr : &entry_of(call);
  if (entry == nullptr || entry->kind != EntryKind::set)
    throw InvalidInput(call.name + ": a function where a set is wanted; give a set such as box(0, 1)",
                       call.place);
  const Function indicator = make(*entry, call, space);
  const Call made = indicator.call();
  // A node knows its set by the call indicator(set); what does not is named as it was written.
  if (made.name == "indicator" && made.arguments.size() == 1)
    if (const auto* named = std::get_if<std::shared_ptr<const Call>>(&made.arguments[0].value))
      return {indicator, **named};
  return {indicator, call};
}

}  // namespace convex::inline function_catalogue
