#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/invariant.hpp"
#include "convex/vector.hpp"

namespace convex::inline multiplier_sets {

/// Word operations of what a pivot does to one entry, of numbers of a word.
inline constexpr double words_of_entry = 200;

/// [low, high]; none is infinite.
template <class Number>
struct MultiplierRange {
  std::optional<Number> low, high;
};

/// The polyhedron of multipliers at one of its vertices, as a simplex tableau: the basic multipliers are
/// value - T (nonbasic ones). Multipliers of two-sided rows are free; the others are >= 0. In doubles, where
/// what rounding leaves about 0 counts as 0, or in integers over one denominator, the least: a pivot without
/// fractions (Edmonds 1967) has no common divisor to find but the denominator, which all entries share as a
/// rule.
template <class Number>
class MultiplierTableau {
 public:
  using Numbers = std::vector<Number>;
  static constexpr bool is_rounded = std::is_same_v<Number, double>;
  /// Of a multiplier.
  using Value = std::conditional_t<is_rounded, double, Fraction>;

  /// basic: names of the basic multipliers with their values (>= 0 where not free); nonbasic: those at 0,
  /// each with its column of T, one entry a basic one; is_free: by name. Values and T are times
  /// `denominator` > 0; so are the multipliers, whose unit the caller knows.
  MultiplierTableau(std::vector<Index> basic, Numbers value, std::vector<Index> nonbasic,
                    std::vector<Numbers> T, std::vector<bool> is_free, Number denominator = 1)
      : now_{std::move(basic), std::move(nonbasic), std::move(value), std::move(T), std::move(denominator)},
        free_(std::move(is_free)),
        unbounded_(free_.size(), false),
        fixed_(now_.nonbasic.size(), false) {
    if constexpr (is_rounded) {
      // Values below this part of the largest are rounding about zero, and entries so many roundings of it.
      constexpr double relative_value_noise = 1e-14, roundings = 4;
      double entry = 1, value_size = 0;
      for (const Numbers& column : now_.T)
        for (const double x : column) entry = std::max(entry, std::abs(x));
      for (const double x : now_.value) value_size = std::max(value_size, std::abs(x));
      rounding_ = roundings * unit_roundoff * entry;
      value_noise_ = relative_value_noise * value_size;
    }
    settle_free_columns();
    if (is_rounded) {
      start_ = now_;
      start_growth_ = growth_;
    }
  }

  /// The interval of the multiplier named `a` over the polyhedron; not a number where rounding keeps the
  /// pivots from an end.
  MultiplierRange<Value> range(Index a) {
    if (unbounded_[at(a)] || is_spent()) return {};
    // The next range is found from the tableau at the start, where that costs little or many pivots have
    // been made since: rounding does not add up.
    constexpr Index most_pivots_since_start = 64;
    constexpr std::size_t few = 64;
    const bool is_small = now_.basic.size() + now_.nonbasic.size() <= few;
    if (is_rounded && pivots_ > (is_small ? 0 : most_pivots_since_start)) {
      now_ = start_;
      pivots_ = 0;
      growth_ = start_growth_;
    }
    std::optional<Value> low = extreme(a, false);
    return {std::move(low), extreme(a, true)};
  }

  /// In integers: no more pivots once they took so many word operations. Then ranges are not to be used.
  void allow(double words) { most_words_ = words; }
  bool is_spent() const { return words_ > most_words_; }

  /// Whether an entry that counted as 0 is more than the roundings of so many pivots, or one was divided by
  /// that is next to nothing beside others: then fractions may tell another interval.
  bool is_in_doubt() const { return is_in_doubt_; }

 private:
  /// What pivots change.
  struct State {
    std::vector<Index> basic, nonbasic;
    Numbers value;
    std::vector<Numbers> T;  ///< by columns
    Number denominator = 1;
  };
  /// The step value / rate after which a basic multiplier is 0.
  struct Block {
    std::size_t row = none;
    Number value{}, rate = 1;
    friend bool operator<(const Block& a, const Block& b) { return a.value * b.rate < b.value * a.rate; }
  };
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  bool is_free(Index name) const { return free_[at(name)]; }
  static bool is_zero(const Number& x) {
    if constexpr (is_rounded)
      return x == 0;
    else
      return x.is_zero();
  }
  /// Whether x > 0 beyond rounding, which a small pivot makes larger.
  bool is_positive(const Number& x) const {
    if constexpr (is_rounded) {
      const double rounding = rounding_ * static_cast<double>(1 + pivots_), noise = rounding * growth_;
      if (std::abs(x) <= noise && std::abs(x) > rounding) is_in_doubt_ = true;
      return !(x <= noise);
    } else {
      return x.sign() > 0;
    }
  }

  /// The row that blocks nonbasic column `column` when it grows, or shrinks, and how far it may go.
  Block blocking_row(std::size_t column, bool grows) const {
    Block first;
    for (std::size_t k = 0; k < now_.basic.size(); ++k) {
      const Index name = now_.basic[k];
      if (is_free(name)) continue;
      const Number& entry = now_.T[column][k];
      Number rate = grows ? entry : -entry;
      if (!is_positive(rate)) continue;
      Block block{k, value_noise_ < now_.value[k] ? now_.value[k] : Number{}, std::move(rate)};
      if constexpr (is_rounded) block = {k, block.value / block.rate, 1};
      const bool is_first =
          first.row == none || block < first || (!(first < block) && name < now_.basic[first.row]);
      if (is_first) first = std::move(block);
    }
    return first;
  }

  void pivot(std::size_t row, std::size_t column) {
    ++pivots_;
    if constexpr (is_rounded) {
      // A pivot that is a small part of its column makes so much more of what rounding left of the others.
      constexpr double least_part = 1e-5;
      double largest = 0;
      for (const double entry : now_.T[column]) largest = std::max(largest, std::abs(entry));
      const double part = std::abs(now_.T[column][row]) / largest;
      if (part < least_part) is_in_doubt_ = true;
      growth_ = std::max(growth_, 1 / part);
      pivot_in_doubles(row, column);
    } else {
      pivot_in_integers(row, column);
    }
    std::swap(now_.basic[row], now_.nonbasic[column]);
  }

  void pivot_in_doubles(std::size_t row, std::size_t column) {
    const Number element = now_.T[column][row], entering = now_.value[row] / element;
    Numbers& of_entering = now_.T[column];
    // The dependences of sparse rows are sparse.
    changing_.clear();
    for (std::size_t k = 0; k < of_entering.size(); ++k)
      if (k != row && !is_zero(of_entering[k])) changing_.push_back(k);
    const auto subtract = [&](Numbers& from, const Number& factor) {
      for (const std::size_t k : changing_) from[k] = from[k] - of_entering[k] * factor;
      from[row] = factor;
    };
    subtract(now_.value, entering);
    for (std::size_t j = 0; j < now_.T.size(); ++j)
      if (j != column && !is_zero(now_.T[j][row])) subtract(now_.T[j], now_.T[j][row] / element);
    for (Number& entry : of_entering) entry = -entry / element;
    of_entering[row] = Number{1} / element;
  }

  /// With T = t / D and the pivot p = t_rc, over p D: t_kj p - t_kc t_rj beside row r and column c, D t_rj
  /// and -D t_kc in them, D² where they meet. Then all over what they share: D, where it is a minor of
  /// integer rows, and whatever else.
  void pivot_in_integers(std::size_t row, std::size_t column) {
    Numbers& of_entering = now_.T[column];
    const Number pivot = of_entering[row], denominator = now_.denominator;
    Number shared = denominator;
    const auto cross = [&](Numbers& of_column) {
      for (std::size_t k = 0; k < of_column.size(); ++k) {
        if (k == row) continue;
        Number& entry = of_column[k];
        entry = difference_of_products(entry, pivot, of_entering[k], of_column[row]);
        if (entry.is_zero()) continue;
        words_ += words_of(entry);
        if (!is_multiple(entry, shared)) shared = greatest_common_divisor(shared, entry);
      }
    };
    const auto others = [&](const auto& change) {
      change(now_.value);
      for (std::size_t j = 0; j < now_.T.size(); ++j)
        if (j != column) change(now_.T[j]);
    };
    others(cross);
    // Over |p|, which is positive.
    const bool flips = pivot.sign() < 0;
    const Number divisor = flips ? -shared : shared, factor = exact_quotient(denominator, divisor);
    others([&](Numbers& of_column) {
      for (std::size_t k = 0; k < of_column.size(); ++k)
        of_column[k] = k == row ? of_column[k] * factor : exact_quotient(of_column[k], divisor);
    });
    for (std::size_t k = 0; k < of_entering.size(); ++k)
      of_entering[k] = k == row ? denominator * factor : -(of_entering[k] * factor);
    now_.denominator = pivot * factor;
    make_primitive();
  }

  void make_primitive() {
    const auto all = [&](const auto& change) {
      change(now_.value);
      for (Numbers& of_column : now_.T) change(of_column);
    };
    Number shared = now_.denominator;
    all([&](const Numbers& numbers) {
      for (const Number& x : numbers)
        if (!(shared == Number{1})) shared = greatest_common_divisor(shared, x);
    });
    if (shared == Number{1}) return;
    all([&](Numbers& numbers) {
      for (Number& x : numbers) x = exact_quotient(x, shared);
    });
    now_.denominator = exact_quotient(now_.denominator, shared);
  }

  /// Free multipliers enter the basis for good; one that no sign hinders moves its partners without bound.
  void settle_free_columns() {
    for (std::size_t column = 0; column < now_.T.size(); ++column) {
      if (!is_free(now_.nonbasic[column])) continue;
      const Block up = blocking_row(column, true), down = blocking_row(column, false);
      const Block& nearer = up.row != none && (down.row == none || !(down < up)) ? up : down;
      if (nearer.row != none) {
        pivot(nearer.row, column);
        // What left the basis is one-sided and at zero; the free one is basic and stays.
        continue;
      }
      // No sign restricts it: a line in the polyhedron.
      fixed_[column] = unbounded_[at(now_.nonbasic[column])] = true;
      for (std::size_t k = 0; k < now_.basic.size(); ++k)
        if (is_positive(now_.T[column][k]) || is_positive(-now_.T[column][k]))
          unbounded_[at(now_.basic[k])] = true;
    }
  }

  /// A column whose growth raises, or lowers, the basic multiplier of `row`: the steepest or the least by
  /// name; or none.
  std::size_t entering_column(std::size_t row, bool rises, bool by_name) const {
    const auto slope = [&](std::size_t j) { return rises ? -now_.T[j][row] : now_.T[j][row]; };
    std::size_t entering = none;
    for (std::size_t j = 0; j < now_.T.size(); ++j)
      if (!fixed_[j] && is_positive(slope(j)) &&
          (entering == none ||
           (by_name ? now_.nonbasic[j] < now_.nonbasic[entering] : slope(entering) < slope(j))))
        entering = j;
    return entering;
  }

  std::optional<Value> extreme(Index a, bool rises) {
    // By the rule of Bland (1977), the entering multiplier of least name that improves, the leaving one of
    // least name, nothing comes back. The steepest column enters; after a step of length 0 the rule holds
    // until there is a longer one. So nothing comes back, but for rounding: then the rule holds to the end,
    // and there is one.
    bool by_name = false;
    const std::size_t usual = now_.basic.size() + now_.nonbasic.size();
    for (std::size_t count = 0; is_rounded ? count <= 20 * usual : !is_spent(); ++count) {
      const auto position = std::find(now_.basic.begin(), now_.basic.end(), a);
      std::size_t entering = none;
      if (position == now_.basic.end()) {
        if (!rises) return Value{};  // nonbasic and one-sided: at its least value
        entering = at(std::find(now_.nonbasic.begin(), now_.nonbasic.end(), a) - now_.nonbasic.begin());
        invariant(entering < now_.nonbasic.size(), "a tight row is basic or nonbasic");
      } else {
        const std::size_t row = at(position - now_.basic.begin());
        entering = entering_column(row, rises, by_name);
        if (entering == none) return without_noise(now_.value[row], is_free(a));
      }
      const Block block = blocking_row(entering, true);
      if (block.row == none) return std::nullopt;
      by_name = !(Number{} < block.value) || count >= usual;
      pivot(block.row, entering);
    }
    if constexpr (is_rounded) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
  }

  /// Of two products, their difference and its quotient by what all share.
  static double words_of(const Number& entry) {
    constexpr double bits_of_word = 64;
    const double words = static_cast<double>(entry.bits()) / bits_of_word;
    return words_of_entry + words * words;
  }

  Value without_noise(const Number& value, bool may_be_negative) const {
    if constexpr (is_rounded) {
      const double end = may_be_negative ? value : std::max(0.0, value);
      return std::abs(end) <= value_noise_ ? 0 : end;
    } else {
      return lowest_terms({value, now_.denominator});
    }
  }

  State now_, start_;
  std::vector<std::size_t> changing_;  ///< rows of the last pivot with an entry in its column
  std::vector<bool> free_, unbounded_;
  std::vector<bool> fixed_;
  Number value_noise_{}, rounding_{};
  double growth_ = 1, start_growth_ = 1;  ///< of rounding, by the smallest pivot: now, in `start_`
  mutable bool is_in_doubt_ = false;
  double words_ = 0, most_words_ = std::numeric_limits<double>::infinity();
  Index pivots_ = 0;  // since the tableau was as at the start
};

}  // namespace convex::inline multiplier_sets
