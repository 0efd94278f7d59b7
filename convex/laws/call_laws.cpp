#include "convex/laws/call_laws.hpp"

#include <algorithm>

#include "convex/catalogue/catalogue.hpp"
#include "convex/invalid_input.hpp"

namespace convex::inline law_checks {
namespace {

/// Made in the product of W; where W couples what the call keeps apart, in the plain one.
Function function_in(const Call& call, const Metric& W) {
  const Function plain = make_function(call, {Metric::identity(W.dimension())});
  try {
    return make_function(call, {W});
  } catch (const InvalidInput&) {
    return plain;
  }
}

std::vector<Vector> few_points(const Function& f, const Metric& W) {
  const std::vector<Vector> all = trial_points(W.dimension());
  std::vector<Vector> few{all[0], all[1], all[3], all[7], all.back()};
  const Vector& z = all[7];
  const Vector x = f.prox(z, W).x;
  few.push_back(x);
  few.push_back(x + (z - x) / 1024);
  return few;
}

void take(LawReport& into, const LawReport& more) {
  for (const Check& check : more.checks) {
    const auto known = std::find_if(into.checks.begin(), into.checks.end(),
                                    [&](const Check& c) { return c.name == check.name; });
    if (known == into.checks.end())
      into.checks.push_back(check);
    else if (known->passed && (!check.passed || check.value * known->bound > known->value * check.bound))
      *known = check;
  }
  std::vector<std::string>& none = into.no_evidence;
  none.insert(none.end(), more.no_evidence.begin(), more.no_evidence.end());
  std::sort(none.begin(), none.end());
  none.erase(std::unique(none.begin(), none.end()), none.end());
}

}  // namespace

LawReport laws(const Call& call, Index n) { return laws(call, trial_metrics(n)); }

LawReport laws(const Call& call, const std::vector<NamedMetric>& metrics) {
  LawReport report;
  for (const NamedMetric& metric : metrics) try {
      const Function f = function_in(call, metric.W);
      take(report, laws(f, few_points(f, metric.W), {metric}));
    } catch (const InvalidInput& error) {
      Check refused = check_that("the laws can be tried", 1, 0);
      refused.counterexample = metric.name + " metric: " + error.what();
      take(report, {{refused}, {}});
    }
  return report;
}

}  // namespace convex::inline law_checks
