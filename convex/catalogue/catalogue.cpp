#include "convex/catalogue/catalogue.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "convex/catalogue/entries/entries.hpp"
#include "convex/counted.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/mistakes.hpp"

namespace convex::inline function_catalogue {
namespace {

const CatalogueEntry& entry_of(const Call& call) {
  if (const CatalogueEntry* entry = find_entry(call.name)) return *entry;
  throw InvalidInput(unknown_entry(call.name), call.place);
}

/// f, checked to take the entries of the space.
Function fitting(Function f, const Call& call, const Space& space) {
  if (f.dimension() != 0 && f.dimension() != space.dimension())
    throw InvalidInput(call.name + ": it takes " + counted(f.dimension(), "entry", "entries") +
                           ", the space has " + std::to_string(space.dimension()) +
                           "; give data of that size",
                       call.place);
  f.node().require_size(space.dimension());
  return f;
}

/// The argument that a parameter of the entry has in a call; null where it has none.
const NamedArgument* argument_of(const CatalogueEntry& entry, const Call& call, std::string_view parameter) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const NamedArgument& argument = call.arguments[i];
    const bool is_it = argument.key.empty()
                           ? i < entry.parameters.size() && entry.parameters[i].name == parameter
                           : argument.key == parameter;
    if (is_it) return &argument;
  }
  return nullptr;
}

/// The parameter that a message is about, "weight" of "norm1(weight): negative; …"; "" where it is about
/// none.
std::string_view told_parameter(std::string_view message, const Call& call) {
  if (!message.starts_with(call.name + "(")) return {};
  message.remove_prefix(call.name.size() + 1);
  const std::size_t end = message.find("): ");
  return end == std::string_view::npos ? std::string_view() : message.substr(0, end);
}

/// Makes it. An error without a place has that of the argument that it is about, else of the call; the size
/// of the space is checked.
Function made_as_written(const CatalogueEntry& entry, const Call& call, const Space& space) {
  const Arguments arguments(entry, call, space);
  try {
    return fitting(entry.make(arguments), call, space);
  } catch (const InvalidInput& error) {
    if (error.place() || !call.place) throw;
    const NamedArgument* told = argument_of(entry, call, told_parameter(error.what(), call));
    throw InvalidInput(error.what(), told != nullptr && told->place ? told->place : call.place);
  }
}

const Call* nested_in(const NamedArgument& argument) {
  const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value);
  return nested == nullptr ? nullptr : nested->get();
}

/// The argument that an error of a call is about, or a call within it; null where it is about the whole.
const NamedArgument* argument_at_fault(const CatalogueEntry& entry, const Call& call,
                                       const InvalidInput& error) {
  const NamedArgument* told = argument_of(entry, call, told_parameter(error.what(), call));
  const auto line_and_column = [](const std::optional<Place>& place) {
    return place ? std::pair(place->line, place->column) : std::pair(0, 0);
  };
  const auto where = line_and_column(error.place());
  if (told != nullptr && line_and_column(told->place) == where) return told;
  if (where == line_and_column(call.place) && std::string_view(error.what()).starts_with(call.name + ": "))
    return nullptr;
  const NamedArgument* within = nullptr;
  for (const NamedArgument& argument : call.arguments)
    if (const Call* nested = nested_in(argument);
        nested != nullptr && nested->place && line_and_column(nested->place) <= where)
      within = &argument;
  return within;
}

/// What can be made of a call whatever is wrong with an argument: its default in place of a number, all of
/// the space in place of a set or function. False where there is none.
bool stand_in(const CatalogueEntry& entry, const Call& call, NamedArgument& argument) {
  if (nested_in(argument) != nullptr) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    argument.value = std::make_shared<const Call>(Call{"box", {{"", -inf, {}}, {"", inf, {}}}, call.place});
    return true;
  }
  for (const Parameter& parameter : entry.parameters)
    if (&argument == argument_of(entry, call, parameter.name) && !parameter.fallback.empty()) {
      argument.value = std::stod(std::string(parameter.fallback));
      return true;
    }
  return false;
}

/// Makes it. What is wrong with any argument is told, and not what may follow from a stand-in.
Function make(const CatalogueEntry& entry, const Call& call, const Space& space) {
  try {
    return made_as_written(entry, call, space);
  } catch (const InvalidInput& first) {
    if (!call.place) throw;
    Mistakes mistakes;
    mistakes.add(first);
    Call rest = call;
    const NamedArgument* wrong = argument_at_fault(entry, rest, first);
    for (std::size_t looks = 0; wrong != nullptr && looks < call.arguments.size(); ++looks) {
      NamedArgument& replaced = rest.arguments[static_cast<std::size_t>(wrong - rest.arguments.data())];
      wrong = nullptr;
      if (!stand_in(entry, rest, replaced)) break;
      try {
        made_as_written(entry, rest, space);
      } catch (const InvalidInput& next) {
        wrong = argument_at_fault(entry, rest, next);
        if (wrong == &replaced) wrong = nullptr;
        if (wrong != nullptr) mistakes.add(next);
      }
    }
    mistakes.tell();
    throw;
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
