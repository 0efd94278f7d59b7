#include "convex/sets/subdifferential.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/cones/cone_operations.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/proved_prox/entry_formulas.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex {
namespace {

ExactVector exact_row(const ExactRow& row, std::size_t n) {
  Fractions entries(n);
  for (const auto& [j, value] : row) entries[j] = value;
  return exact_vector(entries);
}

/// All v = s (Hξ + c)_x - (Gᵀlambda)_x with lambda >= 0 on the rows that touch and nothing left in w: a cone
/// of (v, s), of which s = 1 is meant.
ExactPolyhedron of_program(const ExactProgram& f, const Fractions& x) {
  const auto at = graph_point_at(f, x);
  if (!at) return empty_polyhedron(f.n);
  std::vector<std::size_t> touching;
  for (std::size_t a = 0; a < f.rows.size(); ++a)
    if (dot(f.rows[a].row, at->xi) == f.rows[a].limit) touching.push_back(a);
  const std::size_t m = touching.size(), columns = m + 1;  // lambda, then s
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

Subdifferential of_polyhedron(ExactPolyhedron P, bool is_exact) {
  Subdifferential made;
  made.n = P.n;
  made.is_exact = is_exact;
  if (!P.is_empty()) made.set = as_set(P);
  made.polyhedron = std::move(P);
  return made;
}

Subdifferential single(const Fractions& v, bool is_exact) {
  ExactPolyhedron P = empty_polyhedron(v.size());
  P.vertices.push_back(v);
  for (std::size_t i = 0; i < v.size(); ++i) {
    IntegerVector unit(v.size());
    unit[i] = v[i].denominator;
    P.equations.push_back({std::move(unit), v[i].numerator});
  }
  return of_polyhedron(std::move(P), is_exact);
}

Subdifferential ray(const Fractions& direction) {
  const ExactVector d = exact_vector(direction);
  return of_polyhedron(polyhedron_of(generated_cone({d}, {}, d.size())), true);
}

Subdifferential of_set(Set set, std::size_t n) {
  Subdifferential made;
  made.n = n;
  made.set = std::move(set);
  made.is_exact = true;
  return made;
}

/// The root of a positive fraction, rounded, also of one that no double is near.
Fraction norm_rounded(Fraction square) {
  constexpr double step = 0x1p+400, least = 0x1p-900;
  const Fraction factor = fraction(step), inverse = Fraction{1} / factor;
  Fraction scale{1};
  for (; std::isinf(nearest_double(square)); scale = scale * factor) square = square * inverse * inverse;
  for (; nearest_double(square) < least; scale = scale * inverse) square = square * factor * factor;
  return fraction(std::sqrt(nearest_double(square))) * scale;
}

/// The Euclidean norm and its ball, and the second-order cone; none of other names.
std::optional<Subdifferential> of_round_set(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  const std::size_t n = x.size();
  if (f.name == "norm2") {
    const Fraction square = pairs::square_of(x), weight = a.number("weight");
    if (sign(square) == 0) return of_set(ball2(nearest_double(weight)), n);
    return single(pairs::multiple_of(weight / norm_rounded(square), x), false);
  }
  if (f.name == "ball2") {
    const Fractions d = difference(x, a.vector("center"));
    const Fraction left = a.number("radius") * a.number("radius") - pairs::square_of(d);
    if (sign(left) < 0) return of_polyhedron(empty_polyhedron(n), true);
    return sign(left) > 0 ? single(Fractions(n), true) : ray(d);
  }
  if (f.name == "second_order_cone") {
    Fractions normal = x;
    normal.back() = -x.back();
    const Fraction left = x.back() * x.back() - pairs::square_of({x.begin(), x.end() - 1});
    if (sign(x.back()) < 0 || sign(left) < 0) return of_polyhedron(empty_polyhedron(n), true);
    if (sign(left) > 0) return single(Fractions(n), true);
    if (sign(x.back()) > 0) return ray(normal);
  }
  return std::nullopt;
}

/// Of a separable function with formulas: one slope each, the whole line where the domain is one number,
/// nothing where the slope is vertical or the entry outside.
std::optional<Subdifferential> of_entries(const Call& f, const Fractions& x) {
  const auto entries = entry_formulas(f, x.size());
  if (entries.empty() || !Ball::why_none().empty()) return std::nullopt;
  ExactPolyhedron P = empty_polyhedron(x.size());
  Fractions vertex(x.size());
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
      vertex[i] = fraction(nearest_double(*v));
      unit[i] = vertex[i].denominator;
      P.equations.push_back({unit, vertex[i].numerator});
    } else {
      return of_polyhedron(empty_polyhedron(x.size()), true);
    }
  }
  P.vertices.push_back(std::move(vertex));
  return of_polyhedron(std::move(P), false);
}

/// A gradient in doubles, of a function that is finite and differentiable everywhere.
std::optional<Subdifferential> of_gradient(const Call& f, const ExactGram& W, const Fractions& x) {
  const Function made = make_function(f, {rounded(W)});
  if (!made.facts().smooth || !made.facts().finite) return std::nullopt;
  const auto v = made.subgradient(nearest(x));
  if (!v || !v->allFinite()) return std::nullopt;
  return single(fractions(*v), false);
}

Call sum_call(const std::vector<const Call*>& parts) {
  Call sum{"sum"};
  for (const Call* part : parts) sum.arguments.push_back(argument(*part));
  return sum;
}

/// Parts with programs as one, the others differentiable: ∂(f + g)(x) = ∂f(x) + g'(x) (Rockafellar 1970,
/// theorem 23.8).
std::optional<Subdifferential> of_sum(const Call& f, const ExactGram& W, const Fractions& x) {
  std::vector<const Call*> programs;
  Fractions gradient(x.size());
  for (const Call* part : ExactArguments(f, x.size()).calls()) {
    if (exact_program(*part, W)) {
      programs.push_back(part);
      continue;
    }
    const Subdifferential one = subdifferential(*part, W, x);
    if (one.is_empty()) return one;
    if (!one.is_single()) return std::nullopt;
    gradient = pairs::sum_of(gradient, one.polyhedron->vertices.front());
  }
  if (programs.empty()) return single(gradient, false);
  ExactPolyhedron P = of_program(*exact_program(sum_call(programs), W), x);
  return of_polyhedron(P.is_empty() ? P : translated(std::move(P), gradient), false);
}

}  // namespace

Subdifferential subdifferential(const Call& f, const ExactGram& W, const Fractions& x) {
  if (const auto program = exact_program(f, W)) return of_polyhedron(of_program(*program, x), true);
  if (f.name == "indicator") return subdifferential(ExactArguments(f, x.size()).call("set"), W, x);
  if (auto found = of_round_set(f, x)) return std::move(*found);
  if (f.name == "sum")
    if (auto found = of_sum(f, W, x)) return std::move(*found);
  if (auto found = of_entries(f, x)) return std::move(*found);
  if (auto found = of_gradient(f, W, x)) return std::move(*found);
  throw InvalidInput(f.name +
                     ": no rule gives its subdifferential as a set; give a piecewise linear-quadratic or "
                     "differentiable function, norm2, ball2, second_order_cone, or a sum with one such part");
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
  return set->indicator.conjugate()(nearest(d));
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
  if (!normal.contains(v)) throw InvalidInput("critical cone: the covector is no normal at the point");
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

}  // namespace convex
