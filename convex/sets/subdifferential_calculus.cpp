#include <algorithm>
#include <iterator>
#include <optional>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/known_value.hpp"
#include "convex/sets/subdifferential_rules.hpp"

namespace convex::inline sets::subgradients {
namespace {

[[noreturn]] void refuse(const Call& f, const std::string& why) {
  throw InvalidInput(f.name + ": no rule gives its subdifferential at this point as a set: " + why);
}

std::vector<ExactRow> multiple_of_identity(const Fraction& factor, std::size_t n) {
  std::vector<ExactRow> rows(n);
  for (std::size_t i = 0; i < n; ++i) add(rows[i], i, factor);
  return rows;
}

/// Whether the normals to the domains at x, which are the directions in which the subdifferentials have no
/// end, cancel in no sum but that of zeros. Not where one of them is no polyhedron.
bool only_zeros_cancel(const std::vector<Subdifferential>& parts) {
  std::optional<ExactPolyhedron> against;
  for (const Subdifferential& part : parts) {
    if (!part.polyhedron || part.polyhedron->is_empty()) return false;
    ExactPolyhedron cone = *part.polyhedron;
    cone.vertices = {Fractions(cone.n)};
    cone = image(cone, multiple_of_identity({1, 1}, cone.n));
    if (against && !intersection(cone, *against).is_point()) return false;
    const ExactPolyhedron opposite = image(cone, multiple_of_identity({-1, 1}, cone.n));
    against = against ? sum(*against, opposite) : opposite;
  }
  return true;
}

/// ∂(f + g) = ∂f + ∂g where all but one of them are finite around x (Rockafellar 1970, theorem 23.8), or only
/// zeros of the normals to their domains cancel (Rockafellar and Wets 1998, corollary 10.9). Parts with
/// programs count as one.
Subdifferential of_sum(const Call& f, const ExactGram& W, const Fractions& x) {
  std::vector<const Call*> programs;
  std::vector<Subdifferential> parts;
  const auto calls = ExactArguments(f, x.size()).calls();
  for (const Call* part : calls) {
    if (exact_program(*part, W))
      programs.push_back(part);
    else
      parts.push_back(subdifferential(*part, W, x));
  }
  if (!programs.empty()) {
    Call together{f.name};
    for (const Call* part : programs) together.arguments.push_back(argument(*part));
    parts.push_back(subdifferential(together, W, x));
  }
  const bool is_outside = std::any_of(calls.begin(), calls.end(),
                                      [&](const Call* part) { return known_value(*part, W, x).is_infinite; });
  if (is_outside) return none(x.size());
  const auto is_on_edge = [](const Subdifferential& part) { return part.is_empty() || !is_bounded(part); };
  std::vector<Subdifferential> on_edge;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(on_edge), is_on_edge);
  if (on_edge.size() > 1 && !only_zeros_cancel(on_edge))
    refuse(f,
           "x lies on the edge of two of its domains, one of them curved, and they may meet there alone, or "
           "touch; give a point off one of the edges");
  if (std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.is_empty(); }))
    return none(x.size());
  Subdifferential total = parts.front();
  for (std::size_t k = 1; k < parts.size(); ++k) total = sum(total, parts[k]);
  return total;
}

/// Aᵀ ∂f(Ax + b) where f is finite around Ax + b, or A is onto (theorem 23.9).
Subdifferential of_precompose(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  const std::vector<ExactRow> A = a.rows("A");
  Fractions at = a.is_vector("b") ? a.vector("b") : Fractions(A.size(), a.number("b"));
  for (std::size_t i = 0; i < A.size(); ++i) at[i] = at[i] + dot(A[i], x);
  const Subdifferential inner = subdifferential(a.call("f"), identity_gram(A.size()), at);
  if (known_value(a.call("f"), identity_gram(A.size()), at).is_infinite) return none(x.size());
  if (inner.is_empty() || !is_bounded(inner)) {
    IntegerRows rows;
    for (const ExactRow& row : A) {
      Fractions entries(x.size());
      for (const auto& [j, value] : row) entries[j] = value;
      rows.push_back(exact_vector(entries).numerators);
    }
    if (echelon(rows, x.size()).rank() < A.size())
      refuse(f, "Ax + b lies on the edge of the domain, and A is not onto; write the part as a polyhedron");
  }
  if (inner.is_empty()) return none(x.size());
  return transposed_image(inner, A, x.size());
}

Subdifferential of_blocks(const Call& f, const ExactGram& W, const Fractions& x) {
  std::vector<Subdifferential> parts;
  std::size_t first = 0;
  for (std::size_t k = 0; k + 1 < f.arguments.size(); k += 2) {
    const auto& part = std::get<std::shared_ptr<const Call>>(f.arguments[k].value);
    const auto n = static_cast<std::size_t>(std::get<double>(f.arguments[k + 1].value));
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(first);
    parts.push_back(
        subdifferential(*part, block(W, first, n), {begin, begin + static_cast<std::ptrdiff_t>(n)}));
    first += n;
  }
  return product(parts);
}

/// The convex hull of ∂f_i over the largest f_i, where all parts are finite around x (Dubovitskii and
/// Milyutin 1965).
Subdifferential of_maximum(const Call& f, const ExactGram& W, const Fractions& x) {
  std::vector<KnownValue> values;
  std::vector<Subdifferential> parts;
  const auto calls = ExactArguments(f, x.size()).calls();
  for (const Call* part : calls) {
    values.push_back(known_value(*part, W, x));
    if (values.back().is_infinite) return none(x.size());
    parts.push_back(subdifferential(*part, W, x));
    if (parts.back().is_empty() || !is_bounded(parts.back()))
      refuse(f, "x lies on the edge of the domain of a part; make the part finite around x");
  }
  std::vector<std::size_t> largest{0};
  for (std::size_t k = 1; k < values.size(); ++k) {
    const auto above = order(values[k], values[largest.front()]);
    if (!above)
      refuse(f, "whether " + calls[k]->name + " or " + calls[largest.front()]->name +
                    " is larger at x is not told by 512 bits, nor by their formulas; they may be equal");
    if (*above > 0) largest.clear();
    if (*above >= 0) largest.push_back(k);
  }
  std::vector<Subdifferential> active;
  for (const std::size_t k : largest) active.push_back(parts[k]);
  return hull(active);
}

Prox found_prox(const Call& f, const Function& made, const Vector& x, const Metric& W) {
  Prox found = made.prox(x, W);
  if (found.status != Status::solved) refuse(f, "its prox is not found to the accuracy that it aims at");
  return found;
}

/// (W/gamma)(x - prox x), the covector that the prox comes with: no difference of large numbers (Moreau 1965,
/// proposition 7.d).
Subdifferential of_envelope(const Call& f, const ExactGram& W, const Fractions& x) {
  const ExactArguments a(f, x.size());
  const Metric metric = rounded(W);
  const Function inner = make_function(a.call("f"), {metric});
  const double gamma = nearest_double(a.number("gamma"));
  return single(fractions(found_prox(f, inner, nearest(x), metric.scaled(1 / gamma)).v), false);
}

/// weight (N ∩ unit ball) at a point of the set, N its normals there: the support function is the distance to
/// the tangent cone. Elsewhere the direction from the nearest point.
Subdifferential of_distance(const Call& f, const Fractions& x) {
  const std::size_t n = x.size();
  const ExactArguments a(f, n);
  const Fraction weight = a.number("weight");
  const ExactGram identity = identity_gram(n);
  const Subdifferential normals = subdifferential(a.call("set"), identity, x);
  if (normals.is_empty()) {
    const Metric plain = Metric::identity(static_cast<Index>(n));
    const Vector away = found_prox(f, make_function(a.call("set"), {plain}), nearest(x), plain).v;
    const double length = away.stableNorm();
    if (!(length > 0)) refuse(f, "x is nearer to the set than doubles tell; move it");
    return single(fractions(Vector(nearest_double(weight) / length * away)), false);
  }
  if (normals.is_single() || sign(weight) == 0) return single(Fractions(n), true);
  if (!normals.polyhedron)
    refuse(f, "the normals at this point of the set are no polyhedron; give another point");
  Call tangent = as_set(polyhedron_of(tangent_cone(normals))).call;
  return of_support({"distance",
                     {argument("set", std::make_shared<const Call>(std::move(tangent))),
                      argument("weight", nearest_double(weight))}},
                    n, true);
}

/// weight (x - proj x).
Subdifferential of_squared_distance(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  const Metric plain = Metric::identity(static_cast<Index>(x.size()));
  const Prox found = found_prox(f, make_function(a.call("set"), {plain}), nearest(x), plain);
  return single(fractions(Vector(nearest_double(a.number("weight")) * found.v)), false);
}

/// s f(x/s) for s > 0: {(v, f(y) - v·y) : v in ∂f(y)}, y = x/s, f(y) rounded.
Subdifferential of_perspective(const Call& f, const Fractions& x) {
  const std::size_t n = x.size() - 1;
  const Fraction s = x.back();
  if (sign(s) < 0) return none(x.size());
  if (sign(s) == 0) refuse(f, "s is 0; give s > 0");
  const Call& inner = ExactArguments(f, x.size()).call("f");
  Fractions y(x.begin(), x.end() - 1);
  for (Fraction& entry : y) entry = entry / s;
  const ExactGram identity = identity_gram(n);
  std::vector<ExactRow> A = multiple_of_identity(Fraction{1}, n);
  for (std::size_t i = 0; i < n; ++i) add(A[i], n, -y[i]);
  Fractions last(n + 1);
  last.back() = fraction(make_function(inner, {rounded(identity)})(nearest(y)));
  return sum(transposed_image(subdifferential(inner, identity, y), A, n + 1), single(last, false));
}

bool is_identity(const ExactGram& W) {
  for (std::size_t i = 0; i < W.dimension(); ++i)
    if (W.rows[i].size() != 1 || !(W.rows[i].begin()->second == Fraction{1})) return false;
  return W.is_diagonal;
}

/// Of a conjugate or support function that has another name: g(y) = f*(Wy), so W ∂f*(Wy). f has no parts, for
/// these might take the product.
std::optional<Subdifferential> of_renamed(const Call& f, const ExactGram& W, const Fractions& x) {
  const ExactArguments a(f, x.size());
  const Call inner = f.name == "support" ? indicator_call(a.call("set")) : a.call("f");
  const Call& leaf = inner.name == "indicator" ? ExactArguments(inner, x.size()).call("set") : inner;
  if (!is_identity(W) && !ExactArguments(leaf, x.size()).calls().empty()) return std::nullopt;
  const ExactGram plain = identity_gram(x.size());
  const Call renamed = make_function(inner, {rounded(plain)}).conjugate().call();
  if (renamed.name == f.name) return std::nullopt;
  return transposed_image(subdifferential(renamed, plain, multiply(W, x)), W.rows, x.size());
}

}  // namespace

std::optional<Subdifferential> by_calculus(const Call& f, const ExactGram& W, const Fractions& x) {
  const std::string& name = f.name;
  if (name == "separable") return of_blocks(f, W, x);
  const ExactArguments a(f, x.size());
  const std::size_t n = x.size();
  if (name == "indicator") return subdifferential(a.call("set"), W, x);
  if (name == "sum" || name == "intersection") return of_sum(f, W, x);
  if (name == "precompose") return of_precompose(f, x);
  if (name == "pointwise_max") return of_maximum(f, W, x);
  if (name == "inf_convolution") return of_inf_convolution(f, W, x);
  if (name == "translate") return subdifferential(a.call("f"), W, difference(x, a.vector("by")));
  if (name == "tilt") return sum(subdifferential(a.call("f"), W, x), single(a.vector("c"), true));
  if (name == "scale")
    return transposed_image(subdifferential(a.call("f"), W, x), multiple_of_identity(a.number("alpha"), n),
                            n);
  if (name == "dilate") {
    const Fraction inverse = Fraction{1} / a.number("rho");
    return transposed_image(subdifferential(a.call("f"), W, pairs::multiple_of(inverse, x)),
                            multiple_of_identity(inverse, n), n);
  }
  if (name == "envelope") return of_envelope(f, W, x);
  if (name == "distance") return of_distance(f, x);
  if (name == "squared_distance") return of_squared_distance(f, x);
  if (name == "perspective") return of_perspective(f, x);
  if (name == "conjugate" || name == "support") return of_renamed(f, W, x);
  return std::nullopt;
}

std::optional<Subdifferential> of_smooth_or_homogeneous(const Call& f, const ExactGram& W,
                                                        const Fractions& x) {
  const Function made = make_function(f, {rounded(W)});
  const Facts facts = made.facts();
  const bool at_zero = sign(pairs::square_of(x)) == 0;
  if (at_zero && (facts.support || facts.cone) &&
      (is_identity(W) || ExactArguments(f, x.size()).calls().empty()))
    return of_support(facts.cone && find_entry(f.name)->kind == EntryKind::set ? indicator_call(f) : f,
                      x.size(), facts.finite);
  // The norm of a space that is smooth but at 0.
  const bool is_smooth_norm = f.name == "schatten" && Fraction{1} < ExactArguments(f, x.size()).number("p") &&
                              !at_zero &&
                              std::isfinite(nearest_double(ExactArguments(f, x.size()).number("p")));
  if (!is_smooth_norm && !(facts.smooth && facts.finite)) return std::nullopt;
  const auto v = made.subgradient(nearest(x));
  if (!v || !v->allFinite()) return std::nullopt;
  return single(fractions(*v), false);
}

}  // namespace convex::inline sets::subgradients
