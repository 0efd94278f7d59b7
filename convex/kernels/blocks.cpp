#include "convex/kernels/blocks.hpp"

namespace convex::kernels {

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

}  // namespace convex::kernels
