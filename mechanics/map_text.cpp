#include "mechanics/map_text.hpp"

#include <algorithm>
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
      nodes_.push_back(expansion_.node(parse_expression(source, {&names_, Vocabulary::system, {}}), {}));
      if ((tape_.depends(nodes_.back()) & (on_time | on_velocities)) != 0)
        source.fail(0, "it uses t or a time derivative; a map is one of points, write it in its coordinates");
    }
    program_ = Program(tape_, n_, {nodes_});
    constants_ = rounded_nodes(tape_);
  }
  MapExpressions(const MapExpressions&) = delete;
  MapExpressions& operator=(const MapExpressions&) = delete;

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

 private:
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
  Program program_;
  std::vector<Rounded> constants_;
};

}  // namespace

convex::Map map_of_text(const std::vector<Text>& components) {
  const auto expressions = std::make_shared<const MapExpressions>(components);
  return {static_cast<convex::Index>(components.size()),
          [expressions](const convex::ExactVector& z) { return expressions->at(z); },
          [expressions](const convex::Vector& z) { return expressions->in_doubles(z); },
          [expressions](const convex::ExactVector& z) { return expressions->derivative(z); }};
}

}  // namespace mechanics
