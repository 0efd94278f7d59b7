#include "mechanics/expression/construction.hpp"

#include <cmath>
#include <limits>

#include "mechanics/expression/exact_jet.hpp"
#include "mechanics/expression/rounded_nodes.hpp"
#include "mechanics/expression/simplification.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::expression {
namespace {

/// The numbers of a spline's pieces, as nodes.
struct Polynomials {
  std::vector<NodeId> slope, bend, jerk;
};

/// Whether the double of a constant is the number itself: small integers, and what is made of them.
bool is_small_integer(const Tape& tape, NodeId node) {
  constexpr double most = 0x1p53;
  const double x = tape.constant(node);
  if (!(std::abs(x) < most) || x != std::round(x)) return false;
  switch (tape.operation(node)) {
    case Operation::literal:
      return rounded_literal(tape, node).radius == 0;
    case Operation::parameter:
    case Operation::negate:
      return is_small_integer(tape, tape.a(node));
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
      return is_small_integer(tape, tape.a(node)) && is_small_integer(tape, tape.b(node));
    default:
      return false;
  }
}

/// Builds nodes of one origin.
class Builder {
 public:
  Builder(Tape& tape, Origin origin) : tape_(&tape), origin_(origin) {}

  NodeId number(const char* text, double value) { return tape_->literal(text, value, origin_); }
  NodeId binary(Operation operation, NodeId a, NodeId b) { return tape_->apply(operation, a, b, origin_); }
  NodeId unary(Operation operation, NodeId a) { return binary(operation, a, a); }
  NodeId difference(NodeId a, NodeId b) { return binary(Operation::subtract, a, b); }
  NodeId sum(NodeId a, NodeId b) { return binary(Operation::add, a, b); }

  /// The one where d >= 0, the other where d < 0.
  NodeId branches(NodeId d, NodeId not_negative, NodeId negative) {
    if (tape_->is_chosen(d))
      if (const auto sign = sign_as_written(*tape_, d)) return *sign < 0 ? negative : not_negative;
    if (is_zero(not_negative)) return binary(Operation::where_negative, d, negative);
    if (is_zero(negative)) return binary(Operation::where_not_negative, d, not_negative);
    return sum(binary(Operation::where_not_negative, d, not_negative),
               binary(Operation::where_negative, d, negative));
  }
  NodeId edge(NodeId d) {
    tape_->note_edge(d);
    return d;
  }

  /// x + R(e) (a, b, c), its coordinate `row` from 0; R(e) has the columns e (i, j, k) conj(e) (Euler's
  /// parameters, e0 first; Goldstein, Poole and Safko 2002, section 4.5), and is a rotation where |e| = 1.
  NodeId point(std::span<const NodeId> x_e_abc, std::size_t row) {
    const auto e = [&](std::size_t i) { return x_e_abc[3 + i]; };
    const auto square = [&](std::size_t i) { return binary(Operation::power, e(i), number("2", 2)); };
    const auto twice = [&](NodeId node) { return binary(Operation::multiply, number("2", 2), node); };
    const auto product = [&](std::size_t i, std::size_t j) {
      return binary(Operation::multiply, e(i), e(j));
    };
    NodeId sum_of_terms = x_e_abc[row];
    for (std::size_t column = 0; column < 3; ++column) {
      NodeId entry = no_node;
      if (row == column) {
        entry = sum(square(0), square(row + 1));
        for (std::size_t other = 0; other < 3; ++other)
          if (other != row) entry = difference(entry, square(other + 1));
      } else {
        const std::size_t third = 3 - row - column;  // e_row e_column -+ e_0 e_third
        const bool next = (row + 1) % 3 == column;
        const NodeId mixed = product(row + 1, column + 1), turned = product(0, third + 1);
        entry = twice(next ? difference(mixed, turned) : sum(mixed, turned));
      }
      sum_of_terms = sum(sum_of_terms, binary(Operation::multiply, entry, x_e_abc[7 + column]));
    }
    return sum_of_terms;
  }

  /// The pieces `first` to `last` of a spline, by bisection of the knots.
  NodeId pieces(const Polynomials& spline, NodeId x, std::span<const NodeId> knots,
                std::span<const NodeId> values, std::size_t first, std::size_t last) {
    if (first < last) {
      const std::size_t middle = (first + last + 1) / 2;
      const NodeId left = pieces(spline, x, knots, values, first, middle - 1);
      const NodeId right = pieces(spline, x, knots, values, middle, last);
      return branches(difference(x, knots[middle]), right, left);
    }
    const NodeId u = difference(x, knots[first]);
    NodeId f = spline.jerk[first];
    f = sum(binary(Operation::multiply, f, u), spline.bend[first]);
    f = sum(binary(Operation::multiply, f, u), spline.slope[first]);
    return sum(binary(Operation::multiply, f, u), values[first]);
  }

  /// A number that is not known exactly: its text is that of no fraction.
  NodeId rounded(Rounded number) {
    return tape_->literal(text_with_radius(shortest_digits(number.value), number.radius), number.value,
                          origin_);
  }
  NodeId rounded(const convex::Fraction& exact) {
    const double number = convex::nearest_double(exact);
    return tape_->literal(text_of_fraction(shortest_digits(number), exact), number, origin_);
  }

 private:
  bool is_zero(NodeId node) const {
    return tape_->operation(node) == Operation::literal && tape_->constant(node) == 0;
  }

  Tape* tape_;
  Origin origin_;
};

bool holds(Construction what, double a, double b) {
  switch (what) {
    case Construction::if_at_least:
      return a >= b;
    case Construction::if_more:
      return a > b;
    case Construction::if_at_most:
      return a <= b;
    default:
      return a < b;
  }
}

}  // namespace

std::optional<Construction> construction_named(std::string_view name) {
  if (name == "if") return Construction::if_at_least;
  if (name == "sign") return Construction::sign;
  if (name == "step") return Construction::step;
  if (name == "hypot") return Construction::hypot;
  if (name == "table") return Construction::table;
  return std::nullopt;
}

std::optional<int> sign_as_written(const Tape& tape, NodeId node) {
  const double x = tape.constant(node);
  if (std::isnan(x) || is_small_integer(tape, node)) return x < 0 ? -1 : x > 0 ? 1 : 0;
  constexpr long precisions[] = {0, 512};  // bits; fractions first
  const ExactState nothing;
  for (const long precision : precisions) {
    if (precision != 0 && !convex::Ball::why_none().empty()) break;
    ExactEvaluation evaluate(tape, nothing, precision, JetPart::rates);
    const auto& jet = evaluate(node);
    if (!jet || !jet->value.is_finite()) continue;
    if (const auto sign = jet->value.sign()) return sign;
  }
  return std::nullopt;
}

bool is_component(double number) { return number == 1 || number == 2 || number == 3; }

NodeId constructed(Tape& tape, Construction what, std::span<const NodeId> arguments, Origin origin) {
  Builder build(tape, origin);
  const NodeId a = arguments[0];
  switch (what) {
    case Construction::if_at_least:
      return build.branches(build.edge(build.difference(a, arguments[1])), arguments[2], arguments[3]);
    case Construction::if_at_most:
      return build.branches(build.edge(build.difference(arguments[1], a)), arguments[2], arguments[3]);
    case Construction::if_more:
      return build.branches(build.edge(build.difference(arguments[1], a)), arguments[3], arguments[2]);
    case Construction::if_less:
      return build.branches(build.edge(build.difference(a, arguments[1])), arguments[3], arguments[2]);
    case Construction::sign: {
      const NodeId zero = build.number("0", 0), one = build.number("1", 1);
      const NodeId above = build.edge(build.unary(Operation::negate, a));
      return build.difference(build.branches(above, zero, one), build.branches(build.edge(a), zero, one));
    }
    case Construction::step:
      return build.branches(build.edge(a), build.number("1", 1), build.number("0", 0));
    case Construction::hypot: {
      const NodeId two = build.number("2", 2);
      NodeId squares = no_node;
      for (const NodeId x : arguments) {
        const NodeId square = build.binary(Operation::power, x, two);
        squares = squares == no_node ? square : build.sum(squares, square);
      }
      return build.unary(Operation::sqrt, squares);
    }
    case Construction::component:
      return arguments[static_cast<std::size_t>(tape.constant(arguments[3])) - 1];
    case Construction::point:
      return build.point(arguments, static_cast<std::size_t>(tape.constant(arguments[10])) - 1);
    case Construction::point_x:
      return build.point(arguments, 0);
    case Construction::point_y:
      return build.point(arguments, 1);
    case Construction::point_z:
      return build.point(arguments, 2);
    case Construction::table:
      break;
  }
  const std::size_t n = (arguments.size() - 1) / 2;
  const auto knots = arguments.subspan(1, n), values = arguments.subspan(1 + n, n);
  return spline_node(tape, a, knots, values, origin);
}

double constructed(Construction what, std::span<const double> arguments) {
  const double a = arguments[0];
  switch (what) {
    case Construction::sign:
      return a > 0 ? 1 : a < 0 ? -1 : 0;
    case Construction::step:
      return a < 0 ? 0 : 1;
    case Construction::hypot: {
      double length = 0;
      for (const double x : arguments) length = std::hypot(length, x);
      return length;
    }
    case Construction::table: {
      const std::size_t n = (arguments.size() - 1) / 2;
      return natural_cubic_spline(arguments.subspan(1, n), arguments.subspan(1 + n, n))(a);
    }
    case Construction::component:
      return arguments[static_cast<std::size_t>(arguments[3]) - 1];
    default:
      return holds(what, a, arguments[1]) ? arguments[2] : arguments[3];
  }
}

namespace {

/// Tables of more points have their pieces in doubles with radii: the digits of fractions grow with the
/// points.
constexpr std::size_t most_exact_points = 40;

/// The constants as the text has them; none where one of them is no fraction.
std::optional<std::vector<convex::Fraction>> fractions(const Tape& tape, std::span<const NodeId> nodes) {
  const ExactState nothing;
  ExactEvaluation evaluate(tape, nothing, 0, JetPart::rates);
  std::vector<convex::Fraction> found;
  for (const NodeId node : nodes) {
    const auto& jet = evaluate(node);
    if (!jet || !jet->value.is_exact()) return std::nullopt;
    found.push_back(jet->value.fraction());
  }
  return found;
}

template <class Pieces>
Polynomials polynomials(Builder& build, const Pieces& pieces) {
  Polynomials made;
  for (const auto& number : pieces.slope) made.slope.push_back(build.rounded(number));
  for (const auto& number : pieces.bend) made.bend.push_back(build.rounded(number));
  for (const auto& number : pieces.jerk) made.jerk.push_back(build.rounded(number));
  return made;
}

Polynomials polynomials(Tape& tape, Builder& build, std::span<const NodeId> knots,
                        std::span<const NodeId> values) {
  if (knots.size() <= most_exact_points) {
    const auto x = fractions(tape, knots), y = fractions(tape, values);
    if (x && y) return polynomials(build, exact_pieces(*x, *y));
  }
  const std::vector<Rounded> constants = rounded_nodes(tape);
  std::vector<Rounded> points, heights;
  for (const NodeId node : knots) points.push_back(constants[node]);
  for (const NodeId node : values) heights.push_back(constants[node]);
  return polynomials(build, natural_cubic_spline(points, heights));
}

}  // namespace

NodeId spline_node(Tape& tape, NodeId x, std::span<const NodeId> knots, std::span<const NodeId> values,
                   Origin origin) {
  Builder build(tape, origin);
  const Polynomials spline = polynomials(tape, build, knots, values);
  const std::string range = "table(…) outside " + number_text(tape.constant(knots.front())) + " to " +
                            number_text(tape.constant(knots.back()));
  const NodeId outside = tape.literal(range, std::numeric_limits<double>::quiet_NaN(), origin);
  const NodeId inside = build.pieces(spline, x, knots, values, 0, spline.slope.size() - 1);
  const NodeId below_end = build.branches(build.difference(knots.back(), x), inside, outside);
  return build.branches(build.difference(x, knots.front()), below_end, outside);
}

NodeId squared_length(const Tape& tape, NodeId node) {
  if (tape.operation(node) != Operation::sqrt) return no_node;
  const auto is_square = [&](NodeId term) {
    return tape.operation(term) == Operation::power && tape.is_constant(tape.b(term)) &&
           tape.constant(tape.b(term)) == 2;
  };
  NodeId rest = tape.a(node);
  for (; tape.operation(rest) == Operation::add; rest = tape.a(rest))
    if (!is_square(tape.b(rest))) return no_node;
  return is_square(rest) ? tape.a(node) : no_node;
}

NodeId absolute_power(Tape& tape, NodeId x, NodeId exponent, Origin origin) {
  Builder build(tape, origin);
  const NodeId plain = build.binary(Operation::power, x, exponent);
  if (std::fmod(tape.constant(exponent), 2) == 0) return plain;
  const NodeId turned = build.binary(Operation::power, build.unary(Operation::negate, x), exponent);
  return build.branches(x, plain, turned);
}

}  // namespace mechanics::expression
