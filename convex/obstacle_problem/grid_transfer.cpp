#include "convex/obstacle_problem/grid_transfer.hpp"

namespace convex::inline obstacle_problem {

void interpolate(const GridOperator& coarse, const Vector& from, const GridOperator& fine, Vector& to) {
  // Coarse point i lies on fine point 2i + 1; those between are means.
  Vector mean(coarse.width + 2);
  for (Index j = 0; j < fine.height; ++j) {
    const Index below = j / 2 - 1 + j % 2, above = std::min(j / 2, coarse.height);
    mean = 0.5 * (from.segment(coarse.at(-1, below), coarse.stride()) +
                  from.segment(coarse.at(-1, above), coarse.stride()));
    double* row = to.data() + fine.at(0, j);
    for (Index k = 0; 2 * k + 1 < fine.width; ++k) {
      row[2 * k] = 0.5 * (mean[k] + mean[k + 1]);
      row[2 * k + 1] = mean[k + 1];
    }
    if (fine.width % 2 == 1) row[fine.width - 1] = 0.5 * (mean[coarse.width] + mean[coarse.width + 1]);
  }
}

void restrict_to(const GridOperator& fine, const Vector& from, const GridOperator& coarse, Vector& to) {
  const Index stride = fine.stride();
  for (Index j = 0; j < coarse.height; ++j)
    for (Index i = 0; i < coarse.width; ++i) {
      const double* r = from.data() + fine.at(2 * i + 1, 2 * j + 1);
      to[coarse.at(i, j)] = r[0] + 0.5 * ((r[-1] + r[1]) + (r[-stride] + r[stride])) +
                            0.25 * ((r[-stride - 1] + r[-stride + 1]) + (r[stride - 1] + r[stride + 1]));
    }
}

}  // namespace convex::inline obstacle_problem
