#include "convex/laws/cone_laws.hpp"

#include <doctest/doctest.h>

#include <set>

#include "convex/cones/cone_operations.hpp"

using namespace convex;

namespace {

/// A cone, its polar, and a point split between them.
struct Scene {
  PolyhedralCone K, polar_cone;
  ExactMetric W;
  ExactVector z;
  ConeSplit split;
  LawReport laws() const { return cone_laws(K, polar_cone, W, z, split); }
};

Scene scene(PolyhedralCone K, const Matrix& W, const Vector& z) {
  Scene made{std::move(K), {}, exact_metric(exact_rows(W)), exact_vector(z), {}};
  made.polar_cone = polar(made.K, made.W);
  made.split = split(made.K, made.polar_cone, made.z, made.W);
  return made;
}

/// Pointed with generators; with a line; from half-spaces with an equation; not full.
std::vector<Scene> scenes() {
  const Matrix W{{2, 1, 0}, {1, 2, 0}, {0, 0, 1}};
  return {scene(generated_cone(Matrix{{1, 0, 1}, {0, 1, 1}, {-1, 0, 1}, {0, -1, 1}}), W, Vector{{3, 1, -1}}),
          scene(generated_cone(Matrix{{1, 0, 0}, {1, 2, 0}}, Matrix{{0, 0, 1}}), W, Vector{{-1, 3, 2}}),
          scene(halfspace_cone(Matrix{{-1, 0, 0}, {0, -1, 0}}, Matrix{{0, 0, 1}}), Matrix::Identity(3, 3),
                Vector{{2, -3, 4}})};
}

IntegerVector sum(const IntegerVector& a, const IntegerVector& b) {
  IntegerVector c = a;
  for (std::size_t i = 0; i < c.size(); ++i) c[i] += b[i];
  return c;
}

ExactVector point(const IntegerVector& x, std::int64_t factor = 1) {
  ExactVector made{x, 1};
  for (Integer& entry : made.numerators) entry *= factor;
  return made;
}

struct Planted {
  const char* what;
  void (*plant)(Scene&);
  std::vector<std::string> caught_by;
};

/// Half-spaces and covectors are turned to vectors by W⁻¹; the normals themselves do as points outside.
const Planted table[] = {
    {"a generator outside the cone",
     [](Scene& s) { s.K.generators.push_back(s.K.halfspaces[0]); },
     {"the generators of the cone satisfy"}},
    {"a generator outside the polar",
     [](Scene& s) { s.polar_cone.generators.push_back(s.polar_cone.halfspaces[0]); },
     {"the generators of the polar satisfy"}},
    {"a half-space of the cone that is none of its facets",
     [](Scene& s) { s.K.halfspaces.push_back(sum(s.K.halfspaces[0], s.K.halfspaces[1])); },
     {"each half-space of the cone is a facet"}},
    {"a half-space of the polar that is none of its facets",
     [](Scene& s) {
       s.polar_cone.halfspaces.push_back(sum(s.polar_cone.halfspaces[0], s.polar_cone.halfspaces[1]));
     },
     {"each half-space of the polar is a facet"}},
    {"a generator of the cone to spare",
     [](Scene& s) { s.K.generators.push_back(sum(s.K.generators[0], s.K.generators[1])); },
     {"each generator of the cone is an extreme ray"}},
    {"a generator of the polar to spare",
     [](Scene& s) {
       s.polar_cone.generators.push_back(sum(s.polar_cone.generators[0], s.polar_cone.generators[1]));
     },
     {"each generator of the polar is an extreme ray"}},
    {"a polar that holds a generator of the cone",
     [](Scene& s) { s.polar_cone.generators.push_back(s.K.generators[0]); },
     {"(x|y) <= 0 between the generators"}},
    {"a polar without one of its generators",
     [](Scene& s) { s.polar_cone.generators.pop_back(); },
     {"the polar of the polar"}},
    {"x outside the cone", [](Scene& s) { s.split.x = point(s.K.halfspaces[0]); }, {"x is in the cone"}},
    {"y outside the polar",
     [](Scene& s) { s.split.y = point(s.polar_cone.halfspaces[0]); },
     {"y is in the polar"}},
    {"x twice as long",
     [](Scene& s) { s.split.x = point(s.K.generators[0], 7); },
     {"z = x + y", "no other point of the cone"}},
    {"y on another ray",
     [](Scene& s) { s.split.y = point(s.polar_cone.generators.back(), 5); },
     {"no other point of the polar"}},
    {"y along x", [](Scene& s) { s.split.y = s.split.x; }, {"(x|y) = 0"}},
};

std::set<std::string> names(const LawReport& report, bool failed_only) {
  std::set<std::string> found;
  for (const Check& check : report.checks)
    if (!failed_only || !check.passed) found.insert(check.name);
  return found;
}

}  // namespace

TEST_CASE("for every law of a cone there is an error that it catches, on every kind of cone") {
  for (const Scene& right : scenes()) {
    INFO(right.laws().text());
    CHECK(right.laws().all_passed());
    std::set<std::string> uncaught = names(right.laws(), false);
    for (const Planted& error : table) {
      CAPTURE(error.what);
      Scene wrong = right;
      error.plant(wrong);
      const std::set<std::string> failed = names(wrong.laws(), true);
      for (const std::string& law : error.caught_by) {
        CAPTURE(law);
        bool caught = false;
        for (const std::string& name : failed)
          if (name.rfind(law, 0) == 0) {
            caught = true;
            uncaught.erase(name);
          }
        CHECK(caught);
      }
    }
    for (const std::string& law : uncaught) FAIL_CHECK("no planted error is caught by: " << law);
  }
}
