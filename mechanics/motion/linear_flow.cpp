#include "mechanics/motion/linear_flow.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "convex/linear_algebra/complete_orthogonal.hpp"

namespace mechanics::inline motions {
namespace {

using convex::Index;
using convex::Matrix;

/// Gauss' points in a piece; with so many, what a piece leaves out falls with the 17th power of its length.
constexpr int points_of_piece = 8;

/// X is known when halves of the piece change it by less than this part.
constexpr double part_left_open = 1e-13;
constexpr int most_halvings_of_piece = 12;

/// The points c_i in (0, 1), and a_ij = ∫ from 0 to c_i, b_j = ∫ from 0 to 1 of Lagrange's polynomials on
/// them.
struct GaussPoints {
  std::array<double, points_of_piece> c, b;
  std::array<std::array<double, points_of_piece>, points_of_piece> a;

  GaussPoints() {
    std::array<double, points_of_piece> weight;
    for (int i = 0; i < points_of_piece; ++i) {
      // Zeros of Legendre's polynomial by Newton's method, from Tricomi's estimate.
      double x = -std::cos(std::numbers::pi * (i + 0.75) / (points_of_piece + 0.5)), slope = 0;
      constexpr int enough_steps = 8;
      for (int step = 0; step < enough_steps; ++step) {
        double p = 1, before = 0;
        for (int k = 1; k <= points_of_piece; ++k) {
          const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
          before = p;
          p = next;
        }
        slope = points_of_piece * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      c[at(i)] = 0.5 * (1 + x);
      weight[at(i)] = 1 / ((1 - x * x) * slope * slope);
    }
    b = weight;
    for (int i = 0; i < points_of_piece; ++i)
      for (int j = 0; j < points_of_piece; ++j) {
        a[at(i)][at(j)] = 0;
        for (int k = 0; k < points_of_piece; ++k)
          a[at(i)][at(j)] += c[at(i)] * weight[at(k)] * lagrange(j, c[at(i)] * c[at(k)]);
      }
  }

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  double lagrange(int j, double x) const {
    double product = 1;
    for (int k = 0; k < points_of_piece; ++k)
      if (k != j) product *= (x - c[at(k)]) / (c[at(j)] - c[at(k)]);
    return product;
  }
};

Matrix piece(const std::function<Matrix(double)>& J, double from, double to) {
  static const GaussPoints gauss;
  const double h = to - from;
  std::vector<Matrix> rate;
  for (const double c : gauss.c) rate.push_back(J(from + c * h));
  const Index n = rate.front().rows();
  // K_i = J_i (1 + h Σ a_ij K_j)
  Matrix system = Matrix::Identity(points_of_piece * n, points_of_piece * n);
  Matrix right(points_of_piece * n, n);
  for (int i = 0; i < points_of_piece; ++i) {
    const Matrix& of = rate[GaussPoints::at(i)];
    right.middleRows(i * n, n) = of;
    for (int j = 0; j < points_of_piece; ++j)
      system.block(i * n, j * n, n, n) -= h * gauss.a[GaussPoints::at(i)][GaussPoints::at(j)] * of;
  }
  const Matrix K = convex::linear_algebra::CompleteOrthogonal(system).solve_columns(right);
  Matrix X = Matrix::Identity(n, n);
  for (int i = 0; i < points_of_piece; ++i) X += h * gauss.b[GaussPoints::at(i)] * K.middleRows(i * n, n);
  return X;
}

Matrix refined(const std::function<Matrix(double)>& J, double from, double to, const Matrix& whole,
               int halvings) {
  const double middle = 0.5 * (from + to);
  const Matrix first = piece(J, from, middle), second = piece(J, middle, to), both = second * first;
  if (halvings == 0 || (both - whole).norm() <= part_left_open * both.norm()) return both;
  return refined(J, middle, to, second, halvings - 1) * refined(J, from, middle, first, halvings - 1);
}

}  // namespace

Matrix linear_flow(const std::function<Matrix(double)>& J, double length) {
  return refined(J, 0, length, piece(J, 0, length), most_halvings_of_piece);
}

}  // namespace mechanics::inline motions
