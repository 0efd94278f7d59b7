#include "mechanics/motion/step_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics {

int taylor_order(double tolerance) {
  constexpr int least = 8, most = 28;
  return std::clamp(static_cast<int>(std::ceil(-0.5 * std::log(tolerance) + 1)) + 2, least, most);
}

double step_length(const Arc& arc, const convex::Metric& A, double tolerance) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const Index last = arc.q.cols() - 1;
  Vector size(last + 1);
  for (Index k = 0; k <= last; ++k) size[k] = A.norm(arc.q.col(k));
  Index top = last;
  while (top > 0 && size[top] == 0) --top;
  if (2 * top <= last) return infinite;
  double length = infinite;
  for (const Index k : {top, top - 1}) {
    if (size[k] == 0) continue;
    double longest = 0;
    for (Index j = 1; j < k; ++j)
      longest =
          std::max(longest, std::pow(tolerance * (size[j] / size[k]), 1.0 / static_cast<double>(k - j)));
    length = std::min(length, longest);
  }
  return length;
}

}  // namespace mechanics
