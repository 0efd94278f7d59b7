#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "convex/catalogue/catalogue.hpp"
#include "convex/invariant.hpp"
#include "convex/nearest_name.hpp"

namespace convex::inline function_catalogue {
namespace {

std::string signature(const CatalogueEntry& entry) {
  std::string text = std::string(entry.name) + "(";
  for (std::size_t i = 0; i < entry.parameters.size(); ++i)
    text += (i == 0 ? "" : ", ") + std::string(entry.parameters[i].name);
  return text + ")";
}

std::string unknown_key(const CatalogueEntry& entry, const std::string& key) {
  std::vector<std::string> names;
  for (const Parameter& parameter : entry.parameters) names.emplace_back(parameter.name);
  return std::string(entry.name) + ": there is no argument \"" + key + "\"; " +
         (names.empty()       ? "it takes none"
          : names.size() == 1 ? "its one argument is \"" + names.front() + "\""
                              : suggestion(key, names));
}

double number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  invariant(error == std::errc() && end == text.data() + text.size(), "a default is a number");
  return value;
}

/// Larger numbers of entries are slips.
constexpr double most_counted = 1e9;

bool is_variadic(const CatalogueEntry& entry) {
  return !entry.parameters.empty() && entry.parameters.back().kind == ParameterKind::functions;
}

}  // namespace

Arguments::Arguments(const CatalogueEntry& entry, const Call& call, const Space& space)
    : entry_(&entry), matched_(entry.parameters.size(), nullptr), call_(&call), space_(&space) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const NamedArgument& argument = call.arguments[i];
    const std::optional<Place> place = argument.place ? argument.place : call.place;
    std::size_t position = i;
    if (!argument.key.empty()) {
      const auto found =
          std::find_if(entry.parameters.begin(), entry.parameters.end(),
                       [&](const Parameter& parameter) { return parameter.name == argument.key; });
      if (found == entry.parameters.end()) throw InvalidInput(unknown_key(entry, argument.key), place);
      position = static_cast<std::size_t>(found - entry.parameters.begin());
    } else if (i > 0 && !call.arguments[i - 1].key.empty()) {
      throw InvalidInput(call.name + ": an argument by position after one by name; give its name", place);
    }
    const bool into_variadic = is_variadic(entry) && position + 1 >= entry.parameters.size();
    if (into_variadic) {
      variadic_.push_back(&argument);
      continue;
    }
    if (position >= entry.parameters.size())
      throw InvalidInput(call.name + ": too many arguments; write " + signature(entry) +
                             (entry.name == "max" ? ", or pointwise_max(f, g) of functions" : ""),
                         place);
    if (matched_[position] != nullptr)
      throw InvalidInput(
          call.name + "(" + std::string(entry.parameters[position].name) + "): given twice; give it once",
          place);
    matched_[position] = &argument;
  }
  for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
    const Parameter& parameter = entry.parameters[i];
    const bool absent = parameter.kind == ParameterKind::functions ? variadic_.empty() : !matched_[i];
    if (absent && parameter.fallback.empty())
      throw InvalidInput(
          call.name + ": " + std::string(parameter.name) + " is missing; write " + signature(entry),
          call.place);
  }
}

const Parameter& Arguments::declared(std::string_view parameter) const {
  const auto found = std::find_if(entry_->parameters.begin(), entry_->parameters.end(),
                                  [&](const Parameter& one) { return one.name == parameter; });
  invariant(found != entry_->parameters.end(), "a maker asks for the parameters of its own entry");
  return *found;
}

const NamedArgument* Arguments::find(std::string_view parameter) const {
  return matched_[static_cast<std::size_t>(&declared(parameter) - entry_->parameters.data())];
}

void Arguments::refuse(std::string_view parameter, const std::string& what) const {
  const NamedArgument* argument = find(parameter);
  throw InvalidInput(call_->name + "(" + std::string(parameter) + "): " + what,
                     argument && argument->place ? argument->place : call_->place);
}

bool Arguments::given(std::string_view parameter) const {
  return declared(parameter).kind == ParameterKind::functions ? !variadic_.empty()
                                                              : find(parameter) != nullptr;
}

double Arguments::number(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  if (!argument) return number_of(declared(parameter).fallback);
  const double* number = std::get_if<double>(&argument->value);
  if (!number) refuse(parameter, "not a number; give a number");
  if (std::isnan(*number)) refuse(parameter, "not a number; give a number");
  return *number;
}

Vector Arguments::vector(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  if (!argument) return Vector::Constant(space_->dimension(), number_of(declared(parameter).fallback));
  if (const double* number = std::get_if<double>(&argument->value)) {
    if (std::isnan(*number)) refuse(parameter, "not a number; give numbers");
    return Vector::Constant(space_->dimension(), *number);
  }
  const Vector* vector = std::get_if<Vector>(&argument->value);
  if (!vector) refuse(parameter, "not a vector; write [1,2,…]");
  if (vector->hasNaN()) refuse(parameter, "an entry is not a number; give numbers");
  return *vector;
}

bool Arguments::is_vector(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  return argument && std::holds_alternative<Vector>(argument->value);
}

Index Arguments::count(std::string_view parameter) const {
  const double value = number(parameter);
  if (!(value >= 1 && value <= most_counted) || value != std::floor(value))
    refuse(parameter, "not a whole number; give 1, 2, …");
  return static_cast<Index>(value);
}

std::vector<Index> Arguments::counts(std::string_view parameter) const {
  std::vector<Index> counts;
  for (double value : vector(parameter)) {
    if (!(value >= 1 && value <= most_counted) || value != std::floor(value))
      refuse(parameter, "an entry is not a whole number; give 1, 2, …");
    counts.push_back(static_cast<Index>(value));
  }
  return counts;
}

Matrix Arguments::pieces(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  invariant(argument != nullptr, "a matrix has no default");
  const Matrix* matrix = std::get_if<Matrix>(&argument->value);
  if (!matrix) refuse(parameter, "not a matrix; write [[1,2],[3,4]]");
  if (matrix->hasNaN()) refuse(parameter, "an entry is not a number; give numbers");
  return *matrix;
}

Matrix Arguments::matrix(std::string_view parameter) const {
  const Matrix read = pieces(parameter);
  if (!read.allFinite()) refuse(parameter, "an entry is not finite; give numbers");
  return read;
}

const Call& Arguments::call_of(const NamedArgument& argument, std::string_view parameter) const {
  const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value);
  if (!nested)
    throw InvalidInput(
        call_->name + "(" + std::string(parameter) + "): not a set or function; write a call such as norm1()",
        argument.place ? argument.place : call_->place);
  return **nested;
}

Set Arguments::set(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  invariant(argument != nullptr, "a set has no default");
  return make_set(call_of(*argument, parameter), *space_);
}

Function Arguments::function(std::string_view parameter) const { return function_in(parameter, *space_); }

Function Arguments::function_in(std::string_view parameter, const Space& in) const {
  const NamedArgument* argument = find(parameter);
  invariant(argument != nullptr, "a function has no default");
  return make_function(call_of(*argument, parameter), in);
}

std::vector<Function> Arguments::functions(std::string_view parameter) const {
  std::vector<Function> made;
  for (const NamedArgument* argument : variadic_)
    made.push_back(make_function(call_of(*argument, parameter), *space_));
  return made;
}

}  // namespace convex::inline function_catalogue
