#include "mechanics/liquid/hidden_values.hpp"

namespace mechanics::liquid {

Point middle_of(const Region& at) {
  Point x{};
  for (std::size_t i = 0; i < x.size(); ++i)
    if (const double twice = at[i].low + at[i].high; std::isfinite(twice)) x[i] = 0.5 * twice;
  return x;
}

double diagonal_squared(const Region& at, std::size_t d) {
  double sum = 0;
  for (std::size_t i = 0; i < d; ++i) sum += (at[i].high - at[i].low) * (at[i].high - at[i].low);
  return sum;
}

}  // namespace mechanics::liquid
