#include "mechanics/settled_middle.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mechanics/row_space.hpp"

namespace mechanics {
namespace {

using convex::at;
using convex::ExactProblem;
using convex::ExactSolution;
using convex::ExactVector;
using convex::Fraction;
using convex::Vector;

/// Bounds to first order in radii that are small beside the rows, with their own rounding.
constexpr double second_order = 2;

/// An expansion u_a = Σ c_k u_k + rest over the rows kept.
struct Expansion {
  std::vector<Fraction> c;
  double rest = 0;   ///< ‖rest‖ at most
  double bound = 0;  ///< what the radii can make of it
};

class Settling {
 public:
  Settling(const convex::UncertainProblem& problem, const std::vector<Index>& first)
      : problem_(problem), near_(convex::rounded(problem.middle)), first_(first) {
    const Vector unit = near_.A.diagonal().cwiseSqrt().cwiseInverse();
    in_doubles_ = near_.U.dense() * unit.asDiagonal();
    radius_ = (problem.U * unit.asDiagonal()).rowwise().norm();
    for (Index i = 0; i < unit.size(); ++i) {
      std::vector<Fraction> row(at(unit.size()));
      row[at(i)] = convex::fraction(near_.A.diagonal()[i]);
      D_.push_back(convex::exact_vector(row));
    }
  }

  SettledMiddle settle() {
    SettledMiddle found{problem_.middle, {}};
    std::vector<Index> dependent;
    RowSpace space(problem_.z.size());
    for (const Index a : order()) {
      if (!are_fractions_needed_) {
        const RowSpace::Expansion seen = space.expansion(in_doubles_.row(a).transpose(), radius_[a]);
        if (seen.is_independent()) {
          space.keep(in_doubles_.row(a).transpose(), radius_[a], seen);
          kept_.push_back(a);
          continue;
        }
      }
      const Expansion expansion = expansion_of(a);
      if (!(expansion.rest <= expansion.bound)) {
        are_fractions_needed_ = true;  // doubles cannot follow any more
        kept_.push_back(a);
      } else {
        dependent.push_back(a);
      }
    }
    if (dependent.empty()) return found;
    find_weights();
    for (const Index a : dependent)
      if (make_dependent(a, found.problem)) found.dependent.push_back(a);
    std::sort(found.dependent.begin(), found.dependent.end());
    return found;
  }

 private:
  std::vector<Index> order() const {
    std::vector<Index> rows;
    std::vector<bool> taken(at(problem_.middle.rows()));
    std::vector<Index> all(taken.size());
    std::iota(all.begin(), all.end(), Index{0});
    for (const std::vector<Index>* some :
         {&problem_.middle.two_sided, &first_, static_cast<const std::vector<Index>*>(&all)})
      for (const Index a : *some) {
        if (!taken[at(a)]) rows.push_back(a);
        taken[at(a)] = true;
      }
    return rows;
  }

  ExactVector row(Index a) const { return {problem_.middle.U[at(a)], problem_.middle.row_unit[at(a)]}; }
  Fraction bound(Index a) const {
    return convex::lowest_terms({problem_.middle.s[at(a)], problem_.middle.row_unit[at(a)]});
  }

  /// min ½ q·Dq - z·q over u_k·q = s_k for the rows kept.
  ExactSolution nearest_on_kept(const ExactVector& z, const ExactVector& s) const {
    convex::ExactRows U;
    std::vector<Index> all(kept_.size());
    std::iota(all.begin(), all.end(), Index{0});
    for (const Index k : kept_) U.push_back(row(k));
    return convex::exact_active_set(convex::exact_problem(D_, z, U, s, all), all);
  }

  /// With D q = u_a - Σ c_k u_k, U q = 0: the rest is D q.
  Expansion expansion_of(Index a) const {
    const ExactSolution found =
        nearest_on_kept(row(a), convex::exact_vector(std::vector<Fraction>(kept_.size())));
    Expansion expansion;
    Fraction square{};
    for (std::size_t i = 0; i < D_.size(); ++i) {
      const Fraction q = convex::entry(found.q, i);
      square = square + convex::entry(D_[i], i) * q * q;
    }
    expansion.rest = convex::root_above(square);
    expansion.bound = radius_[a];
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      expansion.c.push_back(-convex::entry(found.lambda, k));
      expansion.bound += std::abs(convex::nearest_double(expansion.c[k])) * radius_[kept_[k]];
    }
    expansion.bound *= second_order;
    return expansion;
  }

  /// A row off by a vector of length 1 has a coefficient off by ‖w_k‖ at most, u_k·w_k = 1, u_j·w_k = 0.
  void find_weights() {
    weight_.resize(static_cast<Index>(kept_.size()));
    const ExactVector nothing = convex::exact_vector(std::vector<Fraction>(D_.size()));
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      std::vector<Fraction> s(kept_.size());
      s[k] = Fraction{1, 1};
      const ExactSolution found = nearest_on_kept(nothing, convex::exact_vector(s));
      weight_[static_cast<Index>(k)] = convex::root_above(convex::entry(found.lambda, k));
    }
  }

  /// Whether that changed it, or is owed to the radii.
  bool make_dependent(Index a, ExactProblem& problem) const {
    const Expansion expansion = expansion_of(a);
    if (expansion.bound == 0) return false;
    const std::size_t n = D_.size();
    std::vector<Fraction> numbers(n + 1);
    double off = problem_.s[a];
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      const Index kept = kept_[k];
      const double hidden = second_order * expansion.bound * weight_[static_cast<Index>(k)];
      const double c = std::abs(convex::nearest_double(expansion.c[k]));
      off += hidden * std::abs(convex::nearest_double(bound(kept))) + c * problem_.s[kept];
      if (c <= hidden) continue;
      const Fraction coefficient = rounded(expansion.c[k], hidden);
      const ExactVector u = row(kept);
      for (std::size_t i = 0; i < n; ++i) numbers[i] = numbers[i] + coefficient * convex::entry(u, i);
      numbers[n] = numbers[n] + coefficient * bound(kept);
    }
    const double apart = std::abs(convex::nearest_double(numbers[n] - bound(a)));
    if (!(apart <= second_order * off)) numbers[n] = bound(a);
    ExactVector together = convex::exact_vector(numbers);
    problem.s[at(a)] = together.numerators.back();
    together.numerators.pop_back();
    problem.U[at(a)] = std::move(together.numerators);
    problem.row_unit[at(a)] = std::move(together.denominator);
    return true;
  }

  /// With no more digits than `hidden` leaves of it.
  static Fraction rounded(const Fraction& c, double hidden) {
    const int digits = -std::ilogb(hidden) + 1;
    if (!(hidden > 0) || digits <= 0) return c;
    const convex::Integer scale = convex::Integer::shifted(1, static_cast<unsigned long>(digits));
    return convex::lowest_terms({truncated_quotient(c.numerator * scale, c.denominator), scale});
  }

  const convex::UncertainProblem& problem_;
  const convex::NearestPointProblem near_;
  const std::vector<Index>& first_;
  convex::ExactRows D_;  // the diagonal of A
  convex::RowMatrix in_doubles_;
  Vector radius_;
  std::vector<Index> kept_;
  Vector weight_;  // of the rows kept
  bool are_fractions_needed_ = false;
};

}  // namespace

SettledMiddle settled_middle(const convex::UncertainProblem& problem, const std::vector<Index>& first) {
  return Settling(problem, first).settle();
}

}  // namespace mechanics
