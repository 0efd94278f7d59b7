#include <cmath>
#include <map>

#include "convex/nearest_point/proof/exact_solution.hpp"
#include "mechanics/expression/exact_jet.hpp"
#include "mechanics/expression/exclusion.hpp"

namespace mechanics::expression {
namespace {

using convex::Fraction;
using convex::Index;

/// Σ factor of each unknown, a node, times it, and a constant.
struct Affine {
  std::map<NodeId, Fraction> factors;
  Fraction constant{0};
};

Affine times(const Affine& x, const Fraction& k) {
  Affine result{{}, x.constant * k};
  for (const auto& [node, factor] : x.factors)
    if (sign(factor * k) != 0) result.factors.emplace(node, factor * k);
  return result;
}

Affine sum(Affine x, const Affine& y) {
  x.constant = x.constant + y.constant;
  for (const auto& [node, factor] : y.factors) {
    const auto [known, is_new] = x.factors.emplace(node, factor);
    if (is_new) continue;
    known->second = known->second + factor;
    if (sign(known->second) == 0) x.factors.erase(known);
  }
  return x;
}

/// Expressions as sums over unknowns; what is not linear is an unknown of its own.
class AffineForms {
 public:
  AffineForms(const Tape& tape, const std::vector<std::optional<double>>& held) : tape_(tape), held_(held) {}

  const Affine& of(NodeId node) {
    const auto known = forms_.find(node);
    if (known != forms_.end()) return known->second;
    return forms_.emplace(node, made(node)).first->second;
  }

 private:
  Affine unknown(NodeId node) const { return {{{node, Fraction{1}}}, Fraction{0}}; }

  Affine made(NodeId node) {
    using enum Operation;
    switch (tape_.operation(node)) {
      case literal: {
        const auto value = literal_value(tape_, node);
        return value ? Affine{{}, *value} : unknown(node);
      }
      case parameter:
        return of(tape_.a(node));
      case coordinate:
        if (const auto& value = held_[tape_.a(node)]) return {{}, convex::fraction(*value)};
        return unknown(node);
      case negate:
        return times(of(tape_.a(node)), Fraction{-1});
      case add:
        return sum(of(tape_.a(node)), of(tape_.b(node)));
      case subtract:
        return sum(of(tape_.a(node)), times(of(tape_.b(node)), Fraction{-1}));
      case multiply: {
        const Affine a = of(tape_.a(node)), b = of(tape_.b(node));
        if (a.factors.empty()) return times(b, a.constant);
        if (b.factors.empty()) return times(a, b.constant);
        return unknown(node);
      }
      case divide: {
        const Affine a = of(tape_.a(node)), b = of(tape_.b(node));
        if (b.factors.empty() && convex::sign(b.constant) != 0) return times(a, Fraction{1} / b.constant);
        return unknown(node);
      }
      default:
        return unknown(node);
    }
  }

  const Tape& tape_;
  const std::vector<std::optional<double>>& held_;
  std::map<NodeId, Affine> forms_;
};

}  // namespace

bool excludes_by_weights(const Tape& tape, const std::vector<Demand>& demands,
                         const std::vector<std::optional<double>>& held, const std::vector<Range>& ranges) {
  constexpr std::size_t most_unknowns = 60;
  AffineForms forms(tape, held);
  std::map<NodeId, std::size_t> place;
  std::vector<Affine> rows;
  std::vector<Index> equations;
  for (const Demand& demand : demands) {
    if (demand.is_equation) equations.push_back(static_cast<Index>(rows.size()));
    rows.push_back(forms.of(demand.f));
    for (const auto& [node, factor] : rows.back().factors) place.emplace(node, place.size());
  }
  if (place.size() > most_unknowns) return false;
  for (const auto& [node, index] : place) {
    const Range range = ranges[node];
    if (range.is_empty()) continue;
    if (std::isfinite(range.low)) rows.push_back({{{node, Fraction{1}}}, -convex::fraction(range.low)});
    if (std::isfinite(range.high)) rows.push_back({{{node, Fraction{-1}}}, convex::fraction(range.high)});
  }
  const std::size_t n = place.size();
  std::vector<std::vector<Fraction>> U;
  std::vector<Fraction> s;
  for (const Affine& row : rows) {
    std::vector<Fraction> dense(n, Fraction{0});
    for (const auto& [node, factor] : row.factors) dense[place.at(node)] = factor;
    U.push_back(std::move(dense));
    s.push_back(-row.constant);
  }
  if (n == 0) {
    for (std::size_t a = 0; a < rows.size(); ++a) {
      const int left = sign(rows[a].constant);
      if (left < 0 || (left > 0 && demands[a].is_equation)) return true;
    }
    return false;
  }
  convex::ExactRows A, exact_U;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Fraction> unit(n, Fraction{0});
    unit[i] = Fraction{1};
    A.push_back(convex::exact_vector(unit));
  }
  for (const std::vector<Fraction>& row : U) exact_U.push_back(convex::exact_vector(row));
  const convex::ExactProblem problem =
      convex::exact_problem(A, convex::exact_vector(std::vector<Fraction>(n, Fraction{0})), exact_U,
                            convex::exact_vector(s), equations);
  constexpr double most_words = 1e8;  // a second or so
  const convex::ExactSolution solution = convex::exact_active_set(problem, {}, most_words);
  return solution.status == convex::Status::infeasible &&
         convex::proves_infeasibility(problem, solution.farkas);
}

}  // namespace mechanics::expression
