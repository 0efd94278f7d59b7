#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "mechanics/expression/cubic_spline.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// What is written out into other operations when an expression is expanded.
enum class Construction : std::uint8_t {
  if_at_least,  ///< if(a >= b, c, d)
  if_more,
  if_at_most,
  if_less,
  sign,       ///< -1, 0 or 1
  step,       ///< 0 where the argument is negative, else 1
  hypot,      ///< the root of a sum of squares
  table,      ///< table(x, [x1, …], [y1, …])
  component,  ///< the k-th of three: the three, k
  point,      ///< the k-th coordinate in space of a point of a body: x, y, z, e0 … e3, a, b, c, k
  point_x,    ///< the same for k = 1, without k
  point_y,
  point_z,
};

/// The functions of this kind that have a name of their own.
std::optional<Construction> construction_named(std::string_view name);

/// Whether `number` is 1, 2 or 3, the number of a coordinate in space.
bool is_component(double number);

/// The sign of a constant as written, by fractions or balls; none where those do not tell.
std::optional<int> sign_as_written(const Tape& tape, NodeId constant);

/// As nodes. Conditions that are constant are decided at once. The arguments of a table: x, the knots, the
/// values.
NodeId constructed(Tape& tape, Construction what, std::span<const NodeId> arguments, Origin origin);

/// As a number; the branch that is not taken may be undefined.
double constructed(Construction what, std::span<const double> arguments);

/// A natural cubic spline written out, piece by piece; undefined outside its range. `knots`, `values`: nodes
/// of its numbers.
NodeId spline_node(Tape& tape, NodeId x, std::span<const NodeId> knots, std::span<const NodeId> values,
                   Origin origin);

/// x1^2 + x2^2 + … where `node` is the root of such a sum, so that its square is smooth at 0; else no_node.
NodeId squared_length(const Tape& tape, NodeId node);

/// |x|^e for a constant e: branches where e is not even, smooth at 0 where e > 2.
NodeId absolute_power(Tape& tape, NodeId x, NodeId exponent, Origin origin);

}  // namespace mechanics::expression
