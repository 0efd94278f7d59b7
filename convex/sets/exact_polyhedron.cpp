#include "convex/sets/exact_polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/functions/sets.hpp"
#include "convex/invalid_input.hpp"
#include "convex/operations/operations.hpp"

namespace convex::inline sets {
namespace {

bool all_zero(const IntegerVector& v, std::size_t n) {
  return std::all_of(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(n),
                     [](const Integer& entry) { return entry.is_zero(); });
}

IntegerVector first_entries(const IntegerVector& v) { return {v.begin(), v.end() - 1}; }

void require_entries(const ExactPolyhedron& P, const Fractions& v) {
  if (v.size() != P.n)
    throw InvalidInput("polyhedron: a point of " + counted(v.size(), "entry", "entries") + "; give " +
                       std::to_string(P.n));
}

Fraction value_at(const IntegerVector& normal, const Fractions& v) {
  Fraction sum;
  for (std::size_t i = 0; i < v.size(); ++i) sum = sum + Fraction{normal[i]} * v[i];
  return sum;
}

/// The power of two that brings the largest entry of a row near 1 where its integers are those of rounded
/// numbers, of more than ten digits; else 1.
double scale_of(const IntegerVector& normal) {
  constexpr double most_plain = 1e10;
  double largest = 0;
  for (const Integer& entry : normal) largest = std::max(largest, std::abs(nearest_double(Fraction{entry})));
  return largest > most_plain && std::isfinite(largest) ? std::exp2(-std::floor(std::log2(largest))) : 1;
}

Matrix rows_in_doubles(const std::vector<ExactHalfspace>& rows, std::size_t n) {
  Matrix A(static_cast<Index>(rows.size()), static_cast<Index>(n));
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (std::size_t i = 0; i < n; ++i)
      A(static_cast<Index>(a), static_cast<Index>(i)) =
          scale_of(rows[a].normal) * nearest_double(Fraction{rows[a].normal[i]});
  return A;
}

Vector limits_in_doubles(const std::vector<ExactHalfspace>& rows) {
  Vector b(static_cast<Index>(rows.size()));
  for (std::size_t a = 0; a < rows.size(); ++a)
    b[static_cast<Index>(a)] = scale_of(rows[a].normal) * nearest_double(Fraction{rows[a].limit});
  return b;
}

}  // namespace

ExactPolyhedron empty_polyhedron(std::size_t n) {
  ExactPolyhedron P;
  P.n = n;
  return P;
}

ExactPolyhedron section_at_one(const PolyhedralCone& K) {
  const auto n = static_cast<std::size_t>(K.n) - 1;
  ExactPolyhedron P = empty_polyhedron(n);
  for (const IntegerVector& g : K.generators) {
    if (g.back().is_zero()) {
      P.rays.push_back(first_entries(g));
      continue;
    }
    Fractions vertex;
    for (std::size_t i = 0; i < n; ++i) vertex.push_back(lowest_terms({g[i], g.back()}));
    P.vertices.push_back(std::move(vertex));
  }
  for (const IntegerVector& l : K.lines) P.lines.push_back(first_entries(l));
  const Echelon space = echelon(K.equations, n + 1);
  for (const IntegerVector& row : K.halfspaces)
    if (const IntegerVector a = reduced(row, space); !all_zero(a, n))
      P.halfspaces.push_back({first_entries(a), -a.back()});
  for (const IntegerVector& e : K.equations)
    if (!all_zero(e, n)) P.equations.push_back({first_entries(e), -e.back()});
  return P;
}

ExactPolyhedron polyhedron_of(const PolyhedralCone& K) {
  ExactPolyhedron P = empty_polyhedron(static_cast<std::size_t>(K.n));
  P.vertices.emplace_back(P.n);
  P.rays = K.generators;
  P.lines = K.lines;
  for (const IntegerVector& a : K.halfspaces) P.halfspaces.push_back({a, 0});
  for (const IntegerVector& e : K.equations) P.equations.push_back({e, 0});
  return P;
}

bool contains(const ExactPolyhedron& P, const Fractions& v) {
  require_entries(P, v);
  if (P.is_empty()) return false;
  for (const ExactHalfspace& row : P.halfspaces)
    if (Fraction{row.limit} < value_at(row.normal, v)) return false;
  return std::all_of(P.equations.begin(), P.equations.end(), [&](const ExactHalfspace& row) {
    return value_at(row.normal, v) == Fraction{row.limit};
  });
}

std::optional<Fraction> support_of(const ExactPolyhedron& P, const Fractions& d) {
  require_entries(P, d);
  for (const IntegerVector& ray : P.rays)
    if (sign(value_at(ray, d)) > 0) return std::nullopt;
  for (const IntegerVector& line : P.lines)
    if (sign(value_at(line, d)) != 0) return std::nullopt;
  std::optional<Fraction> largest;
  for (const Fractions& vertex : P.vertices)
    if (const Fraction value = dot(vertex, d); !largest || *largest < value) largest = value;
  return largest;
}

ExactPolyhedron translated(ExactPolyhedron P, const Fractions& shift) {
  for (Fractions& vertex : P.vertices)
    for (std::size_t i = 0; i < P.n; ++i) vertex[i] = vertex[i] + shift[i];
  for (auto* rows : {&P.halfspaces, &P.equations})
    for (ExactHalfspace& row : *rows) {  // a·v <= b + a·shift, over one denominator
      const Fraction limit = lowest_terms(Fraction{row.limit} + value_at(row.normal, shift));
      for (Integer& entry : row.normal) entry *= limit.denominator;
      row.limit = limit.numerator;
    }
  return P;
}

namespace {

/// The polyhedron of these vertices, rays and lines.
ExactPolyhedron generated(const std::vector<Fractions>& vertices, const std::vector<Fractions>& rays,
                          const std::vector<Fractions>& lines, std::size_t n) {
  if (vertices.empty()) return empty_polyhedron(n);
  const auto with = [](const std::vector<Fractions>& all, int last) {
    ExactRows rows;
    for (Fractions one : all) {
      one.push_back(Fraction{last});
      rows.push_back(exact_vector(one));
    }
    return rows;
  };
  ExactRows generators = with(vertices, 1);
  for (ExactVector& ray : with(rays, 0)) generators.push_back(std::move(ray));
  return section_at_one(generated_cone(generators, with(lines, 0), static_cast<Index>(n + 1)));
}

Fractions as_fractions(const IntegerVector& v) {
  Fractions made;
  for (const Integer& entry : v) made.push_back({entry});
  return made;
}

std::vector<Fractions> as_fractions(const IntegerRows& rows) {
  std::vector<Fractions> made;
  for (const IntegerVector& row : rows) made.push_back(as_fractions(row));
  return made;
}

Fractions joined(Fractions v, const Fractions& w) {
  v.insert(v.end(), w.begin(), w.end());
  return v;
}

template <class Rows>
Rows both(Rows first, const Rows& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

ExactPolyhedron image(const ExactPolyhedron& P, const std::vector<ExactRow>& M) {
  const auto of = [&](const std::vector<Fractions>& all) {
    std::vector<Fractions> made;
    for (const Fractions& v : all) {
      made.emplace_back();
      for (const ExactRow& row : M) made.back().push_back(dot(row, v));
    }
    return made;
  };
  return generated(of(P.vertices), of(as_fractions(P.rays)), of(as_fractions(P.lines)), M.size());
}

ExactPolyhedron sum(const ExactPolyhedron& P, const ExactPolyhedron& Q) {
  if (P.is_point() && !Q.is_empty()) return translated(Q, P.vertices.front());
  if (Q.is_point() && !P.is_empty()) return translated(P, Q.vertices.front());
  std::vector<Fractions> vertices;
  for (const Fractions& v : P.vertices)
    for (const Fractions& w : Q.vertices) {
      vertices.push_back(v);
      for (std::size_t i = 0; i < P.n; ++i) vertices.back()[i] = v[i] + w[i];
    }
  return generated(vertices, as_fractions(both(P.rays, Q.rays)), as_fractions(both(P.lines, Q.lines)), P.n);
}

ExactPolyhedron product(const ExactPolyhedron& P, const ExactPolyhedron& Q) {
  ExactPolyhedron made = empty_polyhedron(P.n + Q.n);
  for (const Fractions& v : P.vertices)
    for (const Fractions& w : Q.vertices) made.vertices.push_back(joined(v, w));
  if (made.is_empty()) return made;
  const auto first = [&](IntegerVector v) {
    v.resize(made.n);
    return v;
  };
  const auto second = [&](const IntegerVector& w) {
    IntegerVector v(P.n);
    v.insert(v.end(), w.begin(), w.end());
    return v;
  };
  for (const auto part : {&ExactPolyhedron::rays, &ExactPolyhedron::lines}) {
    for (const IntegerVector& v : P.*part) (made.*part).push_back(first(v));
    for (const IntegerVector& w : Q.*part) (made.*part).push_back(second(w));
  }
  for (const auto part : {&ExactPolyhedron::halfspaces, &ExactPolyhedron::equations}) {
    for (const ExactHalfspace& row : P.*part) (made.*part).push_back({first(row.normal), row.limit});
    for (const ExactHalfspace& row : Q.*part) (made.*part).push_back({second(row.normal), row.limit});
  }
  return made;
}

ExactPolyhedron hull(const ExactPolyhedron& P, const ExactPolyhedron& Q) {
  return generated(both(P.vertices, Q.vertices), as_fractions(both(P.rays, Q.rays)),
                   as_fractions(both(P.lines, Q.lines)), P.n);
}

ExactPolyhedron intersection(const ExactPolyhedron& P, const ExactPolyhedron& Q) {
  ExactRows halfspaces, equations;
  const auto take = [&](const std::vector<ExactHalfspace>& rows, ExactRows& into) {
    for (const ExactHalfspace& row : rows) {
      IntegerVector entries = row.normal;
      entries.push_back(-row.limit);
      into.push_back({std::move(entries), 1});
    }
  };
  for (const ExactPolyhedron* one : {&P, &Q}) {
    take(one->halfspaces, halfspaces);
    take(one->equations, equations);
  }
  IntegerVector above(P.n + 1);
  above.back() = -1;
  halfspaces.push_back({std::move(above), 1});
  return section_at_one(halfspace_cone(halfspaces, equations, static_cast<Index>(P.n + 1)));
}

ExactProgram program_of(const ExactPolyhedron& P) {
  ExactProgram form(P.n, 0);
  for (const ExactHalfspace& row : P.halfspaces) {
    ExactRow entries;
    for (std::size_t i = 0; i < P.n; ++i) add(entries, i, Fraction{-row.normal[i]});
    form.bound(std::move(entries), Fraction{-row.limit});
  }
  for (const ExactHalfspace& row : P.equations) {
    ExactRow entries;
    for (std::size_t i = 0; i < P.n; ++i) add(entries, i, Fraction{row.normal[i]});
    form.equation(std::move(entries), Fraction{row.limit});
  }
  return form;
}

Set as_set(const ExactPolyhedron& P) {
  if (P.is_empty()) throw InvalidInput("polyhedron: empty; there is no set to be had");
  const auto n = static_cast<Index>(P.n);
  if (P.is_point()) {
    Vector p(n);
    for (Index i = 0; i < n; ++i) p[i] = nearest_double(P.vertices.front()[static_cast<std::size_t>(i)]);
    return point(p);
  }
  std::vector<Set> sets;
  if (!P.halfspaces.empty())
    sets.push_back(polyhedron(rows_in_doubles(P.halfspaces, P.n), limits_in_doubles(P.halfspaces)));
  if (!P.equations.empty())
    sets.push_back(affine(rows_in_doubles(P.equations, P.n), limits_in_doubles(P.equations)));
  if (sets.empty()) return box(Vector::Constant(n, -INFINITY), Vector::Constant(n, INFINITY));
  if (sets.size() == 1) return sets.front();
  Call both{"intersection"};
  for (const Set& one : sets) both.arguments.push_back(argument(one.call));
  return {intersection(sets, n), std::move(both)};
}

}  // namespace convex::inline sets
