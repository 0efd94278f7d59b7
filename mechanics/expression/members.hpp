#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mechanics::expression {

using Tuple = std::span<const std::int64_t>;  // the indices of a member

/// The members of a family in lexicographic order of their indices. A single thing has one, without indices.
class Members {
 public:
  Members() = default;
  /// `tuples` holds `indices` numbers per member, sorted, without repetition.
  Members(std::uint32_t indices, std::vector<std::int64_t> tuples);

  std::uint32_t indices() const { return indices_; }
  std::uint32_t size() const { return size_; }
  Tuple operator[](std::uint32_t member) const {
    return {tuples_.data() + std::size_t{member} * indices_, indices_};
  }
  std::optional<std::uint32_t> find(Tuple tuple) const;
  /// The least box around the members, if there are any: index k runs over low(k)..high(k).
  std::int64_t low(std::size_t k) const { return low_[k]; }
  std::int64_t high(std::size_t k) const { return high_[k]; }
  /// That box as text, "1..100, 1..3".
  std::string range() const;

 private:
  std::optional<std::size_t> in_box(Tuple tuple) const;
  std::uint32_t indices_ = 0, size_ = 1;
  std::vector<std::int64_t> tuples_, low_, high_;
  std::vector<std::uint32_t> by_place_;  // in the box, unless they are too scattered in it
};

/// "x[2,5]", or "x" without indices.
std::string member_name(const std::string& family, Tuple tuple);

/// Orders tuples of equal length lexicographically.
bool precedes(Tuple x, Tuple y);

}  // namespace mechanics::expression
