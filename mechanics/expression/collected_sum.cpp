#include "mechanics/expression/collected_sum.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace mechanics::expression {
namespace {

/// Terms up to which a product of sums is multiplied out.
constexpr std::size_t most_terms = 60;
/// The highest power of a sum that is.
constexpr int highest_power = 4;

const Fraction unit_factor{1};

void add_term(CollectedSum& sum, const Powers& powers, const Fraction& factor) {
  const auto [at, is_new] = sum.emplace(powers, factor);
  if (!is_new) at->second = at->second + factor;
  if (sign(at->second) == 0) sum.erase(at);
}

CollectedSum plus(CollectedSum a, const CollectedSum& b, const Fraction& factor) {
  for (const auto& [powers, c] : b) add_term(a, powers, factor * c);
  return a;
}

Powers times(const Powers& a, const Powers& b) {
  std::map<std::size_t, int> all(a.begin(), a.end());
  for (const auto& [atom, exponent] : b)
    if ((all[atom] += exponent) == 0) all.erase(atom);
  return {all.begin(), all.end()};
}

int exponent_of(const Powers& powers, std::size_t atom) {
  for (const auto& [which, exponent] : powers)
    if (which == atom) return exponent;
  return 0;
}

/// The integer that a sum without atoms is, if it is a small one.
std::optional<int> small_integer(const CollectedSum& sum) {
  if (sum.empty()) return 0;
  const auto& [powers, factor] = *sum.begin();
  const double value = convex::nearest_double(factor);
  if (sum.size() > 1 || !powers.empty() || std::abs(value) > 100 || value != std::round(value)) return {};
  return static_cast<int>(value);
}

}  // namespace

bool operator<(const CollectedAtom& a, const CollectedAtom& b) {
  const auto before = [](const CollectedSum& p, const CollectedSum& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end(),
                                        [](const auto& s, const auto& t) {
                                          return s.first != t.first ? s.first < t.first : s.second < t.second;
                                        });
  };
  if (std::tie(a.operation, a.leaf) != std::tie(b.operation, b.leaf))
    return std::tie(a.operation, a.leaf) < std::tie(b.operation, b.leaf);
  return std::lexicographical_compare(a.arguments.begin(), a.arguments.end(), b.arguments.begin(),
                                      b.arguments.end(), before);
}

std::size_t Collection::number_of(CollectedAtom atom) {
  const auto [at, is_new] = numbers_.emplace(atom, atoms_.size());
  if (is_new) atoms_.push_back(std::move(atom));
  return at->second;
}

CollectedSum Collection::of_atom(CollectedAtom atom, int exponent) {
  return {{{{number_of(std::move(atom)), exponent}}, unit_factor}};
}

CollectedSum Collection::kept_together(const CollectedSum& a, int exponent) {
  return of_atom({Operation::add, no_node, {with_joined_angles(with_squares_joined(a))}}, exponent);
}

CollectedSum Collection::product(CollectedSum a, CollectedSum b) {
  while (a.size() * b.size() > most_terms) {
    CollectedSum& longer = a.size() > b.size() ? a : b;
    longer = kept_together(longer, 1);
  }
  CollectedSum made;
  for (const auto& [p, c] : a)
    for (const auto& [q, d] : b) add_term(made, times(p, q), c * d);
  return made;
}

CollectedSum Collection::power(const CollectedSum& base, int exponent) {
  if (exponent == 0) return {{{}, unit_factor}};
  if (base.size() == 1) {
    const auto& [powers, factor] = *base.begin();
    Powers raised = powers;
    for (auto& [atom, e] : raised) e *= exponent;
    Fraction c = unit_factor;
    for (int k = 0; k < std::abs(exponent); ++k) c = exponent > 0 ? c * factor : c / factor;
    return {{raised, c}};
  }
  if (exponent < 0 || exponent > highest_power || std::pow(base.size(), exponent) > most_terms)
    return kept_together(base, exponent);
  CollectedSum made = base;
  for (int k = 1; k < exponent; ++k) made = product(made, base);
  return made;
}

CollectedSum Collection::power(NodeId node) {
  const CollectedSum base = expanded(tape_.a(node)), exponent = expanded(tape_.b(node));
  const std::optional<int> n = small_integer(exponent);
  if (n && (*n > 0 || !base.empty())) return power(base, *n);
  return of_atom({Operation::power, no_node, {(*this)(tape_.a(node)), exponent}});
}

const CollectedSum& Collection::expanded(NodeId node) {
  if (const auto at = known_.find(node); at != known_.end()) return at->second;
  CollectedSum sum = made(node);
  return known_.emplace(node, std::move(sum)).first->second;
}

CollectedSum Collection::made(NodeId node) {
  const Operation operation = tape_.operation(node);
  const NodeId a = tape_.a(node), b = tape_.b(node);
  switch (operation) {
    case Operation::literal: {
      if (!std::isfinite(tape_.constant(node))) return of_atom({operation, node, {}});
      const std::string& text = tape_.text(node);
      const auto value = convex::read_fraction(text.substr(0, text.find(radius_mark)));
      CollectedSum sum;
      add_term(sum, {}, value ? *value : convex::fraction(tape_.constant(node)));
      return sum;
    }
    case Operation::pi:
    case Operation::parameter:
    case Operation::coordinate:
    case Operation::velocity:
    case Operation::time:
      return of_atom({operation, node, {}});
    case Operation::negate:
      return plus({}, expanded(a), -unit_factor);
    case Operation::add:
      return plus(expanded(a), expanded(b), unit_factor);
    case Operation::subtract:
      return plus(expanded(a), expanded(b), -unit_factor);
    case Operation::multiply:
      return product(expanded(a), expanded(b));
    case Operation::divide:
      if (expanded(b).empty()) break;
      return product(expanded(a), power(expanded(b), -1));
    case Operation::power:
      return power(node);
    default:
      break;
  }
  CollectedAtom atom{operation, no_node, {(*this)(a)}};
  if (arity(operation) == 2) atom.arguments.push_back((*this)(b));
  return of_atom(std::move(atom));
}

/// cos² = 1 - sin², or the other way round.
CollectedSum Collection::without_square(const CollectedSum& sum, std::size_t squared, std::size_t other) {
  CollectedSum now = sum;
  for (bool changes = true; changes;) {
    changes = false;
    CollectedSum next;
    for (const auto& [powers, factor] : now) {
      if (exponent_of(powers, squared) < 2) {
        add_term(next, powers, factor);
        continue;
      }
      const Powers without = times(powers, {{squared, -2}});
      add_term(next, without, factor);
      add_term(next, times(without, {{other, 2}}), -factor);
      changes = true;
    }
    now = std::move(next);
  }
  return now;
}

CollectedSum Collection::with_squares_joined(CollectedSum sum) {
  std::vector<std::size_t> squares;
  for (const auto& [powers, factor] : sum)
    for (const auto& [atom, exponent] : powers)
      if (exponent >= 2 && atoms_[atom].operation == Operation::cos) squares.push_back(atom);
  std::sort(squares.begin(), squares.end());
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
  for (const std::size_t cosine : squares) {
    const std::size_t sine = number_of({Operation::sin, no_node, atoms_[cosine].arguments});
    CollectedSum by_sines = without_square(sum, cosine, sine);
    CollectedSum by_cosines = without_square(by_sines, sine, cosine);
    if (by_sines.size() < sum.size()) sum = std::move(by_sines);
    if (by_cosines.size() < sum.size()) sum = std::move(by_cosines);
  }
  return sum;
}

std::pair<std::size_t, int> Collection::of_angles(Operation function, std::size_t a, std::size_t b,
                                                  int sign_of_b) {
  CollectedSum angle =
      plus(atoms_[a].arguments[0], atoms_[b].arguments[0], sign_of_b > 0 ? unit_factor : -unit_factor);
  const bool flips = !angle.empty() && sign(angle.begin()->second) < 0;
  if (flips) angle = plus({}, angle, -unit_factor);
  return {number_of({function, no_node, {std::move(angle)}}), flips && function == Operation::sin ? -1 : 1};
}

/// One pair of terms c m cos a cos b ± c m sin a sin b, or c m sin a cos b ± c m cos a sin b.
bool Collection::join_angles(CollectedSum& sum) {
  const auto is = [&](std::size_t atom, Operation function) { return atoms_[atom].operation == function; };
  for (const auto& [powers, factor] : sum)
    for (const auto& [a, in_a] : powers)
      for (const auto& [b, in_b] : powers) {
        if (a == b || in_a < 1 || in_b < 1 || !is(b, Operation::cos)) continue;
        const bool of_cosines = is(a, Operation::cos) && a < b;
        if (!of_cosines && !is(a, Operation::sin)) continue;
        if (atoms_[a].arguments == atoms_[b].arguments) continue;
        const std::size_t other_a =
            number_of({of_cosines ? Operation::sin : Operation::cos, no_node, atoms_[a].arguments});
        const std::size_t sine_b = number_of({Operation::sin, no_node, atoms_[b].arguments});
        const Powers rest = times(powers, {{std::min(a, b), -1}, {std::max(a, b), -1}});
        const Powers partner = times(rest, times({{other_a, 1}}, {{sine_b, 1}}));
        const auto at = sum.find(partner);
        if (at == sum.end() || at->first == powers) continue;
        const bool alike = at->second == factor;
        if (!alike && !(at->second == -factor)) continue;
        const auto [angle, flip] = of_cosines ? of_angles(Operation::cos, a, b, alike ? -1 : 1)
                                              : of_angles(Operation::sin, a, b, alike ? 1 : -1);
        const Fraction c = flip < 0 ? -factor : factor;
        const Powers joined = times(rest, {{angle, 1}}), first = powers;
        sum.erase(at);
        sum.erase(first);
        add_term(sum, joined, c);
        return true;
      }
  return false;
}

CollectedSum Collection::with_joined_angles(CollectedSum sum) {
  while (join_angles(sum)) {
  }
  return sum;
}

}  // namespace mechanics::expression
