#include "convex/exact_program/exact_arguments.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/invariant.hpp"

namespace convex::inline exact_programs {
namespace {

ExtendedFraction exact_entry(const NamedArgument& argument, double value, std::size_t k) {
  if (std::isinf(value)) return {{}, value > 0 ? 1 : -1};
  if (k < argument.written.size())
    if (const auto written = read_fraction(argument.written[k])) return {lowest_terms(*written)};
  return {fraction(value)};
}

}  // namespace

ExactArguments::ExactArguments(const Call& call, std::size_t n) : call_(call), n_(n) {}

const NamedArgument* ExactArguments::find(std::string_view parameter) const {
  const CatalogueEntry* entry = find_entry(call_.name);
  invariant(entry != nullptr, "a call that was taken is of the catalogue");
  for (std::size_t i = 0; i < call_.arguments.size(); ++i) {
    const NamedArgument& argument = call_.arguments[i];
    if (argument.key.empty() ? i < entry->parameters.size() && entry->parameters[i].name == parameter
                             : argument.key == parameter)
      return &argument;
  }
  return nullptr;
}

bool ExactArguments::is_vector(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  return argument != nullptr && std::holds_alternative<Vector>(argument->value);
}

std::vector<ExtendedFraction> ExactArguments::extended(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  if (argument == nullptr) {
    for (const Parameter& declared : find_entry(call_.name)->parameters)
      if (declared.name == parameter)
        return std::vector<ExtendedFraction>(n_, {read_fraction(std::string(declared.fallback)).value()});
    return {};
  }
  if (const auto* number = std::get_if<double>(&argument->value))
    return std::vector<ExtendedFraction>(n_, exact_entry(*argument, *number, 0));
  std::vector<ExtendedFraction> entries;
  const Vector& numbers = std::get<Vector>(argument->value);
  for (Index i = 0; i < numbers.size(); ++i)
    entries.push_back(exact_entry(*argument, numbers[i], static_cast<std::size_t>(i)));
  return entries;
}

Fractions ExactArguments::vector(std::string_view parameter) const {
  Fractions entries;
  for (const ExtendedFraction& one : extended(parameter)) entries.push_back(one.value);
  return entries;
}

Fraction ExactArguments::number(std::string_view parameter) const {
  return ExactArguments(call_, 1).vector(parameter).at(0);
}

std::vector<std::vector<ExtendedFraction>> ExactArguments::matrix(std::string_view parameter) const {
  const NamedArgument* argument = find(parameter);
  invariant(argument != nullptr, "a matrix has no default");
  const Matrix& numbers = std::get<Matrix>(argument->value);
  std::vector<std::vector<ExtendedFraction>> rows(static_cast<std::size_t>(numbers.rows()));
  std::size_t k = 0;
  for (Index i = 0; i < numbers.rows(); ++i)
    for (Index j = 0; j < numbers.cols(); ++j)
      rows[static_cast<std::size_t>(i)].push_back(exact_entry(*argument, numbers(i, j), k++));
  return rows;
}

std::vector<ExactRow> ExactArguments::rows(std::string_view parameter) const {
  std::vector<ExactRow> made;
  for (const auto& row : matrix(parameter)) {
    made.emplace_back();
    for (std::size_t j = 0; j < row.size(); ++j) add(made.back(), j, row[j].value);
  }
  return made;
}

const Call& ExactArguments::call(std::string_view parameter) const {
  return *std::get<std::shared_ptr<const Call>>(find(parameter)->value);
}

std::vector<const Call*> ExactArguments::calls() const {
  std::vector<const Call*> nested;
  for (const NamedArgument& argument : call_.arguments)
    if (const auto* one = std::get_if<std::shared_ptr<const Call>>(&argument.value))
      nested.push_back(one->get());
  return nested;
}

}  // namespace convex::inline exact_programs
