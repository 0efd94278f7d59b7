#pragma once

#include "convex/nearest_point/isotonic/chain_pools.hpp"

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
  /// What the rounding of sums of bounds in twice the precision makes of q, in the norm of A.
  double rounding() const;
  /// The sign of the slack of the row below place k among the strings, without rounding, at the pools found;
  /// none where their linear term is not z, or fractions take too long.
  std::optional<int> rise_below(int k, const Vector& linear, const Vector& rest) const;
  /// After `refine`: n.
  const DoubleDoubleVector& q() const { return q_; }
  /// After `refine`: m, 0 on border rows.
  const Vector& lambda() const { return lambda_; }

 private:
  struct Sums {
    DoubleDouble weight, sum, mean;
  };
  double mass(int k) const { return chain_.mass[chain_.order.coordinate(k)]; }
  void find_parts(const NearestPointProblem&);
  Pool member(int k, const Vector& linear) const;
  static void put(std::vector<Pool>& pools, std::size_t bottom, Pool pool);
  void pool_carefully(const Vector& linear, const Vector& rest);
  bool place_all(const Vector& linear, const Vector& rest, bool careful);
  bool place_string(const Vector& linear, const Vector& rest, bool careful, std::size_t string);
  DoubleDouble load(int k, const Vector& linear, const Vector& rest) const;
  Sums sums(const Pool&, const Vector& linear, const Vector& rest) const;

  const Strings& strings_;
  Arena arena_;
  const Chain<Listed> chain_;            ///< of all strings
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
