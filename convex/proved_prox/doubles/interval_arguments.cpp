#include "convex/proved_prox/doubles/interval_arguments.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/interval_arithmetic.hpp"
#include "convex/invariant.hpp"

namespace convex::near_graphs {
namespace {

/// What a text says, near the double that was read from it.
Interval as_written(const std::string& text, double value) {
  const auto written = read_fraction(text);
  if (!written || std::isinf(value) || fraction(value) == *written) return interval_at(value);
  return outwards(value, value);
}

Interval entry_of(const NamedArgument& argument, double value, Index k) {
  const auto at = static_cast<std::size_t>(k);
  return at < argument.written.size() ? as_written(argument.written[at], value) : interval_at(value);
}

}  // namespace

const NamedArgument* IntervalArguments::find(std::string_view parameter) const {
  for (const NamedArgument& argument : call_.arguments)
    if (argument.key == parameter) return &argument;
  if (call_.arguments.empty() || !call_.arguments.front().key.empty()) return nullptr;
  const CatalogueEntry* entry = find_entry(call_.name);
  invariant(entry != nullptr, "a call that was taken is of the catalogue");
  for (std::size_t i = 0; i < std::min(call_.arguments.size(), entry->parameters.size()); ++i)
    if (call_.arguments[i].key.empty() && entry->parameters[i].name == parameter) return &call_.arguments[i];
  return nullptr;
}

bool IntervalArguments::is_vector(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  return argument != nullptr && std::holds_alternative<Vector>(argument->value);
}

std::vector<Interval> IntervalArguments::vector(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  if (argument == nullptr) {
    for (const Parameter& declared : find_entry(call_.name)->parameters)
      if (declared.name == parameter) {
        const std::string text(declared.fallback);
        const double value = nearest_double(read_fraction(text).value());
        return std::vector<Interval>(static_cast<std::size_t>(n_), as_written(text, value));
      }
    invariant(false, "a maker asks for the parameters of its own entry");
  }
  if (const auto* number = std::get_if<double>(&argument->value))
    return std::vector<Interval>(static_cast<std::size_t>(n_), entry_of(*argument, *number, 0));
  const Vector& numbers = std::get<Vector>(argument->value);
  std::vector<Interval> entries(static_cast<std::size_t>(numbers.size()));
  for (Index i = 0; i < numbers.size(); ++i)
    entries[static_cast<std::size_t>(i)] = entry_of(*argument, numbers[i], i);
  return entries;
}

Interval IntervalArguments::number(std::string_view parameter) const {
  return IntervalArguments(call_, 1).vector(parameter).at(0);
}

std::vector<Interval> IntervalArguments::matrix(std::string_view parameter, Index& columns) const {
  const NamedArgument* argument = find(parameter);
  invariant(argument != nullptr, "a matrix has no default");
  const Matrix& numbers = std::get<Matrix>(argument->value);
  columns = numbers.cols();
  std::vector<Interval> entries;
  entries.reserve(static_cast<std::size_t>(numbers.size()));
  for (Index i = 0; i < numbers.rows(); ++i)
    for (Index j = 0; j < columns; ++j)
      entries.push_back(entry_of(*argument, numbers(i, j), i * columns + j));
  return entries;
}

const Call& IntervalArguments::call(std::string_view parameter) const {
  return *std::get<std::shared_ptr<const Call>>(find(parameter)->value);
}

}  // namespace convex::near_graphs
