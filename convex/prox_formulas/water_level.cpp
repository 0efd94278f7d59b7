#include "convex/prox_formulas/water_level.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "convex/double_double.hpp"

namespace convex::prox_formulas {

namespace {

/// A number whose terms cancel, summed in twice the working precision.
struct Sum {
  DoubleDouble value;
  void operator+=(double term) {
    const DoubleDouble s = two_sum(value.hi, term);
    value = {s.hi, value.lo + s.lo};
  }
  double rounded() const { return value.value(); }
};

struct Item {
  double full, none;  // cap up to `full`, zero from `none` on
  double slope;
};

/// The level without a cap: any set S of terms gives (Σ_S slope point - total)/Σ_S slope <= level, so what
/// lies below that can be dropped, again and again (Michelot 1986). Points are measured from the largest.
double uncapped_level(const Vector& point, const Vector& slope, double total) {
  Index highest = 0;
  const double top = point.maxCoeff(&highest);
  const auto n = static_cast<std::size_t>(point.size());
  std::vector<double> below(n), weight(n);
  double bound = -total / slope[highest], moment = 0, weights = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Index>(i);
    const double b = point[k] - top;
    const bool above = b > bound;  // a coin's toss, so no branch
    below[count] = b;
    weight[count] = slope[k];
    count += above;
    moment += above ? slope[k] * b : 0;
    weights += above ? slope[k] : 0;
    constexpr std::size_t block = 256;  // terms between two divisions
    if (i % block == block - 1 && count > 0) bound = std::max(bound, (moment - total) / weights);
  }
  for (std::size_t last = n + 1; count > 0 && count < last;) {
    bound = std::max(bound, (moment - total) / weights);
    last = count;
    count = 0;
    moment = weights = 0;
    for (std::size_t i = 0; i < last; ++i) {
      const double b = below[i], w = weight[i];
      const bool above = b > bound;
      below[count] = b;
      weight[count] = w;
      count += above;
      moment += above ? w * b : 0;
      weights += above ? w : 0;
    }
  }
  if (count == 0) return top + bound;  // total is so small that its share underflows
  Sum exact;
  exact += -total;
  for (std::size_t i = 0; i < count; ++i) exact += weight[i] * below[i];
  return top + exact.rounded() / weights;
}

}  // namespace

double water_level(const Vector& point, const Vector& slope, double cap, double total) {
  if (!(cap < std::numeric_limits<double>::infinity())) return uncapped_level(point, slope, total);
  std::vector<Item> open;
  open.reserve(static_cast<std::size_t>(point.size()));
  for (Index i = 0; i < point.size(); ++i) open.push_back({point[i] - cap / slope[i], point[i], slope[i]});
  double lo = -std::numeric_limits<double>::infinity(), hi = -lo;
  Index capped = 0;        // at cap over the whole bracket
  double slopes = 0;       // of those that are linear over the whole bracket
  double base = 0;         // what their points are measured from: any level in the first bracket
  Sum linear;              // Σ slope (point - base)
  std::uint32_t draw = 1;  // any deterministic sequence that no data is likely to follow
  const auto at = [&](double level) {
    Sum height;
    height += static_cast<double>(capped) * cap;
    height += linear.rounded();
    height += slopes * (base - level);
    for (const Item& item : open)
      if (level < item.none) height += level <= item.full ? cap : item.slope * (item.none - level);
    return height.rounded();
  };
  while (!open.empty()) {
    draw = draw * 1664525U + 1013904223U;
    const Item& chosen = open[static_cast<std::size_t>((std::uint64_t{draw} * open.size()) >> 32)];
    const bool upper = chosen.none > lo && chosen.none < hi && ((draw & 0x8000U) || !(chosen.full > lo));
    const double level = upper                                  ? chosen.none
                         : chosen.full > lo && chosen.full < hi ? chosen.full
                                                                : chosen.none;
    if (slopes <= 0) base = level;
    (at(level) > total ? lo : hi) = level;
    const auto decided = [&](const Item& item) {
      if (item.none <= lo) return true;
      if (item.full >= hi) {
        ++capped;
        return true;
      }
      if (item.full > lo || item.none < hi) return false;
      slopes += item.slope;
      linear += item.slope * (item.none - base);
      return true;
    };
    open.erase(std::remove_if(open.begin(), open.end(), decided), open.end());
  }
  if (!(slopes > 0)) return hi < std::numeric_limits<double>::infinity() ? hi : lo;
  const double missing = linear.rounded() + static_cast<double>(capped) * cap - total;
  return std::clamp(base + missing / slopes, lo, hi);
}

}  // namespace convex::prox_formulas
