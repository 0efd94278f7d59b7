#include <doctest/doctest.h>

#include <cmath>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/laws/trial.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operations.hpp"

using namespace convex;

namespace {

/// Every example of the catalogue, and operations whose parts meet where proxes are delicate.
std::vector<std::string> expressions() {
  std::vector<std::string> all = {"scale(dilate(logistic(), -2), 3)",
                                  "tilt(norm2(), [0.5,-0.25,0.5])",
                                  "sum(entropy(), indicator(simplex(1)), linear([1,2,-1]))",
                                  "sum(logistic(), norm2())",
                                  "inf_convolution(norm2(), quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1]))",
                                  "sum(quadratic([[2,1,0],[1,2,0],[0,0,1]]), linear([1,2,3]), constant(-1))",
                                  "envelope(envelope(entropy(), 0.25), 1)"};
  for (const CatalogueEntry& entry : catalogue())
    for (const std::string_view example : entry.examples)
      all.push_back(entry.kind == EntryKind::set ? "indicator(" + std::string(example) + ")"
                                                 : std::string(example));
  return all;
}

/// Near, usual and far, and a prox point, moved a little.
std::vector<Vector> points(const Function& f, const Metric& W) {
  const Index n = W.dimension();
  const std::vector<Vector> all = trial_points(n);
  std::vector<Vector> chosen{1e-12 * all[3], 1e-6 * all[7], all[7], all[3], 1e6 * all[3], 1e3 * all[9]};
  const Vector x = f.prox(all[7], W).x;
  chosen.push_back(x);
  chosen.push_back(x + 1e-9 * all[8]);
  return chosen;
}

struct Reached {
  double size, bound;
  bool data_is_larger;  ///< than z and x: weights and radii of the examples are about 1
};

Reached reached(const Prox& p, const Vector& z, const Metric& W) {
  const double size = W.norm(z) + W.norm(p.x);
  return {size, p.error_bound, size <= 1e-2 * std::sqrt(spectrum(W).largest)};
}

}  // namespace

TEST_CASE("a prox that calls itself solved is proved to 1e-12 in any metric, by its own bound") {
  for (const std::string& text : expressions()) {
    CAPTURE(text);
    const Call call = cli::parse_call(text, "f");
    const Index n = cli::number_of_entries(call);
    const Function f = make_function(call, {Metric::identity(n)}), g = f.conjugate();
    for (const NamedMetric& metric : trial_metrics(n)) {
      const Metric &W = metric.W, V = inverse(W);
      CAPTURE(metric.name);
      for (const Vector& z : points(f, W)) {
        CAPTURE(z.transpose());
        const Prox x = f.prox(z, W), y = g.prox(W.multiply(z), V);
        for (const auto& [p, at, in] : {std::tuple{&x, z, W}, std::tuple{&y, W.multiply(z), V}}) {
          const Reached a = reached(*p, at, in);
          if (p->status == Status::solved && !a.data_is_larger) CHECK(a.bound <= 1e-12 * a.size);
          CHECK(a.bound <= 1e-9 * a.size + 1e-13);
        }
        // Two routes agree within their bounds, and the rounding of Wz and of the inverse metric.
        const double rounding = 2 * rounding_bound(W, z, x.x);
        CHECK(W.norm(z - x.x - W.solve(y.x)) <= x.error_bound + y.error_bound + rounding);
        CHECK(std::isfinite(f(x.x)));
        CHECK(std::isfinite(g(y.x)));
      }
    }
  }
}

TEST_CASE("the prox of a conjugate by its own program is z minus that of the function") {
  for (const char* text :
       {"indicator(epigraph(exponential()))", "indicator(epigraph(logistic()))",
        "indicator(epigraph(norm1()))", "perspective(exponential())", "perspective(squared_norm2())",
        "pointwise_max(norm2(), constant(1))", "pointwise_max(norm1(), linear([1,2,-3]))",
        "precompose(logistic(), [[1,2,0],[0,1,1],[1,0,1],[2,1,1]], [1,0,-1,0])"}) {
    CAPTURE(text);
    const Function f = make_function(cli::parse_call(text, "f"), {Metric::identity(3)}), g = f.conjugate();
    const std::vector<Vector> all = trial_points(3);
    for (const Metric& W : {Metric::identity(3), Metric::dense(matrix_of_condition(3, 10))})
      for (const Vector& z : {all[0], all[1], all[3], all[7]}) {
        CAPTURE(z.transpose());
        const Metric V = inverse(W);
        const Prox x = f.prox(z, W);
        const std::optional<Prox> y = prox_by_program(g, W.multiply(z), V);
        REQUIRE(y);
        CHECK(W.norm(z - x.x - W.solve(y->x)) <=
              x.error_bound + y->error_bound + 4 * rounding_bound(W, z, x.x) + 1e-15);
      }
  }
}
