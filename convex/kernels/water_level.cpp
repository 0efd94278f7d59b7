#include "convex/kernels/water_level.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "convex/double_double.hpp"

namespace convex::kernels {

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

}  // namespace

double water_level(const Vector& point, const Vector& slope, double cap, double total) {
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
    height += static_cast<double>(capped > 0 ? capped : 0) * (capped > 0 ? cap : 0);
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
  const double missing = linear.rounded() + static_cast<double>(capped) * (capped > 0 ? cap : 0) - total;
  return std::clamp(base + missing / slopes, lo, hi);
}

}  // namespace convex::kernels
