#include "mechanics/map_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "mechanics/expression/exact_jet.hpp"
#include "mechanics/expression/expansion.hpp"
#include "mechanics/expression/parser.hpp"
#include "mechanics/expression/program.hpp"
#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics {
namespace {

using namespace expression;

/// Bits of balls: far more than a counterexample needs.
constexpr long map_precision = 256;

/// The expressions of a map on one tape.
class MapExpressions {
 public:
  explicit MapExpressions(const std::vector<Text>& components)
      : expansion_(meanings_, tape_), n_(components.size()) {
    for (std::size_t i = 0; i < n_; ++i) {
      const std::string name = n_ == 1 ? "x" : "x" + std::to_string(i + 1);
      names_.declare(name, {Name::Kind::coordinate, static_cast<std::uint32_t>(i), 0},
                     sources_.add({name, {}}, "coordinates"), 0);
      meanings_.coordinate_families.push_back({name, Members(), static_cast<std::uint32_t>(i)});
    }
    for (std::size_t i = 0; i < n_; ++i) {
      const Source& source = sources_.add(components[i], "component " + std::to_string(i + 1));
      refuse_more_coordinates(source, components[i].text);
      nodes_.push_back(expansion_.node(parse_expression(source, {&names_, Vocabulary::system, {}}), {}));
      if ((tape_.depends(nodes_.back()) & (on_time | on_velocities)) != 0)
        source.fail(0, "it uses t or a time derivative; a map is one of points, write it in its coordinates");
    }
    std::vector<NodeId> arguments;
    for (NodeId node = 0; n_ == 1 && node < tape_.size(); ++node) {
      const Operation operation = tape_.operation(node);
      const bool is_difference = operation == Operation::min || operation == Operation::max;
      if (operation != Operation::abs && !is_branch(operation)) continue;
      branches_.push_back({arguments.size(), is_difference});
      arguments.push_back(tape_.a(node));
      if (is_difference) arguments.push_back(tape_.b(node));
    }
    program_ = Program(tape_, n_, {nodes_, arguments});
    constants_ = rounded_nodes(tape_);
  }
  MapExpressions(const MapExpressions&) = delete;
  MapExpressions& operator=(const MapExpressions&) = delete;

  /// "x3" of two components is no slip of x1: there is a coordinate for each component.
  void refuse_more_coordinates(const Source& source, const std::string& text) const {
    const auto belongs = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = 0; at < text.size(); ++at) {
      if (text[at] != 'x' || (at > 0 && belongs(text[at - 1]))) continue;
      std::size_t end = at + 1;
      while (end < text.size() && belongs(text[end])) ++end;
      const std::string number = text.substr(at + 1, end - at - 1);
      const bool is_index =
          !number.empty() && number.size() < 9 && number[0] != '0' &&
          std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
      if (!is_index || (n_ > 1 && std::stoul(number) <= n_)) continue;
      const std::string last = "x" + std::to_string(n_);
      source.fail(at, "\"x" + number + "\" is unknown: " +
                          (n_ == 1   ? std::string("one component has x")
                           : n_ == 2 ? std::string("two components have x1 and x2")
                                     : std::to_string(n_) + " components have x1 to " + last) +
                          "; a map has as many components as coordinates");
    }
  }

  std::optional<convex::MapImage> at(const convex::ExactVector& z) const {
    ExactState state{Number(0), {}, {}};
    for (std::size_t i = 0; i < n_; ++i) {
      state.q.emplace_back(entry(z, i));
      state.v.emplace_back(0);
    }
    ExactEvaluation evaluation(tape_, state, convex::Ball::why_none().empty() ? map_precision : 0,
                               JetPart::rates);
    convex::MapImage image;
    std::vector<convex::Fraction> entries;
    for (const NodeId node : nodes_) {
      const auto& jet = evaluation(node);
      if (!jet || !jet->value.is_finite()) return with_radius(z);
      entries.push_back(jet->value.middle());
      image.radius = std::max(image.radius, jet->value.radius());
    }
    image.value = convex::exact_vector(entries);
    return image;
  }

  convex::Vector in_doubles(const convex::Vector& z) const {
    bool is_finite = true;
    const auto values =
        program_.values({0, z, convex::Vector::Zero(static_cast<convex::Index>(n_))}, 0, is_finite);
    convex::Vector image(static_cast<convex::Index>(n_));
    for (std::size_t i = 0; i < n_; ++i) image[static_cast<convex::Index>(i)] = values[program_.roots(0)[i]];
    return image;
  }

  /// Where each sign that a branch hangs on is that of a ball without 0, so that the same formula holds
  /// around z; then in fractions if there are such, which is what fractions alone would also tell at a kink.
  std::optional<convex::MapDerivative> derivative(const convex::ExactVector& z) const {
    if (!convex::Ball::why_none().empty()) return std::nullopt;
    const auto by_balls = derivative(z, map_precision, true);
    if (!by_balls) return std::nullopt;
    const auto by_fractions = derivative(z, 0, false);
    return by_fractions ? by_fractions : by_balls;
  }

  /// Where the argument of abs, the difference of those of min and max, or a condition changes its sign:
  /// found between points of a grid that takes in what is found, and beyond it where the argument is affine.
  /// None where there are very many.
  std::vector<convex::Fraction> kinks(double low, double high) const {
    constexpr int intervals = 256, most_rounds = 4;
    std::vector<double> grid, found;
    for (int k = 0; k <= intervals; ++k) grid.push_back(low + (high - low) * k / intervals);
    for (int round = 0; round < most_rounds; ++round) {
      const std::size_t before = found.size();
      for (const Branch& branch : branches_)
        for (std::size_t k = 0; k + 1 < grid.size(); ++k) {
          const double left = argument(branch, grid[k]), right = argument(branch, grid[k + 1]);
          if (left == 0) found.push_back(grid[k]);
          if (right == 0) found.push_back(grid[k + 1]);
          if (left * right < 0) found.push_back(crossing(branch, grid[k], grid[k + 1]));
          if (k > 0 && k + 2 < grid.size()) continue;
          const double beyond = grid[k] - left * (grid[k + 1] - grid[k]) / (right - left);
          const double miss = argument(branch, beyond),
                       rounding = 0x1p-40 * (std::abs(left) + std::abs(right));
          if (std::isfinite(beyond) && (beyond < low || beyond > high) && std::abs(miss) <= rounding)
            found.push_back(beyond);
        }
      std::sort(found.begin(), found.end());
      found.erase(std::unique(found.begin(), found.end()), found.end());
      if (found.size() == before) break;
      grid.insert(grid.end(), found.begin(), found.end());
      std::sort(grid.begin(), grid.end());
      grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
    }
    std::vector<convex::Fraction> kinks;
    for (const double x : found)
      if (const convex::Fraction kink = simple_near(x); kinks.empty() || kinks.back() < kink)
        kinks.push_back(kink);
    constexpr std::size_t most_kinks = 24;  // of more, points of a grid tell as much
    if (kinks.size() > most_kinks) return {};
    return kinks;
  }

 private:
  struct Branch {
    std::size_t argument;  ///< the first one's place among the roots of the second group
    bool is_difference;
  };

  double argument(const Branch& branch, double x) const {
    bool is_finite = true;
    const auto values =
        program_.values({0, convex::Vector::Constant(1, x), convex::Vector::Zero(1)}, 1, is_finite);
    const double a = values[program_.roots(1)[branch.argument]];
    return branch.is_difference ? a - values[program_.roots(1)[branch.argument + 1]] : a;
  }

  double crossing(const Branch& branch, double low, double high) const {
    const bool rises = argument(branch, low) < 0;
    for (;;) {
      const double middle = low + (high - low) / 2, value = argument(branch, middle);
      if (value == 0 || middle <= low || middle >= high) return middle;
      ((value < 0) == rises ? low : high) = middle;
    }
  }

  /// The first convergent of its continued fraction that is within rounding of a double.
  static convex::Fraction simple_near(double x) {
    const convex::Fraction value = convex::fraction(x),
                           within = convex::fraction(8 * convex::unit_roundoff * std::max(1.0, std::abs(x)));
    convex::Integer p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    convex::Fraction rest = value;
    for (;;) {
      const convex::Integer whole = truncated_quotient(rest.numerator, rest.denominator);
      const convex::Integer p2 = whole * p1 + p0, q2 = whole * q1 + q0;
      const convex::Fraction convergent =
          q2.sign() < 0 ? convex::Fraction{-p2, -q2} : convex::Fraction{p2, q2};
      const convex::Fraction off = convergent - value;
      if (!(within < (sign(off) < 0 ? -off : off))) return convergent;
      rest = convex::Fraction{1, 1} / (rest - convex::Fraction{whole, 1});
      p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    }
  }

  std::optional<convex::MapDerivative> derivative(const convex::ExactVector& z, long precision,
                                                  bool as_ball) const {
    ExactState state{Number(0), {}, {}};
    for (std::size_t i = 0; i < n_; ++i) {
      const convex::Fraction exact = entry(z, i);
      state.q.push_back(as_ball ? Number(convex::Ball::of(exact, precision), std::nullopt, nullptr)
                                : Number(exact));
      state.v.emplace_back(0);
    }
    ExactEvaluation evaluation(tape_, state, precision, JetPart::whole);
    convex::MapDerivative J;
    for (const NodeId node : nodes_) {
      const auto& jet = evaluation(node);
      if (!jet || !jet->value.is_finite()) return std::nullopt;
      for (std::size_t j = 0; j < n_; ++j) {
        const Number entry = jet->by_q.empty() ? Number(0) : jet->by_q[j];
        if (!entry.is_finite()) return std::nullopt;
        J.entries.push_back(entry.middle());
        J.radius = std::max(J.radius, entry.radius());
      }
    }
    return J;
  }

  /// At a kink, or where there are no balls: doubles with what they may be off.
  std::optional<convex::MapImage> with_radius(const convex::ExactVector& z) const {
    RoundedState state;
    for (std::size_t i = 0; i < n_; ++i) {
      const convex::Fraction exact = entry(z, i);
      const double near = convex::nearest_double(exact);
      const bool is_double = convex::fraction(near) == exact;
      state.q.emplace_back(near, is_double ? 0 : convex::unit_roundoff * 2 * std::abs(near));
    }
    state.v.resize(n_);
    const auto values = program_.rounded_values(state, 0, constants_);
    convex::MapImage image;
    convex::Vector entries(static_cast<convex::Index>(n_));
    for (std::size_t i = 0; i < n_; ++i) {
      const Rounded& value = values[program_.roots(0)[i]];
      if (!std::isfinite(value.value) || !std::isfinite(value.radius)) return std::nullopt;
      entries[static_cast<convex::Index>(i)] = value.value;
      image.radius = std::max(image.radius, value.radius);
    }
    image.value = convex::exact_vector(entries);
    return image;
  }

  Sources sources_;
  Names names_;
  Vocabularies meanings_;
  Tape tape_;
  Expansion expansion_;
  std::size_t n_;
  std::vector<NodeId> nodes_;
  std::vector<Branch> branches_;
  Program program_;
  std::vector<Rounded> constants_;
};

}  // namespace

convex::Map map_of_text(const std::vector<Text>& components) {
  const auto expressions = std::make_shared<const MapExpressions>(components);
  return {static_cast<convex::Index>(components.size()),
          [expressions](const convex::ExactVector& z) { return expressions->at(z); },
          [expressions](const convex::Vector& z) { return expressions->in_doubles(z); },
          [expressions](const convex::ExactVector& z) { return expressions->derivative(z); },
          [expressions](double low, double high) { return expressions->kinks(low, high); }};
}

}  // namespace mechanics
