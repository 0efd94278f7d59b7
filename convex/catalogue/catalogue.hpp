#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "convex/gamma0/function.hpp"

namespace convex::inline function_catalogue {

/// What a name of the language stands for.
enum class EntryKind { set, function, operation };

/// What an argument may be. Where a vector is wanted a number stands for the vector with equal entries; where
/// a function is wanted, a set stands for its indicator.
enum class ParameterKind { number, vector, matrix, set, function, functions };

/// A parameter of an entry; `fallback` is how its default is written, "" when it has to be given.
struct Parameter {
  std::string_view name;
  ParameterKind kind;
  std::string_view fallback = "";
};

class Arguments;

/// One line of the catalogue, the one list from which the language, `moreau functions`, docs/functions.md and
/// the laws are made. `make` builds the function (a set's indicator).
struct CatalogueEntry {
  std::string_view name;
  EntryKind kind;
  std::vector<Parameter> parameters;
  std::string_view formula;  ///< in plain text: "weight * sum |x_i|"
  std::string_view source;   ///< where its prox and conjugate come from: author, year
  /// How its prox is found in an identity, a diagonal and a general metric: "closed form", "exact by active
  /// set", or "iterative to 1e-12".
  std::string_view in_identity, in_diagonal, in_general;
  /// A call that the laws run, with three entries where the number is free.
  std::vector<std::string_view> examples;
  Function (*make)(const Arguments&);
  /// Where a function that is neither an indicator nor finite everywhere is finite: a set of the language, or
  /// words such as "x > 0"; "" when its arguments decide.
  std::string_view domain = "";
};

/// Every set, function and operation, in the order of the documentation.
std::span<const CatalogueEntry> catalogue();

/// The entry of that name, or null.
const CatalogueEntry* find_entry(std::string_view name);

/// The message about a name that is none of them: what the name means here when other languages have it
/// (lasso is norm1), the entry it is a slip of, or where they are listed.
std::string unknown_entry(std::string_view name);

/// What surrounds a call: the product of the space, on which conjugate, envelope, support and
/// proximal_average depend, and with it the number of entries.
struct Space {
  Metric product;
  Index dimension() const { return product.dimension(); }
};

/// The arguments of a call, matched to the parameters of its entry and evaluated in a space. Each throws
/// InvalidInput with the place when the argument is missing or of another kind.
class Arguments {
 public:
  Arguments(const CatalogueEntry& entry, const Call& call, const Space& space);
  double number(std::string_view parameter) const;
  /// A whole number >= 1.
  Index count(std::string_view parameter) const;
  std::vector<Index> counts(std::string_view parameter) const;
  /// A vector; a number where a vector is wanted stands for as many equal entries as the space has.
  Vector vector(std::string_view parameter) const;
  /// Was it given as a vector, and not as a number or not at all?
  bool is_vector(std::string_view parameter) const;
  Matrix matrix(std::string_view parameter) const;
  /// A matrix whose entries may be infinite.
  Matrix pieces(std::string_view parameter) const;
  Set set(std::string_view parameter) const;
  /// The function of a parameter, built in `in` instead of the call's own space when given (blocks, images).
  Function function(std::string_view parameter) const;
  Function function_in(std::string_view parameter, const Space& in) const;
  /// The functions of a variadic parameter.
  std::vector<Function> functions(std::string_view parameter) const;
  bool given(std::string_view parameter) const;
  const Call& call() const { return *call_; }
  const Space& space() const { return *space_; }
  /// InvalidInput "name(parameter): what; what to do" at the argument's place.
  [[noreturn]] void refuse(std::string_view parameter, const std::string& what) const;

 private:
  const NamedArgument* find(std::string_view parameter) const;
  const Parameter& declared(std::string_view parameter) const;
  /// The call that stands for a parameter.
  const Call& call_of(const NamedArgument& argument, std::string_view parameter) const;
  const CatalogueEntry* entry_;
  std::vector<const NamedArgument*> matched_;   ///< one per parameter, null when not given
  std::vector<const NamedArgument*> variadic_;  ///< what the last parameter takes when it is `functions`
  const Call* call_;
  const Space* space_;
};

/// The function (or, for a set, its indicator) that a call means in a space. Throws InvalidInput: an unknown
/// name with the nearest known one, a wrong argument, an empty set, a function that is not convex, closed and
/// proper.
Function make_function(const Call& call, const Space& space);
Set make_set(const Call& call, const Space& space);

}  // namespace convex::inline function_catalogue
