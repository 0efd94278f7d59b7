#include "cli/drawing/label_column.hpp"

#include <algorithm>
#include <numeric>

namespace cli::inline drawings {

/// A block of labels that touch lies about the mean of what its members want (as in isotonic regression: the
/// positions less their places in the column must not decrease).
std::vector<double> label_positions(const std::vector<double>& wanted, double apart, double low,
                                    double high) {
  const std::size_t count = wanted.size();
  if (count == 0) return {};
  if (count > 1) apart = std::min(apart, (high - low) / static_cast<double>(count - 1));
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  struct Block {
    double sum;
    std::size_t size;
    double mean() const { return sum / static_cast<double>(size); }
  };
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < count; ++k) {
    blocks.push_back({wanted[order[k]] - apart * static_cast<double>(k), 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].mean() >= blocks.back().mean()) {
      const Block last = blocks.back();
      blocks.pop_back();
      blocks.back().sum += last.sum;
      blocks.back().size += last.size;
    }
  }
  std::vector<double> positions(count);
  std::size_t k = 0;
  const double highest = high - apart * static_cast<double>(count - 1);
  for (const Block& block : blocks)
    for (std::size_t i = 0; i < block.size; ++i, ++k)
      positions[order[k]] = std::clamp(block.mean(), low, highest) + apart * static_cast<double>(k);
  return positions;
}

}  // namespace cli::inline drawings
