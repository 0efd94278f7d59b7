#include "convex/sets/subdifferential.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "convex/catalogue/catalogue.hpp"
#include "convex/composite/atom.hpp"
#include "convex/cones/cone_operations.hpp"
#include "convex/counted.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/entry_formulas.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/subdifferential_rules.hpp"

namespace convex::inline sets {
namespace {

ExactVector exact_row(const ExactRow& row, std::size_t n) {
  Fractions entries(n);
  for (const auto& [j, value] : row) entries[j] = value;
  return exact_vector(entries);
}

/// Whether the polyhedron may have more vertices than can be written down: those of a product of simplices,
/// one for each auxiliary variable, of the rows that touch with it. Three entries and fewer always do.
bool is_too_large(const ExactProgram& f, const std::vector<std::size_t>& touching) {
  constexpr double most_vertices = 2500;
  constexpr std::size_t space = 3;
  std::vector<int> with(f.variables());
  for (const std::size_t a : touching)
    for (const auto& [j, value] : f.rows[a].row) ++with[j];
  double vertices = 1;
  for (std::size_t j = f.n; j < f.variables(); ++j) vertices *= std::max(1, with[j]);
  return f.n > space && vertices > most_vertices;
}

/// All v = s (Hξ + c)_x - (Gᵀlambda)_x with lambda >= 0 on the rows that touch and nothing left in w: a cone
/// of (v, s), of which s = 1 is meant. None where it is too large.
std::optional<ExactPolyhedron> of_program(const ExactProgram& f, const Fractions& x) {
  const auto at = graph_point_at(f, x);
  if (!at) return empty_polyhedron(f.n);
  std::vector<std::size_t> touching;
  for (std::size_t a = 0; a < f.rows.size(); ++a)
    if (dot(f.rows[a].row, at->xi) == f.rows[a].limit) touching.push_back(a);
  const std::size_t m = touching.size(), columns = m + 1;  // lambda, then s
  if (is_too_large(f, touching)) return std::nullopt;
  std::vector<ExactRow> slope(f.variables());
  for (std::size_t i = 0; i < f.variables(); ++i) add(slope[i], m, f.c[i] + dot(f.H[i], at->xi));
  ExactRows halfspaces, equations, image_rows;
  for (std::size_t k = 0; k < m; ++k) {
    for (const auto& [j, value] : f.rows[touching[k]].row) add(slope[j], k, -value);
    if (!f.rows[touching[k]].two_sided) halfspaces.push_back(exact_row({{k, Fraction{-1}}}, columns));
  }
  halfspaces.push_back(exact_row({{m, Fraction{-1}}}, columns));
  for (std::size_t i = 0; i < f.variables(); ++i)
    (i < f.n ? image_rows : equations).push_back(exact_row(slope[i], columns));
  image_rows.push_back(exact_row({{m, Fraction{1}}}, columns));
  const PolyhedralCone weights = halfspace_cone(halfspaces, equations, static_cast<Index>(columns));
  return section_at_one(image(weights, image_rows));
}

/// Numbers beyond this, or nearer to 0 than its inverse, may have slopes that no double holds.
constexpr double ordinary = 1e30;

[[noreturn]] void refuse_slope(const Call& f, std::size_t i) {
  throw InvalidInput(f.name + ": its slope at entry " + std::to_string(i) +
                     " of the point is beyond all doubles; give a point where it is not");
}

/// Of a separable function with formulas: one slope each, the whole line where the domain is one number,
/// nothing where the slope is vertical or the entry outside.
std::optional<Subdifferential> of_entries(const Call& f, const Fractions& x) {
  const auto entries = entry_formulas(f, x.size());
  if (entries.empty() || !Ball::why_none().empty()) return std::nullopt;
  ExactPolyhedron P = empty_polyhedron(x.size());
  Fractions vertex(x.size());
  const bool is_finite = make_function(f, {Metric::identity(static_cast<Index>(x.size()))}).facts().finite;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const EntryFormula& entry = *entries[i];
    IntegerVector unit(x.size());
    unit[i] = 1;
    const bool is_one_number =
        sign(entry.into_domain(Fraction{1})) == 0 && sign(entry.into_domain(Fraction{-1})) == 0;
    const auto slope = entry.slope(x[i]);
    const auto v = slope ? near(*slope) : std::nullopt;
    if (is_one_number && sign(x[i]) == 0) {
      P.lines.push_back(unit);
    } else if (v) {
      const double rounded = nearest_double(*v);
      if (!std::isfinite(rounded)) refuse_slope(f, i);
      vertex[i] = fraction(rounded);
      unit[i] = vertex[i].denominator;
      P.equations.push_back({unit, vertex[i].numerator});
    } else {
      const double size = std::abs(nearest_double(x[i]));
      const bool is_ordinary = size >= 1 / ordinary && size <= ordinary;
      if (size > 0 && (!is_ordinary || is_finite)) refuse_slope(f, i);
      return subgradients::none(x.size());
    }
  }
  P.vertices.push_back(std::move(vertex));
  return subgradients::of_polyhedron(std::move(P), false);
}

}  // namespace

Subdifferential subdifferential(const Call& f, const ExactGram& W, const Fractions& x) {
  using namespace subgradients;
  if (x.size() != W.dimension())
    throw InvalidInput("x: " + counted(x.size(), "entry", "entries") + "; give " +
                       std::to_string(W.dimension()) + ", as many as the metric has");
  if (const auto program = exact_program(f, W)) {
    if (auto P = of_program(*program, x)) return of_polyhedron(std::move(*P), true);
    if (auto found = of_smooth_or_homogeneous(f, W, x)) return std::move(*found);
    throw InvalidInput(
        f.name +
        ": so many of its pieces meet at this point that the polyhedron of its subgradients has "
        "too many vertices; give a point at which fewer meet, or 0");
  }
  if (auto found = by_calculus(f, W, x)) return std::move(*found);
  if (auto found = of_curved_norm_or_set(f, x)) return std::move(*found);
  if (auto found = of_matrix_function(f, x)) return std::move(*found);
  if (auto found = of_three_entry_cone(f, x)) return std::move(*found);
  if (auto found = of_entries(f, x)) return std::move(*found);
  if (auto found = of_smooth_or_homogeneous(f, W, x)) return std::move(*found);
  throw InvalidInput(f.name +
                     ": no rule gives its subdifferential at this point as a set; "
                     "docs/subdifferentials.md lists the functions that have one");
}

bool Subdifferential::contains(const Fractions& v) const {
  if (polyhedron && is_exact) return convex::contains(*polyhedron, v);
  return set && set->indicator(nearest(v)) == 0;
}

double Subdifferential::support(const Fractions& d) const {
  if (polyhedron) {
    const auto value = support_of(*polyhedron, d);
    return value ? nearest_double(*value) : INFINITY;
  }
  const Vector at = nearest(d);
  const Value found =
      make_function(*support_function, {Metric::identity(static_cast<Index>(n))}).evaluate(at);
  if (found.error > membership_tolerance * std::max(at.norm(), std::abs(found.value)))
    throw InvalidInput("the support function of this subdifferential, " + to_text(*support_function) +
                       ", is not found to nine digits there; give a point of fewer digits");
  return found.value;
}

Vector Subdifferential::projection(const Vector& u, const Metric& V) const {
  if (polyhedron) {
    const ExactMinimum found = exact_prox(program_of(*polyhedron), exact_gram(V), fractions(u));
    if (found.at) return nearest(found.at->x);
  }
  return set->indicator.prox(u, V).x;
}

PolyhedralCone tangent_cone(const Subdifferential& normal) {
  if (!normal.polyhedron || normal.is_empty())
    throw InvalidInput(
        "tangent cone: the normal cone is empty or no polyhedron; give a point of a polyhedron");
  const ExactPolyhedron& N = *normal.polyhedron;
  const auto rows = [&](const IntegerRows& all) {
    ExactRows made;
    for (const IntegerVector& one : all) made.push_back({one, 1});
    return made;
  };
  return halfspace_cone(rows(N.rays), rows(N.lines), static_cast<Index>(N.n));
}

PolyhedralCone critical_cone(const Subdifferential& normal, const Fractions& v) {
  const PolyhedralCone T = tangent_cone(normal);
  if (!normal.contains(v))
    throw InvalidInput("critical cone: the covector is no normal at the point; give one of the normal cone");
  const ExactVector row = exact_vector(v);
  return intersection(T, halfspace_cone({}, {row}, T.n));
}

Fractions prox_derivative(const Call& f, const ExactGram& W, const Fractions& z, const Fractions& d) {
  const auto program = exact_program(f, W);
  if (!program)
    throw InvalidInput(f.name + ": not piecewise linear-quadratic; its prox has no derivative in fractions");
  const ExactMinimum at = exact_prox(*program, W, z);
  if (!at.at) throw InvalidInput(f.name + ": its prox is not found in fractions");
  ExactProgram bent(program->n, program->variables() - program->n);
  bent.H = program->H;
  for (std::size_t a = 0; a < program->rows.size(); ++a) {
    const ExactBound& row = program->rows[a];
    if (!(dot(row.row, at.at->xi) == row.limit)) continue;
    bent.rows.push_back({row.row, {}, row.two_sided || sign(at.at->lambda[a]) > 0});
  }
  const ExactMinimum moved = exact_prox(bent, W, d);
  if (!moved.at) throw InvalidInput(f.name + ": its derivative is not found in fractions");
  return moved.at->x;
}

Matrix prox_jacobian(const Function& f, const Vector& z, const Metric& W) {
  const auto* atom = dynamic_cast<const Atom*>(&f.node());
  const bool is_diagonal = W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal;
  if (atom == nullptr || !is_diagonal ||
      (!atom->takes_any_diagonal() && W.diagonal().minCoeff() != W.diagonal().maxCoeff()))
    throw InvalidInput("prox_jacobian: no formula for this function in this metric");
  if (z.size() != W.dimension())
    throw InvalidInput("prox_jacobian: the point and the metric differ in size; give one dimension");
  return atom->prox_jacobian(z, W.diagonal());
}

}  // namespace convex::inline sets
