#include "convex/prox_formulas/blocks.hpp"

#include "convex/double_double.hpp"

namespace convex::prox_formulas {

Matrix blocks_jacobian(const Blocks& blocks, const Vector& d) {
  const Index n = blocks.x.size();
  Matrix J = Matrix::Zero(n, n);
  for (std::size_t k = 0; k < blocks.first.size(); ++k) {
    const Index first = blocks.first[k],
                length = (k + 1 < blocks.first.size() ? blocks.first[k + 1] : n) - first;
    const auto weights = d.segment(first, length);
    J.block(first, first, length, length).rowwise() = (weights / weights.sum()).transpose();
  }
  return J;
}

Vector blocks_covector(const Blocks& blocks, const Vector& z, const Vector& d, const Vector& sum_of_run) {
  const Index n = z.size();
  Vector y(n);
  for (std::size_t k = 0; k < blocks.first.size(); ++k) {
    const Index first = blocks.first[k], end = k + 1 < blocks.first.size() ? blocks.first[k + 1] : n;
    DoubleDouble lacks{-sum_of_run[static_cast<Index>(k)], 0};
    double weight = 0;
    for (Index i = first; i < end; ++i) {
      const DoubleDouble difference = two_sum(z[i], -blocks.x[i]);
      add_multiple(1, &d[i], difference, &lacks.hi, &lacks.lo);
      weight += d[i];
    }
    const double shift = lacks.value() / weight;
    for (Index i = first; i < end; ++i) y[i] = d[i] * add(two_sum(z[i], -blocks.x[i]), {-shift, 0}).value();
  }
  return y;
}

}  // namespace convex::prox_formulas
