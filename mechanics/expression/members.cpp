#include "mechanics/expression/members.hpp"

#include <algorithm>
#include <limits>

namespace mechanics::expression {
namespace {

constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();

}  // namespace

bool precedes(Tuple x, Tuple y) {
  return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
}

Members::Members(std::uint32_t indices, std::vector<std::int64_t> tuples)
    : indices_(indices),
      size_(indices == 0 ? 1 : static_cast<std::uint32_t>(tuples.size() / indices)),
      tuples_(std::move(tuples)) {
  if (size_ == 0 || indices_ == 0) return;
  low_.assign((*this)[0].begin(), (*this)[0].end());
  high_ = low_;
  for (std::uint32_t m = 0; m < size_; ++m)
    for (std::uint32_t k = 0; k < indices_; ++k) {
      low_[k] = std::min(low_[k], (*this)[m][k]);
      high_[k] = std::max(high_[k], (*this)[m][k]);
    }
  double volume = 1;
  for (std::uint32_t k = 0; k < indices_; ++k)
    volume *= static_cast<double>(high_[k]) - static_cast<double>(low_[k]) + 1;
  if (volume > 4.0 * size_ + 1024) return;  // a table of the box would be mostly empty
  by_place_.assign(static_cast<std::size_t>(volume), absent);
  for (std::uint32_t m = 0; m < size_; ++m) by_place_[*in_box((*this)[m])] = m;
}

std::optional<std::size_t> Members::in_box(Tuple tuple) const {
  std::size_t place = 0;
  for (std::uint32_t k = 0; k < indices_; ++k) {
    if (tuple[k] < low_[k] || tuple[k] > high_[k]) return std::nullopt;
    place = place * static_cast<std::size_t>(high_[k] - low_[k] + 1) +
            static_cast<std::size_t>(tuple[k] - low_[k]);
  }
  return place;
}

std::optional<std::uint32_t> Members::find(Tuple tuple) const {
  if (indices_ == 0) return 0;
  if (size_ == 0) return std::nullopt;
  if (!by_place_.empty()) {
    const auto place = in_box(tuple);
    if (!place || by_place_[*place] == absent) return std::nullopt;
    return by_place_[*place];
  }
  std::uint32_t first = 0, last = size_;
  while (first < last) {
    const std::uint32_t middle = first + (last - first) / 2;
    if (precedes((*this)[middle], tuple))
      first = middle + 1;
    else
      last = middle;
  }
  const bool found = first < size_ && !precedes(tuple, (*this)[first]);
  return found ? std::optional(first) : std::nullopt;
}

std::string Members::range() const {
  std::string text;
  for (std::size_t k = 0; k < low_.size(); ++k)
    text += (k == 0 ? "" : ", ") + std::to_string(low_[k]) + ".." + std::to_string(high_[k]);
  return text;
}

std::string member_name(const std::string& family, Tuple tuple) {
  if (tuple.empty()) return family;
  std::string name = family + "[";
  for (std::size_t k = 0; k < tuple.size(); ++k) name += (k == 0 ? "" : ",") + std::to_string(tuple[k]);
  return name + "]";
}

}  // namespace mechanics::expression
