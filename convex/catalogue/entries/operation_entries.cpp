#include <cmath>

#include "convex/catalogue/entries/entries.hpp"
#include "convex/counted.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/takes_product.hpp"

namespace convex::inline catalogue_entries {
namespace {

using enum ParameterKind;
constexpr auto operation = EntryKind::operation;

constexpr std::string_view closed_as_part = "as its part's";
constexpr std::string_view by_program =
    "exact by active set when its parts are piecewise linear-quadratic, else iterative to 1e-12";
constexpr std::string_view by_entries =
    "entry by entry when its parts are separable, else as in a general one";
constexpr std::string_view by_parts =
    "one part's after another's where that is a theorem, else as in a diagonal one";
constexpr std::string_view in_other_metric = "as its part's in a derived metric";

Space plain(Index n) { return {Metric::identity(n)}; }

Function make_precompose(const Arguments& a) {
  const Matrix A = a.matrix("A");
  if (A.rows() == 0 || A.cols() == 0) a.refuse("A", "no entries; give at least one row and column");
  if (A.cols() != a.space().dimension())
    a.refuse("A", counted(A.cols(), "column", "columns") + ", the space has " +
                      counted(a.space().dimension(), "entry", "entries") + "; give as many");
  const Vector b = a.given("b") ? a.vector("b") : Vector::Zero(A.rows());
  return precompose(a.function_in("f", plain(A.rows())), A, b);
}

/// Blocks come as pairs: a function and its number of entries.
Function make_separable(const Arguments& a) {
  const auto& given = a.call().arguments;
  const auto fail = [&](const NamedArgument& at, const std::string& what) {
    throw InvalidInput("separable: " + what, at.place ? at.place : a.call().place);
  };
  if (given.size() % 2 != 0) fail(given.back(), "a function without a size; write separable(f, n, g, m, …)");
  std::vector<Index> sizes;
  Index total = 0;
  for (std::size_t k = 1; k < given.size(); k += 2) {
    const double* size = std::get_if<double>(&given[k].value);
    if (!size || !(*size >= 1) || *size != std::floor(*size) || *size > 1e9)
      fail(given[k], "the size of a block is a number of entries; write separable(f, n, g, m, …)");
    sizes.push_back(static_cast<Index>(*size));
    total += sizes.back();
  }
  const Metric& W = a.space().product;
  if (total != W.dimension())
    fail(given.front(), "its blocks have " + counted(total, "entry", "entries") + ", the space has " +
                            std::to_string(W.dimension()) + "; give sizes that add up to it");
  const bool coupled = couples(W, sizes);
  std::vector<Function> parts;
  Index first = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const auto* call = std::get_if<std::shared_ptr<const Call>>(&given[2 * k].value);
    if (!call) fail(given[2 * k], "not a set or function; write separable(f, n, g, m, …)");
    if (coupled && takes_product(**call))
      fail(given[2 * k], "the metric couples its blocks, and " + (*call)->name +
                             " depends on the metric; use a metric without entries between blocks");
    parts.push_back(make_function(**call, coupled ? plain(sizes[k]) : Space{block(W, first, sizes[k])}));
    first += sizes[k];
  }
  return separable(parts, sizes);
}

Function make_lifted(const Arguments& a, Function (*lift)(const Function&)) {
  const Index n = a.space().dimension();
  if (n < 2) a.refuse("f", "the space has one entry; it takes one more than the function");
  return lift(a.function_in("f", plain(n - 1)));
}

Function make_intersection(const Arguments& a) {
  std::vector<Set> sets;
  for (const NamedArgument& one : a.call().arguments) {
    const auto* call = std::get_if<std::shared_ptr<const Call>>(&one.value);
    if (!call)
      throw InvalidInput("intersection: not a set; write intersection(box(0, 1), …)",
                         one.place ? one.place : a.call().place);
    sets.push_back(make_set(**call, a.space()));
  }
  return intersection(sets, a.space().dimension());
}

}  // namespace

std::vector<CatalogueEntry> operation_entries() {
  return {
      {"intersection",
       EntryKind::set,
       {{"sets", functions}},
       "the points of all the sets",
       "Rockafellar 1970, Theorem 16.4",
       by_program,
       by_program,
       by_program,
       {"intersection(ball2(), box(0, 2))", "intersection(simplex(1), halfspace([1,2,-1], 0.5))",
        "intersection(ball2(2), halfspace([1,1,0], 1), orthant())"},
       make_intersection},
      {"epigraph",
       EntryKind::set,
       {{"f", function}},
       "{(x, t) : f(x) <= t}, t last",
       "Bauschke and Combettes 2017, Proposition 29.35",
       by_program,
       by_program,
       by_program,
       {"epigraph(norm1())", "epigraph(squared_norm2())", "epigraph(exponential())"},
       [](const Arguments& a) { return make_lifted(a, epigraph); }},
      {"conjugate",
       operation,
       {{"f", function}},
       "sup over u of (x|u) - f(u)",
       "Fenchel 1949; Moreau 1965",
       "by rule, else Moreau's identity",
       "by rule, else Moreau's identity",
       "by rule, else Moreau's identity",
       {"conjugate(norm1())", "conjugate(logistic())", "conjugate(sum(norm2(), hinge()))",
        "conjugate(conjugate(huber(0.5)))"},
       [](const Arguments& a) { return a.function("f").conjugate(a.space().product); }},
      {"envelope",
       operation,
       {{"f", function}, {"gamma", number, "1"}},
       "min over u of f(u) + ||x - u||^2 / (2 gamma)",
       "Moreau 1965",
       closed_as_part,
       closed_as_part,
       in_other_metric,
       {"envelope(norm1(), 0.5)", "envelope(indicator(ball2()), 2)", "envelope(entropy(), 0.25)"},
       [](const Arguments& a) { return envelope(a.function("f"), a.number("gamma"), a.space().product); }},
      {"translate",
       operation,
       {{"f", function}, {"by", vector}},
       "f(x - by)",
       "Rockafellar 1970, Theorem 12.3",
       closed_as_part,
       closed_as_part,
       closed_as_part,
       {"translate(norm1(2), [1,-2,0.5])", "translate(entropy(), [1,-2,3])"},
       [](const Arguments& a) { return translate(a.function("f"), a.vector("by")); }},
      {"tilt",
       operation,
       {{"f", function}, {"c", vector}},
       "f(x) + c.x",
       "Rockafellar 1970, Theorem 12.3",
       closed_as_part,
       closed_as_part,
       closed_as_part,
       {"tilt(norm2(), [1,-2,0.5])", "tilt(indicator(box(-1, 1)), [0.5,0,-2])"},
       [](const Arguments& a) { return tilt(a.function("f"), a.vector("c")); }},
      {"scale",
       operation,
       {{"f", function}, {"alpha", number}},
       "alpha f(x), alpha > 0",
       "Rockafellar 1970, Theorem 16.1",
       closed_as_part,
       closed_as_part,
       closed_as_part,
       {"scale(logistic(), 3)", "scale(huber(0.1), 0.25)"},
       [](const Arguments& a) { return scale(a.function("f"), a.number("alpha")); }},
      {"dilate",
       operation,
       {{"f", function}, {"rho", number}},
       "f(x / rho), rho not 0",
       "Rockafellar 1970, Theorem 16.1",
       closed_as_part,
       closed_as_part,
       closed_as_part,
       {"dilate(hinge(), -2)", "dilate(entropy(), 0.5)"},
       [](const Arguments& a) { return dilate(a.function("f"), a.number("rho")); }},
      {"sum",
       operation,
       {{"functions", functions}},
       "f(x) + g(x) + ...",
       "Rockafellar 1970, Theorem 16.4; Yu 2013",
       by_parts,
       by_entries,
       by_program,
       {"sum(norm1(), squared_norm2(2))", "sum(norm2(), indicator(box(-1, 2)))",
        "sum(entropy(), indicator(simplex(1)), linear([1,0,-1]))", "sum(norm1(), total_variation(0.5))"},
       [](const Arguments& a) { return sum(a.functions("functions"), a.space().dimension()); }},
      {"inf_convolution",
       operation,
       {{"f", function}, {"g", function}},
       "inf over u of f(u) + g(x - u), closed",
       "Moreau 1963; Rockafellar 1970, Theorem 16.4",
       by_program,
       by_program,
       by_program,
       {"inf_convolution(norm1(), squared_norm2(2))", "inf_convolution(norm2(), norm1(0.75))",
        "inf_convolution(entropy(), indicator(box(-1, 1)))"},
       [](const Arguments& a) {
         return inf_convolution(a.function("f"), a.function("g"), a.space().dimension());
       }},
      {"precompose",
       operation,
       {{"f", function}, {"A", matrix}, {"b", vector, "0"}},
       "f(A x + b)",
       "Rockafellar 1970, Theorem 16.3; Combettes and Pesquet 2007, Proposition 11",
       in_other_metric,
       in_other_metric,
       in_other_metric,
       {"precompose(norm1(), [[1,1,0],[0,1,-1]])",
        "precompose(logistic(), [[1,2,0],[0,1,1],[1,0,1],[2,1,1]], [1,0,-1,0])",
        "precompose(norm2(), [[0,1,0],[0,0,1],[1,0,0]], [1,2,3])"},
       make_precompose},
      {"separable",
       operation,
       {{"blocks", functions}},
       "f(first n entries) + g(next m entries) + ...",
       "Rockafellar 1970, section 16",
       closed_as_part,
       closed_as_part,
       by_program,
       {"separable(norm1(), 1, norm2(), 2)", "separable(entropy(), 2, indicator(orthant()), 1)"},
       make_separable},
      {"pointwise_max",
       operation,
       {{"functions", functions}},
       "max(f(x), g(x), ...)",
       "Rockafellar 1970, Theorem 16.5",
       by_program,
       by_program,
       by_program,
       {"pointwise_max(norm1(), linear([1,2,-3]))", "pointwise_max(norm2(), constant(1))",
        "pointwise_max(squared_norm2(), norm1(2))"},
       [](const Arguments& a) { return pointwise_max(a.functions("functions"), a.space().dimension()); }},
      {"proximal_average",
       operation,
       {{"f", function}, {"g", function}, {"weight", number, "0.5"}, {"gamma", number, "1"}},
       "inf {weight f(p) + (1-weight) g(q) + weight (1-weight) ||p-q||^2 / (2 gamma) : weight p + (1-weight) "
       "q = x}",
       "Bauschke, Goebel, Lucet and Wang 2008",
       closed_as_part,
       by_program,
       by_program,
       {"proximal_average(norm1(), squared_norm2(), 0.25, 1)",
        "proximal_average(norm2(), indicator(box(-1, 1)), 0.5, 2)"},
       [](const Arguments& a) {
         return proximal_average(a.function("f"), a.function("g"), a.number("weight"), a.number("gamma"),
                                 a.space().product);
       }},
      {"perspective",
       operation,
       {{"f", function}},
       "s f(x/s) for s > 0, closed at s = 0; s is the last entry",
       "Rockafellar 1970, Corollary 13.5.1",
       by_program,
       by_program,
       by_program,
       {"perspective(squared_norm2())", "perspective(norm1())", "perspective(exponential())"},
       [](const Arguments& a) { return make_lifted(a, perspective); }},
      {"distance",
       operation,
       {{"set", set}, {"weight", number, "1"}},
       "weight times the plain distance of x to the set",
       "Beck 2017, Lemma 6.43",
       closed_as_part,
       by_program,
       by_program,
       {"distance(ball2())", "distance(box(-1, 1), 2)", "distance(second_order_cone())"},
       [](const Arguments& a) { return distance(a.set("set"), a.number("weight")); }},
      {"squared_distance",
       operation,
       {{"set", set}, {"weight", number, "1"}},
       "weight/2 times the squared plain distance of x to the set",
       "Moreau 1965",
       closed_as_part,
       closed_as_part,
       in_other_metric,
       {"squared_distance(ball2())", "squared_distance(box(-1, 1), 2)", "squared_distance(simplex(1), 0.5)"},
       [](const Arguments& a) { return squared_distance(a.set("set"), a.number("weight")); }},
  };
}

}  // namespace convex::inline catalogue_entries
