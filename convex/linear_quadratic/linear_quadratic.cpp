#include "convex/linear_quadratic/linear_quadratic.hpp"

#include <string>

#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"

namespace convex::linear_quadratic {
namespace {

bool is_finite(const double* values, Index count) {
  return Eigen::Map<const Vector>(values, count).allFinite();
}

SparseRows stack(const SparseRows& upper, const SparseRows& lower) {
  SparseRows into(upper.rows() + lower.rows(), upper.cols());
  std::vector<Eigen::Triplet<double>> entries;
  const auto take = [&](const SparseRows& part, Index shift) {
    for (Index a = 0; a < part.rows(); ++a)
      for (SparseRows::InnerIterator it(part, a); it; ++it)
        entries.emplace_back(static_cast<int>(a + shift), static_cast<int>(it.col()), it.value());
  };
  take(upper, 0);
  take(lower, upper.rows());
  into.setFromTriplets(entries.begin(), entries.end());
  return into;
}

}  // namespace

void validate(const LinearQuadratic& f, const char* where) {
  const auto refuse = [&](const std::string& what) { throw InvalidInput(std::string(where) + ": " + what); };
  const Index N = f.variables();
  if (f.n < 0 || f.n > N) refuse("n is not between 0 and the number of variables; give one entry of c each");
  if (f.H.rows() != N || f.H.cols() != N) refuse("H does not fit c; make it square of the size of c");
  if (f.G.rows() != f.rows() || f.G.cols() != N) refuse("G does not fit h and c; give h.size() × c.size()");
  if (!f.c.allFinite() || !f.h.allFinite() || !std::isfinite(f.constant) ||
      !is_finite(f.H.valuePtr(), f.H.nonZeros()) || !is_finite(f.G.valuePtr(), f.G.nonZeros()))
    refuse("an entry is not finite; leave out a row without a bound");
  if ((SparseMatrix(f.H.transpose()) - f.H).norm() > 0) refuse("H is not symmetric; give its symmetric part");
  Index last = -1;
  for (Index a : f.two_sided) {
    if (a <= last || a >= f.rows()) refuse("two_sided is not an increasing list of rows");
    last = a;
  }
}

double objective(const LinearQuadratic& f, const Vector& xi) {
  DoubleDoubleVector slope(f.variables());
  for (Index j = 0; j < f.H.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(f.H, j); it; ++it)
      add_multiple(1, &it.value(), {0.5 * xi[j], 0}, &slope.hi[it.row()], &slope.lo[it.row()]);
  slope.add(f.c);
  const DoubleDouble sum = dot(xi.size(), xi.data(), slope.hi.data(), slope.lo.data());
  return add(sum, {f.constant, 0}).value();
}

LinearQuadratic substitute(const LinearQuadratic& f, Index n, const SparseMatrix& T, const Vector& s) {
  LinearQuadratic g;
  g.n = n;
  const SparseMatrix half = T.transpose() * f.H * T;
  g.H = 0.5 * (half + SparseMatrix(half.transpose()));
  g.H.prune(0.0);
  const Vector Hs = f.H * s;
  g.c = T.transpose() * (f.c + Hs);
  g.constant = objective(f, s);
  g.G = f.G * SparseRows(T);
  g.G.prune(0.0);
  g.h = f.h - f.G * s;
  g.two_sided = f.two_sided;
  return g;
}

LinearQuadratic add_joint(const LinearQuadratic& f, const LinearQuadratic& g) {
  LinearQuadratic sum;
  sum.n = f.n;
  sum.H = f.H + g.H;
  sum.c = f.c + g.c;
  sum.constant = f.constant + g.constant;
  sum.G = stack(f.G, g.G);
  sum.h.resize(f.rows() + g.rows());
  sum.h << f.h, g.h;
  sum.two_sided = f.two_sided;
  for (Index a : g.two_sided) sum.two_sided.push_back(f.rows() + a);
  return sum;
}

LinearQuadraticBuilder::LinearQuadraticBuilder(Index n, Index k) {
  form_.n = n;
  form_.c = Vector::Zero(n + k);
}

void LinearQuadraticBuilder::curve(Index i, Index j, double value) {
  H_.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
  if (i != j) H_.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
}

void LinearQuadraticBuilder::row(double bound) { h_.push_back(bound); }

void LinearQuadraticBuilder::equation(double bound) {
  form_.two_sided.push_back(static_cast<Index>(h_.size()));
  h_.push_back(bound);
}

void LinearQuadraticBuilder::entry(Index j, double value) {
  G_.emplace_back(static_cast<int>(h_.size()) - 1, static_cast<int>(j), value);
}

LinearQuadratic LinearQuadraticBuilder::finish() const {
  LinearQuadratic f = form_;
  const Index N = f.variables();
  f.H.resize(N, N);
  f.H.setFromTriplets(H_.begin(), H_.end());
  f.H.prune(0.0);
  f.h = Eigen::Map<const Vector>(h_.data(), static_cast<Index>(h_.size()));
  f.G.resize(f.rows(), N);
  f.G.setFromTriplets(G_.begin(), G_.end());
  f.G.prune(0.0);
  return f;
}

}  // namespace convex::linear_quadratic
