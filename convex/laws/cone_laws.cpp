#include "convex/laws/cone_laws.hpp"

#include <cmath>

#include "convex/cones/cone_operations.hpp"
#include "convex/exact/elimination.hpp"

namespace convex::inline law_checks {
namespace {

/// A description of so many rows is not made anew from the other side: facets may be many.
constexpr std::size_t most_rows = 500;

void count_law(LawReport& report, std::string name, Index exceptions) {
  report.checks.push_back(check_that(std::move(name), static_cast<double>(exceptions), 0));
}

Index outside(const PolyhedralCone& K) {
  Index count = 0;
  const auto cross = [&](const IntegerRows& covectors, const IntegerRows& vectors, bool equal) {
    for (const IntegerVector& a : covectors)
      for (const IntegerVector& v : vectors) {
        const int side = dot(a, v).sign();
        count += equal ? side != 0 : side > 0;
      }
  };
  cross(K.halfspaces, K.generators, false);
  cross(K.halfspaces, K.lines, true);
  cross(K.equations, K.generators, true);
  cross(K.equations, K.lines, true);
  return count;
}

/// The rows a for which the v with a·v = 0, with `always`, span fewer than `wanted` dimensions.
Index loose(const IntegerRows& rows, const IntegerRows& others, const IntegerRows& always, Index n,
            Index wanted) {
  Index count = 0;
  const Echelon start = echelon(always, static_cast<std::size_t>(n));
  for (const IntegerVector& a : rows) {
    Echelon touched = start;
    for (const IntegerVector& v : others) {
      if (static_cast<Index>(touched.rank()) >= wanted) break;
      if (dot(a, v).is_zero()) extend(touched, v);
    }
    count += static_cast<Index>(touched.rank()) != wanted;
  }
  return count;
}

void description_laws(const PolyhedralCone& K, const std::string& name, LawReport& report) {
  count_law(report, "the generators of " + name + " satisfy its half-spaces", outside(K));
  count_law(report, "each half-space of " + name + " is a facet, tight on enough independent generators",
            loose(K.halfspaces, K.generators, K.lines, K.n, K.dimension() - 1));
  count_law(report, "each generator of " + name + " is an extreme ray",
            loose(K.generators, K.halfspaces, K.equations, K.n, K.n - K.lineality() - 1));
}

ExactRows exact(const IntegerRows& rows) {
  ExactRows made;
  for (const IntegerVector& row : rows) made.push_back({row, 1});
  return made;
}

void polarity_law(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactMetric& W,
                  LawReport& report) {
  Index positive = 0;
  for (const IntegerVector& g : K.generators) {
    const IntegerVector covector = times(g, W.gram);
    for (const IntegerVector& h : polar_cone.generators) positive += dot(covector, h).sign() > 0;
    for (const IntegerVector& h : polar_cone.lines) positive += !dot(covector, h).is_zero();
  }
  count_law(report, "(x|y) <= 0 between the generators of the cone and those of the polar", positive);
  if (polar_cone.generators.size() > most_rows) {
    report.no_evidence.push_back("polar of polar: the polar has " +
                                 std::to_string(polar_cone.generators.size()) +
                                 " generators; to describe it anew takes too long, and its own description "
                                 "was made from the cone's");
    return;
  }
  const PolyhedralCone anew =
      generated_cone(exact(polar_cone.generators), exact(polar_cone.lines), polar_cone.n);
  count_law(report, "the polar of the polar, from its generators alone, is the cone",
            !are_equal(polar(anew, W), K));
}

/// z - x over one denominator.
IntegerVector rest_of(const ExactVector& z, const ExactVector& x) {
  IntegerVector rest;
  for (std::size_t i = 0; i < z.numerators.size(); ++i)
    rest.push_back(z.numerators[i] * x.denominator - x.numerators[i] * z.denominator);
  return rest;
}

/// The entries in which x + y is not z.
Index missing(const ExactVector& z, const ConeSplit& split) {
  const IntegerVector rest = rest_of(z, split.x);  // (z - x) times both denominators
  const Integer scale = z.denominator * split.x.denominator;
  Index count = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    count += !(rest[i] * split.y.denominator - split.y.numerators[i] * scale).is_zero();
  return count;
}

/// The generators and lines that z - x leans on; and 0, when (z - x|x) is not 0.
Index nearer(const PolyhedralCone& K, const ExactVector& z, const ExactVector& x, const ExactMetric& W) {
  const IntegerVector covector = times(rest_of(z, x), W.gram);
  Index count = !dot(covector, x.numerators).is_zero();
  for (const IntegerVector& g : K.generators) count += dot(covector, g).sign() > 0;
  for (const IntegerVector& b : K.lines) count += !dot(covector, b).is_zero();
  return count;
}

}  // namespace

LawReport cone_laws(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactMetric& W) {
  LawReport report;
  description_laws(K, "the cone", report);
  description_laws(polar_cone, "the polar", report);
  polarity_law(K, polar_cone, W, report);
  return report;
}

LawReport cone_laws(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactMetric& W,
                    const ExactVector& z, const ConeSplit& split) {
  LawReport report = cone_laws(K, polar_cone, W);
  count_law(report, "x is in the cone", !contains(K, split.x));
  count_law(report, "y is in the polar", !contains(polar_cone, split.y));
  count_law(report, "z = x + y, each from its own generators", missing(z, split));
  report.checks.push_back(check_that("(x|y) = 0", std::abs(nearest_double(inner(W, split.x, split.y))), 0));
  count_law(report, "no other point of the cone is as near to z as x", nearer(K, z, split.x, W));
  count_law(report, "no other point of the polar is as near to z as y", nearer(polar_cone, z, split.y, W));
  return report;
}

}  // namespace convex::inline law_checks
