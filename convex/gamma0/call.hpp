#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "convex/invalid_input.hpp"
#include "convex/metric.hpp"
#include "convex/vector.hpp"

namespace convex::inline gamma0 {

/// A set, function or operation as it is written: name(key=value, …), the language of docs/functions.md. A
/// function knows the call that makes it again, so that conjugates print as expressions of the same language.
struct Call;
struct CallInProduct;
class FunctionNode;

/// What stands for a parameter: a number (inf allowed), a vector, a matrix, or another call.
using Argument = std::variant<double, Vector, Matrix, std::shared_ptr<const Call>>;

/// An argument, its name ("" when given by position) and its place, when it was read from text.
struct NamedArgument {
  std::string key;
  Argument value;
  std::optional<Place> place;
  /// The numbers of the value as they were written, row by row, when it was read from text: "1/3", "0.1".
  std::vector<std::string> written = {};
};

struct Call {
  std::string name;
  std::vector<NamedArgument> arguments = {};
  std::optional<Place> place = {};
  /// The function itself, where a user wrote it and no text makes it again; the name is then for readers.
  std::shared_ptr<const FunctionNode> made = {};
  /// The same function before its numbers were rounded, where this call, which means one thing in whatever
  /// space, had to round them. Where a metric is nearly singular their rounding is not small in it: who
  /// computes without rounding reads this.
  std::shared_ptr<const CallInProduct> unrounded = {};
};

/// A call that is meant in the space with the product given.
struct CallInProduct {
  Call call;
  Metric product;
};

/// An argument by position that is a call itself, and one by name: Call{"ball2", {argument("radius", 2.0)}}.
NamedArgument argument(Call call);
NamedArgument argument(std::string key, Argument value);
/// indicator(set) and support(set).
Call indicator_call(Call set);
Call support_call(Call set);

/// Has a call, or a part of it, numbers that were rounded as it was made?
bool has_rounded_numbers(const Call& call);

/// The call as text that reads back to the same call: numbers with the shortest digits that read back.
std::string to_text(const Call& call);
std::string to_text(double number);

}  // namespace convex::inline gamma0
