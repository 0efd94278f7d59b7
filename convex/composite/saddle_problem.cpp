#include "convex/composite/saddle_problem.hpp"

#include <cmath>
#include <functional>
#include <limits>

namespace convex::inline composite {
namespace {

/// Compliances add along a row: D_r = 1 / sum_c M_rc² / stiffness_c, over the columns whose stiffness is
/// known; 0 when none is.
Vector row_stiffness(const SparseMatrix& M, const Vector& column) {
  Vector compliance = Vector::Zero(M.rows());
  for (Index c = 0; c < M.cols(); ++c) {
    if (!(column[c] > 0)) continue;
    for (SparseMatrix::InnerIterator entry(M, c); entry; ++entry)
      compliance[entry.row()] += entry.value() * entry.value() / column[c];
  }
  for (double& d : compliance)
    if (d > 0) d = 1 / d;
  return compliance;
}

/// One number for the rows of a term that is not separable: their geometric mean.
void level(Eigen::Ref<Vector> d) {
  if (d.size() > 0) d.setConstant(std::exp(d.array().log().mean()));
}

/// Gives every row and every auxiliary variable a scale, from those of x along M.
void set_scales(SaddleProblem& problem) {
  Vector column = Vector::Zero(problem.n + problem.k);
  column.head(problem.n) = problem.scales.middle_by_entry();
  Vector rows = row_stiffness(problem.M, column);
  const Vector from_x = rows;
  for (Index sweep = 0; sweep <= static_cast<Index>(problem.terms.size()) && problem.k > 0; ++sweep) {
    for (Index c = problem.n; c < column.size(); ++c) {
      double stiffness = 0;
      for (SparseMatrix::InnerIterator entry(problem.M, c); entry; ++entry)
        stiffness += entry.value() * entry.value() * rows[entry.row()];
      if (!(column[c] > 0)) column[c] = stiffness;
    }
    const Vector next = row_stiffness(problem.M, column);
    rows = (from_x.array() > 0).select(from_x, next);
  }
  problem.D = (rows.array() > 0).select(rows, Vector::Ones(problem.m));
  for (const SaddleTerm& term : problem.terms) {
    auto d = problem.D.segment(term.first, term.rows);
    if (term.separable) continue;
    bool plain = term.rows == problem.n && problem.n > 0;
    for (Index i = 0; plain && i < term.rows; ++i) plain = term.M.coeff(i, i) == 1;
    if (plain && term.M.nonZeros() == problem.n)
      d.setConstant(problem.scales.middle());
    else
      level(d);
  }
  for (double& d : problem.D) d = std::exp2(std::round(std::log2(d)));
  set_scales_of_w(problem);
}

/// Which terms give x first. A point that misses a set by rounding has the value +inf, and no other function
/// cares as much; but that of a term that is steep at an open end of its domain, as log x near 0, feels the
/// rounding of a much larger z, and an interval has room for such a point.
int rank_of(const SaddleTerm& term, const Look& look) {
  const Facts facts = term.f->facts();
  if (!look.by_steep_terms) return facts.indicator ? 0 : 1;
  if (facts.indicator) return term.separable ? 2 : 0;
  return facts.smooth && !facts.finite ? 1 : 3;
}

void set_pins(SaddleProblem& problem) {
  const SparseRows rows = problem.M;
  problem.pin.assign(static_cast<std::size_t>(problem.n), -1);
  Index pinned = 0;
  for (int rank = 0; rank <= 3; ++rank)
    for (const SaddleTerm& term : problem.terms) {
      if (rank_of(term, problem.look) != rank) continue;
      for (Index r = term.first; r < term.first + term.rows; ++r) {
        SparseRows::InnerIterator entry(rows, r);
        if (!entry || entry.value() != 1 || entry.col() >= problem.n) continue;
        const Index c = entry.col();
        if (++entry) continue;
        Index& pin = problem.pin[static_cast<std::size_t>(c)];
        if (pin >= 0) continue;
        pin = r;
        ++pinned;
      }
    }
  problem.all_pinned = problem.k == 0 && pinned == problem.m;
}

}  // namespace

void set_scales_of_w(SaddleProblem& problem) {
  problem.R = Vector::Zero(problem.k);
  for (Index c = 0; c < problem.k; ++c) {
    for (SparseMatrix::InnerIterator entry(problem.M, problem.n + c); entry; ++entry)
      problem.R[c] += entry.value() * entry.value() * problem.D[entry.row()];
    if (problem.Q.size() > 0) problem.R[c] += problem.Q(problem.n + c, problem.n + c);
    if (!(problem.R[c] > 0)) problem.R[c] = 1;
  }
}

void set_sparse_part(SaddleProblem& problem) {
  constexpr Index few_of = 8;
  const bool is_sparse = (problem.G.array() != 0).count() * few_of <= problem.G.size();
  problem.sparse_G = is_sparse ? SparseMatrix(problem.G.sparseView()) : SparseMatrix();
}

SaddleProblem saddle_problem(const GraphForm& f, const Vector& z, const Metric& W, const Look& look) {
  const Index size = f.n + f.k;
  SaddleProblem problem;
  problem.look = look;
  problem.n = f.n;
  problem.k = f.k;
  problem.W = W;
  problem.scales = metric_scales(W);
  problem.z = z;
  problem.c = Vector::Zero(size);
  problem.G = Matrix::Zero(size, size);
  problem.G.topLeftCorner(f.n, f.n) = gram(W);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<const Vector*> shifts;
  for (const GraphTerm& term : f.terms) {
    const Index rows = term.M.rows();
    if (const auto form = term.f->quadratic_form(rows)) {
      problem.c += term.scale * (term.M.transpose() * Vector(form->Q * term.b + form->c));
      if (form->Q.nonZeros() == 0) continue;
      if (problem.Q.size() == 0) problem.Q = Matrix::Zero(size, size);
      const SparseMatrix image = form->Q * term.M;
      problem.Q += term.scale * Matrix(term.M.transpose() * image);
      continue;
    }
    for (Index c = 0; c < term.M.outerSize(); ++c)
      for (SparseMatrix::InnerIterator entry(term.M, c); entry; ++entry)
        if (entry.value() != 0) entries.emplace_back(problem.m + entry.row(), c, entry.value());
    SaddleTerm added{term.f, term.scale, problem.m, rows, term.M, term.f->facts().separable};
    added.M.prune([](Index, Index, double value) { return value != 0; });
    problem.terms.push_back(std::move(added));
    shifts.push_back(&term.b);
    problem.m += rows;
  }
  if (problem.Q.size() > 0) problem.G += problem.Q;
  set_sparse_part(problem);
  problem.M.resize(problem.m, size);
  problem.M.setFromTriplets(entries.begin(), entries.end());
  problem.b.resize(problem.m);
  for (std::size_t j = 0; j < shifts.size(); ++j)
    problem.b.segment(problem.terms[j].first, problem.terms[j].rows) = *shifts[j];
  set_scales(problem);
  set_pins(problem);
  return problem;
}

namespace {

double largest_miss(const SaddleProblem& problem, const SaddlePoint& point, double around,
                    const std::function<bool(const SaddleTerm&)>& counts) {
  const SparseRows rows = problem.M;
  double worst = 0;
  for (const SaddleTerm& term : problem.terms) {
    if (!term.f->facts().indicator || !counts(term)) continue;
    for (Index i = term.first; i < term.first + term.rows; ++i) {
      double size = std::abs(problem.b[i]), largest = 0;
      for (SparseRows::InnerIterator entry(rows, i); entry; ++entry) {
        size += std::abs(entry.value() * point.xi[entry.col()]);
        largest = std::max(largest, std::abs(entry.value()));
      }
      size += largest * around;
      if (size > 0) worst = std::max(worst, std::abs(point.r[i]) / size);
    }
  }
  return worst;
}

}  // namespace

double largest_miss_of_rows(const SaddleProblem& problem, const SaddlePoint& point, double around) {
  return largest_miss(problem, point, around, [](const SaddleTerm& term) { return term.separable; });
}

double largest_miss_beyond_rounding(const SaddleProblem& problem, const SaddlePoint& point, double around) {
  constexpr double roundings = 64;
  const double rounding = roundings * unit_roundoff / membership_tolerance * around;
  return largest_miss(problem, point, rounding, [](const SaddleTerm&) { return true; });
}

Vector prox_of_terms(const SaddleProblem& problem, const Vector& t, const Vector& D) {
  Vector u(problem.m);
  for (const SaddleTerm& term : problem.terms) {
    const auto at = t.segment(term.first, term.rows);
    auto out = u.segment(term.first, term.rows);
    // A step too far out of the range of doubles is no point to ask a prox for.
    if (at.allFinite())
      out = term.f->prox_diagonal(at, D.segment(term.first, term.rows) / term.scale);
    else
      out.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return u;
}

Vector lagrangian_gradient(const SaddleProblem& problem, const Vector& xi, const Vector& t, const Vector& u,
                           const Vector& D) {
  const Index size = problem.n + problem.k;
  DoubleDoubleVector sum(problem.c);
  add_metric_difference(problem.W, xi.head(problem.n), problem.z, sum);
  if (problem.Q.size() > 0)
    for (Index c = 0; c < size; ++c)
      add_multiple(size, problem.Q.col(c).data(), {xi[c], 0}, sum.hi.data(), sum.lo.data());
  for (Index c = 0; c < size; ++c)
    for (SparseMatrix::InnerIterator entry(problem.M, c); entry; ++entry) {
      const Index row = entry.row();
      const DoubleDouble step = two_sum(t[row], -u[row]);
      add_multiple(1, &entry.value(), {D[row] * step.hi, D[row] * step.lo}, &sum.hi[c], &sum.lo[c]);
    }
  return sum.value();
}

Vector mismatch(const SaddleProblem& problem, const Vector& xi, const Vector& u) {
  DoubleDoubleVector sum(problem.b);
  sum.add(-u);
  for (Index c = 0; c < xi.size(); ++c)
    for (SparseMatrix::InnerIterator entry(problem.M, c); entry; ++entry)
      add_multiple(1, &entry.value(), {xi[c], 0}, &sum.hi[entry.row()], &sum.lo[entry.row()]);
  return sum.value();
}

double solution_size(const SaddleProblem& problem, const SaddlePoint& point) {
  const Vector root = problem.D.cwiseSqrt();
  return std::hypot(problem.W.norm(point.xi.head(problem.n)) + problem.W.norm(problem.z),
                    root.cwiseProduct(point.u).norm(), point.y.cwiseQuotient(root).norm());
}

SaddlePoint saddle_point(const SaddleProblem& problem, Vector xi, Vector t, const Vector& D) {
  SaddlePoint point;
  point.D = D;
  point.u = prox_of_terms(problem, t, D);
  point.y = D.cwiseProduct(t - point.u);
  for (Index i = 0; i < problem.n; ++i)
    if (const Index row = problem.pin[static_cast<std::size_t>(i)]; row >= 0)
      xi[i] = point.u[row] - problem.b[row];
  point.r = mismatch(problem, xi, point.u);
  for (const Index row : problem.pin)
    if (row >= 0) point.r[row] = 0;
  point.rho = lagrangian_gradient(problem, xi, t, point.u, D);
  const double x_part = problem.W.dual_norm(point.rho.head(problem.n));
  const double w_part = point.rho.tail(problem.k).cwiseQuotient(problem.R.cwiseSqrt()).norm();
  const double r_part = problem.D.cwiseSqrt().cwiseProduct(point.r).norm();
  point.residual = std::hypot(x_part, std::hypot(w_part, r_part));
  point.xi = std::move(xi);
  point.t = std::move(t);
  return point;
}

Vector own_covectors(const SaddleProblem& problem, const SaddlePoint& point) {
  Vector y = point.y;
  for (const SaddleTerm& term : problem.terms) {
    const Vector d = point.D.segment(term.first, term.rows) / term.scale;
    const Vector u = point.u.segment(term.first, term.rows), t = point.t.segment(term.first, term.rows);
    const auto own =
        problem.look.by_steep_terms ? term.f->steep_covector(u, t, d) : term.f->prox_covector(u, t, d);
    if (own) y.segment(term.first, term.rows) = term.scale * *own;
  }
  return y;
}

}  // namespace convex::inline composite
