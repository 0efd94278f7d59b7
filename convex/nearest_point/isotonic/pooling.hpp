#pragma once

#include "convex/double_double.hpp"
#include "convex/nearest_point/isotonic/strings.hpp"

namespace convex::inline isotonic {

/// The nearest point over the rows of strings alone, for linear terms that change where rows of the border
/// act, and are z elsewhere. With q_i = y_i + (the gaps below) each string is an isotonic regression, solved
/// by pooling adjacent violators (Ayer, Brunk, Ewing, Reid and Silverman 1955), coordinates of a pool having
/// one y; pools below the floor are lifted to it. O(n); what the changes cannot reach is pooled once.
class Pooling {
 public:
  /// Coordinates that move together: members begin … end - 1 in the order of the strings.
  struct Pool {
    int begin, end;
    double weight, sum, mean;
  };

  Pooling(const NearestPointProblem&, const Strings&);

  /// In doubles: the pools are right but for rounding.
  void pool(const Vector& linear);
  /// q of these pools, in doubles: n.
  void place(Vector& q) const;
  /// From the pools on, in twice the working precision: q and the multipliers of the strings' rows. When they
  /// prove the pools wrong, these are found again with all sums in that precision. The linear term is linear
  /// + rest; rest may be empty.
  void refine(const Vector& linear, const Vector& rest);

  const std::vector<Pool>& pools() const { return pools_; }
  /// Whether a pool stands on the floor of its string.
  bool is_lifted(std::size_t pool) const;
  /// The length in the norm of A of all members moved by the largest sum of bounds below one: what pairs
  /// round is a part of it.
  double farthest_offset() const;
  /// The sign of the slack of the row below place k among the strings, without rounding, at the pools found;
  /// none where their linear term is not z, or fractions take too long.
  std::optional<int> rise_below(int k, const Vector& z, const Vector& linear, const Vector& rest) const;
  /// After `refine`: n.
  const DoubleDoubleVector& q() const { return q_; }
  /// After `refine`: m, 0 on border rows.
  const Vector& lambda() const { return lambda_; }

 private:
  struct Sums {
    DoubleDouble weight, sum, mean;
  };
  double mass(int k) const { return mass_[strings_.coordinate[static_cast<std::size_t>(k)]]; }
  double factor(int row) const;
  DoubleDouble bound(int row) const;
  int floor_of(int first) const { return strings_.row[static_cast<std::size_t>(first)]; }
  void find_offsets();
  void find_parts(const NearestPointProblem&);
  Pool member(int k, const Vector& linear) const;
  static void put(std::vector<Pool>& pools, std::size_t bottom, Pool pool);
  void pool_carefully(const Vector& linear, const Vector& rest);
  bool place_all(const Vector& linear, const Vector& rest, bool careful);
  bool place_string(const Vector& linear, const Vector& rest, bool careful, std::size_t string);
  DoubleDouble load(int k, const Vector& linear, const Vector& rest) const;
  Sums sums(const Pool&, const Vector& linear, const Vector& rest) const;

  const Vector& mass_;
  const SparseRows& U_;
  const Vector& s_;
  const Strings& strings_;
  std::vector<DoubleDouble> offset_;  ///< of a member over the first of its string; empty when all are 0
  double farthest_offset_ = 0;
  std::vector<double> floor_;            ///< the bound of a string's floor, -inf for none
  std::vector<std::size_t> first_pool_;  ///< of each string, and their number
  std::vector<Pool> parts_;              ///< pools of what stays between the border's coordinates, and those
  std::vector<bool> stays_;              ///< of each part: its linear term does
  std::vector<std::size_t> first_part_;  ///< of each string, and their number
  std::vector<Pool> pools_;
  DoubleDoubleVector q_;
  Vector lambda_;
};

}  // namespace convex::inline isotonic
