#pragma once

#include <string_view>

#include "convex/exact_program/exact_program.hpp"
#include "convex/gamma0/call.hpp"

namespace convex::inline exact_programs {

/// A fraction, or an infinite number with its sign.
struct ExtendedFraction {
  Fraction value;
  int infinite = 0;
};

/// The arguments of a call that has been checked, at their exact values: a number that was read from text as
/// it is written, 1/3 as a third and 0.1 as a tenth; any other at its double.
class ExactArguments {
 public:
  /// n: the number of entries of the space. The call is one that `make_function` has taken.
  ExactArguments(const Call& call, std::size_t n);

  bool given(std::string_view parameter) const { return find(parameter) != nullptr; }
  bool is_vector(std::string_view parameter) const;
  Fraction number(std::string_view parameter) const;
  /// A number stands for n equal entries.
  Fractions vector(std::string_view parameter) const;
  std::vector<ExtendedFraction> extended(std::string_view parameter) const;
  std::vector<std::vector<ExtendedFraction>> matrix(std::string_view parameter) const;
  std::vector<ExactRow> rows(std::string_view parameter) const;
  const Call& call(std::string_view parameter) const;
  /// The calls among the arguments, in order: of sum, intersection, pointwise_max, separable.
  std::vector<const Call*> calls() const;
  std::size_t dimension() const { return n_; }

 private:
  const NamedArgument* find(std::string_view parameter) const;
  const Call& call_;
  std::size_t n_;
};

}  // namespace convex::inline exact_programs
