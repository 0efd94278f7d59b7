#pragma once

#include <string_view>
#include <vector>

#include "convex/gamma0/call.hpp"
#include "convex/interval.hpp"

namespace convex::near_graphs {

/// Intervals that hold the arguments of a call as they are written: a double that is what was read is a
/// point, another one has its rounding about it. Infinite numbers stay.
class IntervalArguments {
 public:
  /// n: the number of entries of the space. The call is one that `make_function` has taken.
  IntervalArguments(const Call& call, Index n) : call_(call), n_(n) {}

  Interval number(std::string_view parameter) const;
  /// A number stands for n equal entries.
  std::vector<Interval> vector(std::string_view parameter) const;
  bool is_vector(std::string_view parameter) const;
  /// The entries of a matrix row by row, and the number of columns.
  std::vector<Interval> matrix(std::string_view parameter, Index& columns) const;
  const Call& call(std::string_view parameter) const;

 private:
  const NamedArgument* find(std::string_view parameter) const;
  const Call& call_;
  Index n_;
};

}  // namespace convex::near_graphs
