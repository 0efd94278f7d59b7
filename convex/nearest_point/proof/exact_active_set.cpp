#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "convex/exact/elimination.hpp"
#include "convex/exact/integer_system.hpp"
#include "convex/exact/modular.hpp"
#include "convex/invariant.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"
#include "convex/nearest_point/solve_watch.hpp"

namespace convex::inline proof {
namespace {

double longest(const IntegerVector& numbers) {
  std::size_t most = 0;
  for (const Integer& number : numbers) most = std::max(most, number.bits());
  return static_cast<double>(most);
}

/// Bits of the longest number of each row of A and U.
std::vector<double> row_bits(const ExactProblem& problem) {
  std::vector<double> bits;
  for (const IntegerRows* rows : {&problem.A, &problem.U})
    for (const IntegerVector& row : *rows) bits.push_back(std::max(1.0, longest(row)));
  return bits;
}

double longest(const std::vector<double>& bits) {
  return bits.empty() ? 1 : *std::max_element(bits.begin(), bits.end());
}

/// Each step of the inverse modulo a prime is some word operations, as measured beside those of lifting.
constexpr double of_inverse = 2;

/// Word operations of the inverse of a system with `held` rows, from nothing.
double operations_of_inverse(const ExactProblem& problem, std::size_t held) {
  const double N = static_cast<double>(problem.z.size() + held);
  return of_inverse * N * N * N;
}

/// One linear system with `held` rows whose numbers have so many bits, those of its fractions together; its
/// inverse that of another one, with a row more or less.
double operations(const ExactProblem& problem, std::size_t held, double bits, double of_fractions) {
  constexpr double word = 64, digit = 62;  // bits; of a number, and that a step of lifting gives
  const double n = static_cast<double>(problem.z.size()), N = n + static_cast<double>(held),
               m = static_cast<double>(problem.s.size());
  const double words = 1 + bits / word, digits = 1 + of_fractions / digit;
  // The change of the inverse; lifting; reading off the fractions; slacks.
  return of_inverse * N * N + digits * N * N * (1 + words) + N * digits * digits + m * n * digits * words;
}

double operations_to_find(const ExactProblem& problem, const ExactVector& x, std::size_t held) {
  const double of_fractions = longest(x.numerators) + static_cast<double>(x.denominator.bits());
  return operations(problem, held, longest(row_bits(problem)), of_fractions);
}

/// The problem, which is referred to, with independent rows S held: its KKT system, which follows S, and its
/// point, q before the multipliers of S, all over one denominator.
class HeldInFractions {
 public:
  HeldInFractions(const ExactProblem& problem, const std::vector<Index>& rows)
      : problem_(problem), rows_(rows), system_(prepared()) {}

  ExactVector point() const {
    IntegerVector right = problem_.z;
    for (Index a : rows_) right.push_back(problem_.s[at(a)]);
    return system_.solve(right);
  }

  /// How the point moves with the multiplier of one more row, and with it the multipliers of S.
  ExactVector direction(const IntegerVector& row) const {
    IntegerVector right = row;
    right.resize(row.size() + rows_.size(), 0);
    return system_.solve(right);
  }

  /// Row p as the last one of S; S without its row k.
  void append(Index p) {
    IntegerVector row = problem_.U[at(p)], column;
    for (const Integer& entry : row) column.push_back(-entry);
    const std::size_t size = row.size() + rows_.size();
    row.resize(size, 0);
    column.resize(size, 0);
    rows_.push_back(p);
    if (!system_.append(row, column)) system_ = prepared();
  }
  void remove(std::size_t k) {
    rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(k));
    if (!system_.remove(problem_.z.size() + k)) system_ = prepared();
  }

 private:
  IntegerSystem prepared() const {
    const std::size_t n = problem_.z.size(), k = rows_.size();
    IntegerRows M(n + k, IntegerVector(n + k, 0));
    for (std::size_t i = 0; i < n; ++i) std::copy(problem_.A[i].begin(), problem_.A[i].end(), M[i].begin());
    for (std::size_t r = 0; r < k; ++r)
      for (std::size_t i = 0; i < n; ++i) {
        M[n + r][i] = problem_.U[at(rows_[r])][i];
        M[i][n + r] = -M[n + r][i];
      }
    auto system = IntegerSystem::prepared(M);
    invariant(system.has_value(), "the KKT system of independent rows is regular modulo some large prime");
    return *std::move(system);
  }

  const ExactProblem& problem_;
  std::vector<Index> rows_;
  IntegerSystem system_;
};

class ExactActiveSet {
 public:
  ExactActiveSet(const ExactProblem& problem, const std::vector<Index>& guess, double most_words)
      : problem_(problem),
        n_(problem.z.size()),
        most_words_(most_words),
        two_sided_(marked(problem.rows(), problem.two_sided)) {
    IntegerRows candidates;
    for (Index a : guess) candidates.push_back(problem.U[at(a)]);
    for (std::size_t k : independent_rows(candidates, n_)) rows_.push_back(guess[k]);
    solution_.word_operations = of_inverse * static_cast<double>(candidates.size() * rows_.size() * n_);
    lengths_.resize(static_cast<Index>(problem.s.size()));
    for (std::size_t a = 0; a < problem.s.size(); ++a)
      lengths_[static_cast<Index>(a)] = std::sqrt(nearest_quotient(dot(problem.U[a], problem.U[a]), 1));
  }

  ExactSolution solve() {
    if (!drop_negative()) return solution_;
    while (true) {
      find_slacks();
      const Index p = most_violated();
      if (p < 0) return answer();
      if (!take_in(p) || !find_point()) return solution_;
    }
  }

 private:
  /// Whether one more linear system is affordable; if not, the method gives up.
  bool afford() {
    double next = word_operations(problem_, rows_.size());
    if (held_) next -= operations_of_inverse(problem_, rows_.size());
    if (solution_.word_operations + next > most_words_) {
      solution_.status = Status::gave_up;
      return false;
    }
    estimate_ = next;
    SolveWatch::tell("exact", solution_.steps);
    return true;
  }

  /// The work is that of the fractions found, which are mostly much shorter than they might have been.
  void count(const ExactVector& found) {
    solution_.word_operations += std::min(estimate_, operations_to_find(problem_, found, rows_.size()));
  }

  /// Affordable; the first time from nothing.
  const HeldInFractions& held() {
    if (held_) return *held_;
    solution_.word_operations += operations_of_inverse(problem_, rows_.size());
    return held_.emplace(problem_, rows_);
  }

  bool find_point() {
    if (!afford()) return false;
    point_ = held().point();
    count(point_);
    return true;
  }

  const Integer& multiplier(std::size_t k) const { return point_.numerators[n_ + k]; }

  void drop(std::size_t k) {
    rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(k));
    held_->remove(k);
  }

  /// Drops one-sided rows until the others have multipliers >= 0: the dual method can start there. False when
  /// it gives up.
  bool drop_negative() {
    while (find_point()) {
      const std::size_t before = rows_.size();
      for (std::size_t k = before; k-- > 0;)
        if (!two_sided_[at(rows_[k])] && multiplier(k).sign() < 0) drop(k);
      if (rows_.size() == before) return true;
      solution_.steps += static_cast<Index>(before - rows_.size());
    }
    return false;
  }

  void find_slacks() {
    const IntegerVector q(point_.numerators.begin(),
                          point_.numerators.begin() + static_cast<std::ptrdiff_t>(n_));
    slack_.clear();
    for (std::size_t a = 0; a < problem_.s.size(); ++a)
      slack_.push_back(dot(problem_.U[a], q) - problem_.s[a] * point_.denominator);
  }

  Index most_violated() const {
    Index worst = -1;
    double most = 0;
    for (std::size_t a = 0; a < slack_.size(); ++a) {
      const int sign = slack_[a].sign();
      if (sign == 0 || (sign > 0 && !two_sided_[a])) continue;
      const double length = lengths_[static_cast<Index>(a)];
      const double violation = std::abs(nearest_quotient(slack_[a], point_.denominator)) / length;
      // The comparison need not be exact: any violated row will do.
      if (worst < 0 || violation > most) {
        worst = static_cast<Index>(a);
        most = violation;
      }
    }
    return worst;
  }

  /// Takes the violated row p in, dropping rows that block; false when rows contradict each other, or when it
  /// gives up.
  bool take_in(Index p) {
    const int side = slack_[at(p)].sign() < 0 ? 1 : -1;  // a two-sided row may be violated from above
    IntegerVector row = problem_.U[at(p)];
    if (side < 0)
      for (Integer& entry : row) entry = -entry;
    while (true) {
      if (!afford()) return false;
      point_ = held().point();
      const ExactVector direction = held().direction(row);
      count(point_);
      count(direction);
      ++solution_.steps;
      // Times common positive factors: t2 = gap / rise, t1 = multiplier / -change.
      const IntegerVector q(point_.numerators.begin(),
                            point_.numerators.begin() + static_cast<std::ptrdiff_t>(n_));
      const IntegerVector d(direction.numerators.begin(),
                            direction.numerators.begin() + static_cast<std::ptrdiff_t>(n_));
      const Integer rise = dot(row, d);
      const Integer s = side > 0 ? problem_.s[at(p)] : -problem_.s[at(p)];
      const Integer gap = s * point_.denominator - dot(row, q);
      std::ptrdiff_t blocking = -1;
      Fraction first;
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const Integer& change = direction.numerators[n_ + k];
        if (two_sided_[at(rows_[k])] || change.sign() >= 0) continue;
        const Fraction step{multiplier(k), -change};
        if (blocking >= 0 && !(step < first)) continue;
        blocking = static_cast<std::ptrdiff_t>(k);
        first = step;
      }
      if (rise.is_zero() && blocking < 0) {
        contradict(p, side, direction);
        return false;
      }
      if (rise.is_zero() || (blocking >= 0 && first < Fraction{gap, rise})) {
        drop(at(blocking));
        continue;
      }
      rows_.push_back(p);
      held_->append(p);
      return true;
    }
  }

  /// side u_p + Σ change_k u_k = 0 with every change >= 0 on one-sided rows.
  void contradict(Index p, int side, const ExactVector& direction) {
    IntegerVector& w = solution_.farkas;
    w.assign(problem_.s.size(), 0);
    w[at(p)] = direction.denominator * problem_.row_unit[at(p)] * side;
    for (std::size_t k = 0; k < rows_.size(); ++k)
      w[at(rows_[k])] = direction.numerators[n_ + k] * problem_.row_unit[at(rows_[k])];
    make_primitive(w);
    solution_.status = Status::infeasible;
    invariant(proves_infeasibility(problem_, w), "the weights of a contradiction are a Farkas witness");
  }

  ExactSolution answer() {
    solution_.basis = rows_;
    solution_.q = {
        IntegerVector(point_.numerators.begin(), point_.numerators.begin() + static_cast<std::ptrdiff_t>(n_)),
        point_.denominator};
    solution_.lambda = {IntegerVector(problem_.s.size(), 0), point_.denominator * problem_.unit};
    for (std::size_t k = 0; k < rows_.size(); ++k)
      solution_.lambda.numerators[at(rows_[k])] = multiplier(k) * problem_.row_unit[at(rows_[k])];
    for (std::size_t a = 0; a < slack_.size(); ++a)
      solution_.slack.push_back(
          slack_[a].is_zero() ? Fraction{} : Fraction{slack_[a], point_.denominator * problem_.row_unit[a]});
    return solution_;
  }

  const ExactProblem& problem_;
  std::size_t n_;
  double most_words_;
  std::vector<bool> two_sided_;
  Vector lengths_;
  double estimate_ = 0;
  std::vector<Index> rows_;
  std::optional<HeldInFractions> held_;  ///< the same rows, once a point was asked for
  ExactVector point_;
  IntegerVector slack_;
  ExactSolution solution_;
};

}  // namespace

bool proves_infeasibility(const ExactProblem& problem, const IntegerVector& w) {
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  std::vector<Fraction> parts;  // weights of the integer rows
  for (std::size_t a = 0; a < w.size(); ++a) {
    if (w[a].sign() < 0 && !two_sided[a]) return false;
    parts.push_back(lowest_terms({w[a], problem.row_unit[a]}));
  }
  const IntegerVector weights = exact_vector(parts).numerators;
  IntegerVector column(w.size());
  for (std::size_t i = 0; i < problem.z.size(); ++i) {
    for (std::size_t a = 0; a < w.size(); ++a) column[a] = problem.U[a][i];
    if (!dot(column, weights).is_zero()) return false;
  }
  return dot(problem.s, weights).sign() > 0;
}

double word_operations(const ExactProblem& problem, std::size_t held) {
  const std::vector<double> bits = row_bits(problem);
  double of_all = 0;
  for (std::size_t i = 0; i < problem.z.size(); ++i) of_all += bits[i];
  std::vector<double> rows(bits.begin() + static_cast<std::ptrdiff_t>(problem.z.size()), bits.end());
  std::sort(rows.begin(), rows.end(), std::greater<>());
  for (std::size_t k = 0; k < std::min(held, rows.size()); ++k) of_all += rows[k];
  // By Cramer's rule: two determinants, one of them with the right side for a column.
  const double of_fractions = 2 * of_all + std::max(longest(problem.z), longest(problem.s));
  return operations_of_inverse(problem, held) + operations(problem, held, longest(bits), of_fractions);
}

ExactSolution exact_active_set(const ExactProblem& problem, const std::vector<Index>& guess,
                               double most_words) {
  return ExactActiveSet(problem, guess, most_words).solve();
}

}  // namespace convex::inline proof
