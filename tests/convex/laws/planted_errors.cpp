#include <doctest/doctest.h>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/laws/laws.hpp"

using namespace convex;

namespace {

constexpr Index n = 3;

/// A wrong turn of a right prox.
struct Planted {
  const char* name;
  Prox (*wrong)(const Subject& right, const Vector& z, const Metric& W);
  bool cones = true;  ///< is it an error for a cone as well? A step does not matter to one.
};

Prox with_point(Prox found, const Vector& x) {
  found.x = x;
  return found;
}

const Planted table[] = {
    {"wrong scaling: half the step",
     [](const Subject& f, const Vector& z, const Metric& W) { return f.prox(z, W.scaled(2)); }, false},
    {"wrong scaling: of the point",
     [](const Subject& f, const Vector& z, const Metric& W) {
       const Prox right = f.prox(z, W);
       return with_point(right, right.x * (1 + 1e-6));
     }},
    {"forgotten step: the metric's size is lost",
     [](const Subject& f, const Vector& z, const Metric& W) {
       return f.prox(z, W.scaled(static_cast<double>(n) / W.diagonal().sum()));
     },
     false},
    {"wrong metric: the identity in place of W",
     [](const Subject& f, const Vector& z, const Metric&) { return f.prox(z, Metric::identity(n)); }},
    {"wrong metric: its diagonal alone",
     [](const Subject& f, const Vector& z, const Metric& W) {
       return f.prox(z, Metric::diagonal(W.diagonal()));
     }},
    {"swapped sign: past z instead of short of it",
     [](const Subject& f, const Vector& z, const Metric& W) {
       const Prox right = f.prox(z, W);
       return with_point(right, 2 * z - right.x);
     }},
    {"swapped sign: the prox at -z",
     [](const Subject& f, const Vector& z, const Metric& W) { return f.prox(-z, W); }},
    {"wrong tie: equal entries are treated one after the other",
     [](const Subject& f, const Vector& z, const Metric& W) {
       const Prox right = f.prox(z, W);
       if (!(std::abs(z[0] - z[1]) <= 1e-12 * z.norm()) || !(z.norm() > 0)) return right;
       return with_point(right, right.x + 1e-3 * (Vector(n) << 1, -1, 0).finished());
     }},
    {"forgotten step: the last of the correction",
     [](const Subject& f, const Vector& z, const Metric& W) {
       const Prox right = f.prox(z, W);
       return with_point(right, right.x + 1e-5 * (z - right.x));
     }},
    {"an error of 1000 times the printed bound",
     [](const Subject& f, const Vector& z, const Metric& W) {
       const Prox right = f.prox(z, W);
       const double bound = right.error_bound + rounding_bound(W, z, right.x);
       const Vector direction = (Vector(n) << 1, -2, 1.5).finished();
       return with_point(right, right.x + (1000 * bound / W.norm(direction)) * direction);
     }},
};

/// One with kinks, one without, a support function, a cone.
const char* const bases[] = {"norm1(2)", "quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1])",
                             "support(box([-1,-1,-1],[2,2,2]))",
                             "indicator(cone([[1,0,0],[1,1,0],[1,1,1]]))"};

struct Base {
  std::string text;
  Function f;
};

std::vector<Base> right_functions() {
  std::vector<Base> made;
  for (const char* text : bases)
    made.push_back({text, make_function(cli::parse_call(text, "f"), {Metric::identity(n)})});
  return made;
}

Subject planted(const Subject& right, const Planted& error) {
  return {right.value,
          [right, wrong = error.wrong](const Vector& z, const Metric& W) { return wrong(right, z, W); },
          right.membership};
}

bool scale_free(const Function& f) { return f.facts().indicator; }

LawReport pair_laws(const Base& base, const Planted* in_prox, const Planted* in_conjugate) {
  const Subject f = conjugate_pair(base.f, Metric::identity(n)).f;
  return laws(
      in_prox != nullptr ? planted(f, *in_prox) : f,
      [&](const Metric& W) {
        const Subject g = conjugate_pair(base.f, W).g;
        return in_conjugate != nullptr ? planted(g, *in_conjugate) : g;
      },
      n, base.f.facts().cone);
}

}  // namespace

TEST_CASE("right functions, with their conjugates, obey the laws") {
  for (const Base& base : right_functions()) {
    CAPTURE(base.text);
    const LawReport report = pair_laws(base, nullptr, nullptr);
    INFO(report.text());
    CHECK(report.all_passed());
  }
}

TEST_CASE("an error planted in the prox is caught with a counterexample") {
  for (const Base& base : right_functions())
    for (const Planted& error : table) {
      if (scale_free(base.f) && !error.cones) continue;
      CAPTURE(base.text);
      CAPTURE(error.name);
      const LawReport report = pair_laws(base, &error, nullptr);
      CHECK_FALSE(report.all_passed());
      CHECK(report.text().find("z = [") != std::string::npos);
    }
}

TEST_CASE("an error planted in the conjugate's prox is caught with a counterexample") {
  for (const Base& base : right_functions())
    for (const Planted& error : table) {
      // The conjugate of a support function is an indicator: a step does not matter to its prox.
      if (scale_free(base.f.conjugate()) && !error.cones) continue;
      CAPTURE(base.text);
      CAPTURE(error.name);
      CHECK_FALSE(pair_laws(base, nullptr, &error).all_passed());
    }
}

TEST_CASE("a wrong prox is caught without any conjugate, by the laws of the function alone") {
  for (const Base& base : right_functions())
    for (const Planted& error : table) {
      if (scale_free(base.f) && !error.cones) continue;
      CAPTURE(base.text);
      CAPTURE(error.name);
      const Subject right = conjugate_pair(base.f, Metric::identity(n)).f;
      CHECK(laws(right, n).all_passed());
      CHECK_FALSE(laws(planted(right, error), n).all_passed());
    }
}

TEST_CASE("a conjugate's value that is off by a factor, a constant or a sign is caught") {
  for (const Base& base : right_functions())
    for (const auto wrong : {+[](double g) { return 1.001 * g; }, +[](double g) { return g + 1e-6; },
                             +[](double g) { return -g; }}) {
      const auto conjugate = [&](const Metric& W) {
        Subject g = conjugate_pair(base.f, W).g;
        g.value = [right = g.value, wrong](const Vector& y) { return wrong(right(y)); };
        return g;
      };
      const Subject f = conjugate_pair(base.f, Metric::identity(n)).f;
      const bool always_zero = base.f.facts().support || base.f.facts().cone;
      if (always_zero && wrong(1.0) != 1.0 + 1e-6) continue;  // a factor of 0 changes nothing
      CAPTURE(base.text);
      CAPTURE(wrong(1));
      CHECK_FALSE(laws(f, conjugate, n, base.f.facts().cone).all_passed());
    }
}

TEST_CASE(
    "a prox of the conjugate that is z - prox_f is no evidence: the law of the sum fails and says why") {
  const Base base = right_functions().front();
  const Subject f = conjugate_pair(base.f, Metric::identity(n)).f;
  const LawReport report = laws(
      f,
      [&](const Metric& W) {
        Subject g = conjugate_pair(base.f, W).g;
        g.prox = [f](const Vector& z, const Metric& V) {
          Prox made = f.prox(z, V);
          made.x = z - made.x;
          made.by_conjugate = true;
          return made;
        };
        return g;
      },
      n);
  CHECK_FALSE(report.no_evidence.empty());
  CHECK_FALSE(report.all_passed());
  for (const Check& check : report.checks) CHECK(check.passed == (check.name != "z = x + y by two routes"));
}
