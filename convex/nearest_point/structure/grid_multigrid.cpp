#include "convex/nearest_point/structure/grid_multigrid.hpp"

#include <cmath>

#include "convex/kernels/clones.hpp"

namespace convex {
namespace {

/// Steps that damp the part 0.5 … 2 of the spectrum of A/d most (Chebyshev of degree two).
constexpr double first_weight = 1 / (1.25 + 0.75 * 0.70710678118654752),
                 second_weight = 1 / (1.25 - 0.75 * 0.70710678118654752);
constexpr Index smallest = 3, most_steps = 200;
/// Sweeps that solve the coarsest grid well enough.
constexpr int coarsest_sweeps = 12;

MOREAU_CLONES
void apply_row(Index n, Index stride, double d, double c, const double* free, const double* u,
               double* __restrict out) {
  for (Index i = 0; i < n; ++i)
    out[i] = free[i] * (d * u[i] - c * ((u[i - 1] + u[i + 1]) + (u[i - stride] + u[i + stride])));
}

MOREAU_CLONES
void relax_row(Index n, double weight, const double* free, const double* r, const double* Au,
               double* __restrict u) {
  for (Index i = 0; i < n; ++i) u[i] += weight * free[i] * (r[i] - Au[i]);
}

void relax(const GridOperator& A, double weight, const Vector& r, Vector& Au, Vector& u) {
  apply(A, u, Au);
  relax_row(A.size(), weight / A.d, A.free.data(), r.data(), Au.data(), u.data());
}

}  // namespace

void apply(const GridOperator& A, const Vector& u, Vector& out) {
  for (Index j = 0; j < A.height; ++j) {
    const Index k = A.at(0, j);
    apply_row(A.width, A.stride(), A.d, A.c, A.free.data() + k, u.data() + k, out.data() + k);
  }
}

GridOperator coarsened(const GridOperator& fine) {
  GridOperator coarse{fine.width / 2, fine.height / 2, 4 * fine.c + 4 * (fine.d - 4 * fine.c), fine.c, {}};
  coarse.free = coarse.field();
  for (Index j = 0; j < coarse.height; ++j)
    for (Index i = 0; i < coarse.width; ++i)
      coarse.free[coarse.at(i, j)] = fine.free[fine.at(2 * i + 1, 2 * j + 1)];
  return coarse;
}

void interpolate(const GridOperator& coarse, const Vector& from, const GridOperator& fine, Vector& to) {
  // Coarse point i lies on fine point 2i + 1; those between are means.
  for (Index j = 0; j < fine.height; ++j) {
    const Index below = j / 2 - 1 + j % 2, above = j / 2;  // the coarse rows that row j is the mean of
    for (Index i = 0; i < fine.width; ++i) {
      const Index left = i / 2 - 1 + i % 2, right = i / 2;
      const auto value = [&](Index x, Index y) {
        return x < coarse.width && y < coarse.height ? from[coarse.at(x, y)] : 0.0;
      };
      to[fine.at(i, j)] =
          0.25 * ((value(left, below) + value(right, below)) + (value(left, above) + value(right, above)));
    }
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

GridMultigrid::GridMultigrid(const GridOperator& finest) {
  levels_.push_back(finest);
  while (std::min(levels_.back().width, levels_.back().height) > smallest)
    levels_.push_back(coarsened(levels_.back()));
  for (const GridOperator& level : levels_) {
    u_.push_back(level.field());
    r_.push_back(level.field());
    rest_.push_back(level.field());
  }
}

void GridMultigrid::set_free(const Vector& free) {
  levels_.front().free = free;
  for (std::size_t k = 1; k < levels_.size(); ++k) levels_[k].free = coarsened(levels_[k - 1]).free;
}

void GridMultigrid::cycle(std::size_t level) {
  const GridOperator& A = levels_[level];
  Vector &u = u_[level], &r = r_[level], &rest = rest_[level];
  // One step of Jacobi's method from 0.
  u = (first_weight / A.d) * A.free.cwiseProduct(r);
  if (level + 1 == levels_.size()) {
    relax(A, second_weight, r, rest, u);
    for (int k = 1; k < coarsest_sweeps; ++k) {
      relax(A, first_weight, r, rest, u);
      relax(A, second_weight, r, rest, u);
    }
    for (int k = 0; k < coarsest_sweeps; ++k) {
      relax(A, second_weight, r, rest, u);
      relax(A, first_weight, r, rest, u);
    }
    return;
  }
  relax(A, second_weight, r, rest, u);
  apply(A, u, rest);
  rest = A.free.cwiseProduct(r - rest);
  restrict_to(A, rest, levels_[level + 1], r_[level + 1]);
  r_[level + 1].array() *= levels_[level + 1].free.array();
  cycle(level + 1);
  interpolate(levels_[level + 1], u_[level + 1], A, rest);
  u += A.free.cwiseProduct(rest);
  rest.setZero();
  relax(A, second_weight, r, rest, u);
  relax(A, first_weight, r, rest, u);
}

double GridMultigrid::solve(const Vector& right, double part, Vector& u) {
  const GridOperator& A = levels_.front();
  Vector r = A.free.cwiseProduct(right), p = A.field(), Ap = A.field();
  u = A.field();
  double energy = 0, previous = 0;
  const double first = r.norm();
  for (Index k = 0; k < most_steps && first > 0; ++k) {
    r_.front() = r;
    cycle(0);
    const double product = r.dot(u_.front());
    p *= k == 0 ? 0 : product / previous;
    p += u_.front();
    apply(A, p, Ap);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0) || !(product > 0)) break;
    const double step = product / curvature;
    u += step * p;
    r -= step * Ap;
    energy += step * product;
    previous = product;
    ++steps_;
    if (r.norm() <= part * first) break;
  }
  return std::sqrt(energy);
}

}  // namespace convex
