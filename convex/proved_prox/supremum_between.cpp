#include "convex/proved_prox/supremum_between.hpp"

#include <cmath>

#include "convex/composite/epigraph.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/nearest_point/solution.hpp"
#include "convex/proved_prox/proved_conjugate.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {
namespace {

/// A curved term's arguments at the points that its bounds touch it in.
using Touched = std::vector<Vector>;

Vector along(Index n, Index i, double sign) {
  Vector d = Vector::Zero(n);
  d[i] = sign;
  return d;
}

bool is_known(const Value& value) { return std::isfinite(value.value) && std::isfinite(value.error); }

/// A point of the graph of a function of one entry, its height rounded up.
struct OnGraph {
  Fraction u, height;
};

std::optional<OnGraph> on_graph(const FunctionNode& h, const Vector& u) {
  const Value value = h.evaluate(u);
  if (!is_known(value)) return std::nullopt;
  return OnGraph{fraction(u[0]), fraction(value.value) + fraction(value.error)};
}

/// Of one entry: the chords between û and the points beside it, so that what equations ask of u to the last
/// digit is near; and from the last points on the slopes of h∞.
std::optional<ExactProgram> chords(const FunctionNode& h, const Vector& touched) {
  constexpr double beside = 0x1p-22;  // of û: the chords are above h by a part of its square
  std::vector<OnGraph> points;
  for (const double side : {-1.0, 0.0, 1.0}) {
    const Vector u = touched + side * beside * touched.cwiseAbs();
    // Of an û that is subnormal, or 0, the points beside it are û itself.
    if (side != 0 && u == touched) continue;
    if (auto point = on_graph(h, u)) points.push_back(*point);
  }
  if (points.empty()) return std::nullopt;
  ExactProgram made(1, 1);
  made.c[1] = fraction(1);
  const auto hold_above = [&](const OnGraph& point, const Fraction& slope) {
    ExactRow row{{1, fraction(1)}};
    add(row, 0, -slope);
    made.bound(std::move(row), point.height - slope * point.u);
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    hold_above(points[i], (points[i + 1].height - points[i].height) / (points[i + 1].u - points[i].u));
  bool is_held = points.size() == 1;  // u to its one point
  for (const double side : {-1.0, 1.0}) {
    const OnGraph& last = side < 0 ? points.front() : points.back();
    const double slope = h.recession(along(1, 0, side));
    if (std::isnan(slope) || slope == -INFINITY) return std::nullopt;
    if (slope == INFINITY) {
      made.bound({{0, fraction(-side)}}, fraction(-side) * last.u);
    } else {
      hold_above(last, fraction(side) * fraction(slope));
      is_held = false;
    }
  }
  if (is_held) hold_above(points.front(), {});
  return made;
}

/// h(û) + Σ_i h∞(±e_i) (u_i - û_i)^±; none where h(û) is infinite or not known.
std::optional<ExactProgram> touching_above(const FunctionNode& h, const Touched& points) {
  const Vector& touched = points.front();
  if (touched.size() == 1) return chords(h, touched);
  const Value value = h.evaluate(touched);
  if (!is_known(value)) return std::nullopt;
  const Index n = touched.size();
  ExactProgram made(static_cast<std::size_t>(n), static_cast<std::size_t>(n));
  made.constant = fraction(value.value) + fraction(value.error);
  for (Index i = 0; i < n; ++i) {
    const auto u = static_cast<std::size_t>(i), rise = u + static_cast<std::size_t>(n);
    const Fraction at = fraction(touched[i]);
    made.c[rise] = fraction(1);
    bool is_bounded = false;
    for (const double side : {1.0, -1.0}) {
      const double slope = h.recession(along(n, i, side));
      if (std::isnan(slope) || slope == -INFINITY) return std::nullopt;
      if (slope == INFINITY) {
        made.bound({{u, fraction(-side)}}, fraction(-side) * at);
        continue;
      }
      is_bounded = true;
      ExactRow row{{rise, fraction(1)}};
      add(row, u, fraction(-side) * fraction(slope));
      made.bound(std::move(row), fraction(-side) * fraction(slope) * at);
    }
    if (!is_bounded) made.bound({{rise, fraction(1)}}, {});
  }
  return made;
}

/// The largest of the tangents at these points: v·u - h*(v) of one entry, so that no rounding of v counts,
/// and those far out beside them; h(û) + v·(u - û) of more.
std::optional<ExactProgram> touching_below(const FunctionNode& h, const Touched& points) {
  const Index n = points.front().size();
  ExactProgram made(static_cast<std::size_t>(n), 1);
  const auto height = static_cast<std::size_t>(n);
  made.c[height] = fraction(1);
  bool is_held = false;
  /// height >= v·u + least
  const auto hold_above = [&](const Vector& v, const Fraction& least) {
    is_held = true;
    ExactRow row{{height, fraction(1)}};
    for (Index i = 0; i < n; ++i) add(row, static_cast<std::size_t>(i), fraction(-v[i]));
    made.bound(std::move(row), least);
  };
  const auto hold_above_slope = [&](double slope) {
    const Vector v = Vector::Constant(1, slope);
    if (!v.allFinite()) return;
    if (const Value value = h.conjugate().evaluate(v); is_known(value))
      hold_above(v, -(fraction(value.value) + fraction(value.error)));
  };
  if (n == 1) {
    const double lowest = -h.recession(along(1, 0, -1)), highest = h.recession(along(1, 0, 1));
    for (const double slope : {lowest, highest}) hold_above_slope(slope);
    for (const double side : {1.0, -1.0})
      if (const double end = h.domain_support(along(1, 0, side)); std::isfinite(end))
        made.bound({{0, fraction(-side)}}, fraction(-end));
    for (const Vector& touched : points)
      if (const auto v = h.subgradient(touched); v && lowest < (*v)[0] && (*v)[0] < highest)
        hold_above_slope((*v)[0]);
  }
  for (std::size_t j = 0; n > 1 && j < points.size(); ++j) {
    const Vector& touched = points[j];
    const Value value = h.evaluate(touched);
    const auto v = h.subgradient(touched);
    if (!is_known(value) || !v || !v->allFinite()) continue;
    Fraction least = fraction(value.value) - fraction(value.error);
    for (Index i = 0; i < n; ++i) least = least - fraction((*v)[i]) * fraction(touched[i]);
    hold_above(*v, least);
  }
  return is_held ? std::optional(std::move(made)) : std::nullopt;
}

/// h itself as a program; none where it is curved.
std::optional<ExactProgram> as_it_is(const Atom& h, Index n) {
  if (const auto program = h.linear_quadratic(n)) return exact(*program);
  const auto form = h.quadratic_form(n);
  if (!form) return std::nullopt;
  return exact(LinearQuadratic{n, form->Q, form->c, form->constant, SparseRows(0, n), Vector(0), {}});
}

/// The constant beside the entries that h is a sum of; none where it is no such sum, or its constant is
/// rounded.
std::optional<double> beside_entries(const Atom& h) {
  if (!h.facts().separable || !h.entry(0)) return std::nullopt;
  const auto constant = h.constant_beside_entries();
  const bool is_exact = constant && std::isfinite(constant->value) && constant->error == 0;
  return is_exact ? std::optional(constant->value) : std::nullopt;
}

/// h itself where it is a program; else `touching` for it, entry by entry where it is a sum of these.
template <class Touching>
std::optional<ExactProgram> by_entries(const Atom& h, const Touched& points, const Touching& touching) {
  if (auto program = as_it_is(h, points.front().size())) return program;
  const auto constant = beside_entries(h);
  if (!constant) return touching(h, points);
  std::vector<ExactProgram> entries;
  for (Index i = 0; i < points.front().size(); ++i) {
    const auto of_entry = h.entry(i);
    if (!of_entry) return std::nullopt;
    Touched at;
    for (const Vector& u : points) at.push_back(Vector::Constant(1, u[i]));
    auto program = touching(of_entry->node(), at);
    if (!program) return std::nullopt;
    entries.push_back(*std::move(program));
  }
  ExactProgram made = exact_programs::separable(entries);
  made.constant = made.constant + fraction(*constant);
  return made;
}

/// A term, or a bound of it where it is curved: of an epigraph that of its function. None of other curved
/// sets.
template <class Touching>
std::optional<ExactProgram> in_pieces(const Atom& h, const Touched& points, const Touching& touching) {
  const auto epigraph = parts_of_epigraph(h);
  if (!epigraph) {
    const bool is_curved_set = h.facts().indicator && !h.facts().piecewise_quadratic;
    return is_curved_set ? std::nullopt : by_entries(h, points, touching);
  }
  const Index n = points.front().size() - 1;
  Touched at;
  for (const Vector& u : points) at.push_back(u.head(n));
  const auto of_function = by_entries(*epigraph->f, at, touching);
  const auto made = of_function ? exact_programs::epigraph(*of_function) : std::nullopt;
  if (!made) return std::nullopt;
  std::vector<ExactRow> sides;
  for (std::size_t i = 0; i < made->n; ++i) sides.push_back({{i, fraction(1)}});
  sides.back().begin()->second = fraction(epigraph->side);
  return exact_programs::precompose(*made, sides, Fractions(made->n), made->n);
}

/// f with its terms as `bound` makes them; its entries are x and w.
template <class Bound>
std::optional<ExactProgram> with_terms(const GraphForm& f, const Bound& bound) {
  const auto columns = static_cast<std::size_t>(f.n + f.k);
  std::vector<ExactProgram> terms{ExactProgram(columns, 0)};
  terms.front().constant = fraction(f.constant);
  for (const GraphTerm& term : f.terms) {
    auto program = bound(term);
    if (!program) return std::nullopt;
    std::vector<ExactRow> A(program->n);
    for (Index j = 0; j < term.M.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(term.M, j); entry; ++entry)
        add(A[static_cast<std::size_t>(entry.row())], static_cast<std::size_t>(j), fraction(entry.value()));
    terms.push_back(exact_programs::precompose(
        exact_programs::scale(*std::move(program), fraction(term.scale)), A, fractions(term.b), columns));
  }
  return exact_programs::sum(terms);
}

Vector argument(const GraphTerm& term, const Vector& xi) { return term.M * xi + term.b; }

/// The supremum over ξ, where it is attained, with the ξ.
std::optional<GraphPoint> supremum(const std::optional<ExactProgram>& f, const Fractions& v) {
  if (!f) return std::nullopt;
  const ExactProgram g = exact_programs::conjugate(*f);
  if (!(pair_operations(g, identity_gram(g.n)) <= quick_part_of_operations * most_word_operations))
    return std::nullopt;
  return graph_point_at(g, v);
}

/// What the roundings of the slopes at `points` may be of the supremum at xi, of terms of more than one
/// entry.
double roundings_of_slopes(const GraphForm& f, const std::vector<Vector>& points, const Vector& xi) {
  constexpr double roundings = 4;
  double sum = 0;
  for (const GraphTerm& term : f.terms) {
    const auto epigraph = parts_of_epigraph(*term.f);
    const Atom& h = epigraph ? *epigraph->f : *term.f;
    if (beside_entries(h) || h.facts().piecewise_quadratic) continue;
    const Vector u = argument(term, xi);
    for (const Vector& point : points) {
      const Vector touched = argument(term, point);
      if (const auto slope = h.subgradient(epigraph ? Vector(touched.head(touched.size() - 1)) : touched))
        sum += term.scale * slope->cwiseAbs().maxCoeff() * (u - touched).lpNorm<1>();
    }
  }
  return roundings * unit_roundoff * sum;
}

}  // namespace

std::optional<SupremumBetween> supremum_between(const GraphForm& f, const Vector& xi, const Fractions& v) {
  Fractions of_all = v;
  of_all.resize(static_cast<std::size_t>(f.n + f.k));
  const auto low = supremum(
      with_terms(
          f, [&](const GraphTerm& term) { return in_pieces(*term.f, {argument(term, xi)}, touching_above); }),
      of_all);
  if (!low) return std::nullopt;
  SupremumBetween found{low->f_x, std::nullopt};
  const Vector farther = nearest(low->v);
  if (!farther.allFinite()) return found;
  const auto high = supremum(
      with_terms(f,
                 [&](const GraphTerm& term) {
                   return in_pieces(*term.f, {argument(term, xi), argument(term, farther)}, touching_below);
                 }),
      of_all);
  if (!high) return found;
  const double rounding = roundings_of_slopes(f, {xi, farther}, nearest(high->v));
  if (!std::isfinite(rounding)) return found;
  if (const Fraction above = high->f_x + fraction(rounding); !(above < found.low)) found.high = above;
  return found;
}

}  // namespace convex::inline proved_prox
