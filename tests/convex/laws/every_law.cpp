#include <doctest/doctest.h>

#include <limits>
#include <map>
#include <set>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/laws/laws.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

using namespace convex;

namespace {

constexpr Index n = 3;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// What is wrong about a function; a verb that is left empty is right.
struct Wrong {
  std::function<double(const Function& right, const Vector& x)> value = {};
  std::function<Prox(const Function& right, const Vector& z, const Metric& W)> prox = {};
  std::function<Vector(const Function& right, const Vector& x)> subgradient = {};
};

/// A right function with planted errors. Its programs are the right ones: a second route does not share the
/// error of the first.
class WrongNode : public FunctionNode {
 public:
  WrongNode(Function right, Wrong wrong, std::optional<Function> conjugate)
      : right_(std::move(right)), wrong_(std::move(wrong)), conjugate_(std::move(conjugate)) {}
  Index dimension() const override { return n; }
  Facts facts() const override { return right_.facts(); }
  Call call() const override { return right_.call(); }
  double value(const Vector& x) const override { return wrong_.value ? wrong_.value(right_, x) : right_(x); }
  Prox prox(const Vector& z, const Metric& W, const Look&) const override {
    return wrong_.prox ? wrong_.prox(right_, z, W) : right_.prox(z, W);
  }
  Function conjugate() const override { return conjugate_ ? *conjugate_ : right_.conjugate(); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (wrong_.subgradient) return wrong_.subgradient(right_, x);
    return right_.subgradient(x);
  }
  std::optional<LinearQuadratic> linear_quadratic(Index size) const override {
    return right_.node().linear_quadratic(size);
  }

 private:
  Function right_;
  Wrong wrong_;
  std::optional<Function> conjugate_;
};

/// Errors in f, and in its conjugate.
struct Planted {
  const char* what;
  Wrong f, g;
  std::vector<std::string> caught_by;  ///< laws, by how their names begin
};

Function planted(const Function& right, const Planted& error) {
  const Function g(std::make_shared<WrongNode>(right.conjugate(), error.g, std::nullopt));
  const bool wrong_conjugate = error.g.value || error.g.prox || error.g.subgradient;
  return Function(std::make_shared<WrongNode>(right, error.f,
                                              wrong_conjugate ? std::optional<Function>(g) : std::nullopt));
}

/// A wrong x that is told to be right: its bound would be honest otherwise, and the laws grant it.
Prox told_right(Prox found, const Vector& z, const Metric& W) {
  found.v = W.multiply(z - found.x);
  found.error_bound = 0;
  return found;
}
/// The prox at another point: in the domain, and wrong.
Prox beside(const Function& right, const Vector& z, const Metric& W) {
  return told_right(right.prox(z + Vector{{0.5, -0.25, 0.75}}, W), z, W);
}
Prox mirrored(const Function& right, const Vector& z, const Metric& W) {
  return told_right(right.prox(-z, W), z, W);
}
double forgets_its_domain(const Function& right, const Vector& x) {
  const double value = right(x);
  return std::isfinite(value) ? value : 0;
}

const std::vector<Planted> table{
    {"a value that is +inf everywhere",
     {.value = [](const Function&, const Vector&) { return infinity; }},
     {},
     {"f is finite at x"}},
    {"a conjugate that is +inf everywhere",
     {},
     {.value = [](const Function&, const Vector&) { return infinity; }},
     {"g is finite at y"}},
    {"the prox at a point beside z",
     {.prox = beside},
     {},
     {"z - x is a subgradient", "prox of f** = prox of f", "z = prox_f z + W^-1 prox", "prox_f(2z)",
      "W(z - x) counts", "z = x + y by two routes"}},
    {"the prox at -z", {.prox = mirrored}, {}, {"prox is firmly nonexpansive"}},
    {"the prox in the identity metric",
     {.prox = [](const Function& right, const Vector& z,
                 const Metric& W) { return told_right(right.prox(z, Metric::identity(n)), z, W); }},
     {},
     {"one subgradient serves every metric"}},
    {"the conjugate's prox at a point beside z",
     {},
     {.prox = beside},
     {"z = x + y by two routes", "x and y are orthogonal"}},
    {"the conjugate's prox at -z",
     {},
     {.prox = mirrored},
     {"x is the gradient at z of the envelope", "x and y are orthogonal"}},
    {"a prox of the conjugate that tells of having come from f",
     {},
     {.prox =
          [](const Function& right, const Vector& z, const Metric& W) {
            Prox found = told_right(right.prox(z + Vector{{1, 1, 1}}, W), z, W);
            found.by_conjugate = true;
            return found;
          }},
     {"conjugacy f(x) + g(y)"}},
    {"a conjugate too small by 1",
     {},
     {.value = [](const Function& right, const Vector& y) { return right(y) - 1; }},
     {"conjugacy f(x) + g(y)", "Fenchel's inequality", "the envelopes of f and g add up"}},
    {"values that forget their domains, the conjugate too small by 1",
     {.value = forgets_its_domain},
     {.value = [](const Function& right, const Vector& y) { return forgets_its_domain(right, y) - 1; }},
     {"no other split of z"}},
    {"a value too large by 1, which the conjugate does not know of",
     {.value = [](const Function& right, const Vector& x) { return right(x) + 1; }},
     {},
     {"f** = f"}},
    {"a subgradient with a wrong entry",
     {.subgradient =
          [](const Function& right, const Vector& x) {
            return Vector(right.subgradient(x).value_or(Vector::Zero(n)) + Vector{{-30, 40, 50}});
          }},
     {},
     {"the subgradient that f gives"}},
};

/// With kinks, smooth, smooth with an open domain, a support function, an indicator, a cone with two sides, a
/// curved cone, an operation.
const char* const scenes[] = {"norm1(2)",
                              "quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1])",
                              "entropy()",
                              "support(box([-1,-1,-1],[2,2,2]))",
                              "indicator(simplex(2))",
                              "indicator(monotone_cone())",
                              "indicator(second_order_cone())",
                              "sum(norm2(), squared_norm2(2))"};

LawReport report_on(const Function& f) {
  const std::vector<Vector> all = trial_points(n);
  const auto metrics = trial_metrics(n);
  return laws(f, {all[1], all[3], all[7]}, {metrics[1], metrics[2]});
}

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

std::set<std::string> names(const LawReport& report, bool failed_only) {
  std::set<std::string> found;
  for (const Check& check : report.checks)
    if (!failed_only || !check.passed) found.insert(check.name);
  return found;
}

}  // namespace

TEST_CASE("for every law of a decomposition there is an error that it catches, on every kind of function") {
  for (const char* text : scenes) {
    const std::string scene = text;
    CAPTURE(scene);
    const Function right = make_function(cli::parse_call(text, "f"), {Metric::identity(n)});
    const LawReport of_right = report_on(right);
    INFO(of_right.text());
    CHECK(of_right.all_passed());
    std::set<std::string> uncaught = names(of_right, false);
    for (const Planted& error : table) {
      CAPTURE(error.what);
      const std::set<std::string> failed = names(report_on(planted(right, error)), true);
      CHECK_FALSE(failed.empty());
      for (const std::string& law : error.caught_by)
        for (const std::string& name : failed)
          if (begins(name, law)) uncaught.erase(name);
    }
    for (const std::string& law : uncaught) FAIL_CHECK("no planted error is caught by: " << law);
  }
}

TEST_CASE("every law that the table of planted errors speaks of is one") {
  std::set<std::string> all;
  for (const char* text : scenes)
    for (const std::string& name :
         names(report_on(make_function(cli::parse_call(text, "f"), {Metric::identity(n)})), false))
      all.insert(name);
  for (const Planted& error : table)
    for (const std::string& law : error.caught_by) {
      CAPTURE(law);
      bool known = false;
      for (const std::string& name : all) known = known || begins(name, law);
      CHECK(known);
    }
}
