#include "convex/laws/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/laws/remembered.hpp"

namespace convex::inline law_checks {
namespace {

using LawsAt =
    std::function<std::vector<Check>(const Trial&, const std::vector<Vector>&, std::vector<std::string>&)>;
using LawsIn = std::function<LawsAt(const Metric&)>;

std::string shown(const Vector& x) {
  std::string text = "[";
  for (Index i = 0; i < x.size(); ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.17g", i > 0 ? ", " : "", x[i]);
    text += number;
  }
  return text + "]";
}

/// Does the law of that name still fail at this simpler point?
bool still_fails(const LawsAt& at, const Trial& trial, const std::vector<Vector>& others,
                 const std::string& name) {
  std::vector<std::string> ignored;
  const std::vector<Check> checks = at(trial, others, ignored);
  return std::any_of(checks.begin(), checks.end(),
                     [&](const Check& c) { return c.name == name && !c.passed; });
}

/// The counterexample made smaller: entries that may be 0 are, the others keep as few digits as the failure
/// allows.
Vector smaller(const LawsAt& at, Trial trial, const std::vector<Vector>& others, const std::string& name) {
  for (Index i = 0; i < trial.z.size(); ++i) {
    const double entry = trial.z[i];
    const double size = std::abs(entry) > 0 ? std::pow(10, std::floor(std::log10(std::abs(entry)))) : 1;
    for (double simpler : {0.0, entry > 0 ? 1.0 : -1.0, std::round(entry), std::round(entry / size) * size,
                           std::round(10 * entry / size) * size / 10}) {
      trial.z[i] = simpler;
      if (still_fails(at, trial, others, name)) break;
      trial.z[i] = entry;
    }
  }
  return trial.z;
}

/// A wrong function fails many laws; the counterexamples of so many are made smaller, which takes trials.
constexpr int most_made_smaller = 3;

LawReport tried(const LawsIn& laws_in, const std::vector<Vector>& points,
                const std::vector<NamedMetric>& metrics, const std::vector<Vector>& others) {
  LawReport report;
  int failed = 0;
  for (const NamedMetric& metric : metrics) {
    const LawsAt at = laws_in(metric.W);
    for (const Vector& z : points) {
      const Trial trial{z, metric.W, metric.name};
      for (Check& check : at(trial, others, report.no_evidence)) {
        const auto known = std::find_if(report.checks.begin(), report.checks.end(),
                                        [&](const Check& c) { return c.name == check.name; });
        if (known != report.checks.end() && !known->passed) continue;
        if (!check.passed) {
          const bool shown_enough = ++failed > most_made_smaller;
          const Vector small = shown_enough ? z : smaller(at, trial, others, check.name);
          check.counterexample = "z = " + shown(small) + ", metric " + metric.name;
        }
        if (known == report.checks.end())
          report.checks.push_back(check);
        else if (!check.passed || check.value * known->bound > known->value * check.bound)
          *known = check;
      }
    }
  }
  std::sort(report.no_evidence.begin(), report.no_evidence.end());
  report.no_evidence.erase(std::unique(report.no_evidence.begin(), report.no_evidence.end()),
                           report.no_evidence.end());
  return report;
}

/// Points that others are compared with; two of them keep the laws, which look at pairs, quick.
std::vector<Vector> companions(Index n) {
  const std::vector<Vector> points = trial_points(n);
  return {points[3], points[6], points[8]};
}

/// The points, and, since errors live near solutions, the prox points of some, and points just outside those.
std::vector<Vector> points_near_solutions(const Subject& f, Index n) {
  std::vector<Vector> points = trial_points(n);
  const Metric plain = Metric::identity(n);
  for (std::size_t k : {std::size_t{3}, std::size_t{7}}) {
    const Vector z = points[k], x = f.prox(z, plain).x;
    points.push_back(x);
    points.push_back(x + (z - x) / 1024);
  }
  return points;
}

}  // namespace

std::string LawReport::text() const {
  std::string text;
  for (const Check& check : checks) {
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, " (%.2g, bound %.2g)", check.value, check.bound);
    text += (check.passed ? "passed  " : "FAILED  ") + check.name + numbers;
    if (!check.counterexample.empty()) text += " at " + check.counterexample;
    text += "\n";
  }
  for (const std::string& line : no_evidence) text += "no evidence  " + line + "\n";
  return text;
}

Prox given_prox(Vector x, Index n) {
  if (x.size() != n)
    throw InvalidInput("prox: it gave " + counted(x.size(), "entry", "entries") + " at a point of " +
                       std::to_string(n) + "; return as many");
  return {std::move(x), {}, 0, 0, ProxRoute::closed_form, "given", Status::solved};
}

LawReport laws(const Subject& given, Index n) {
  const Subject f = remembered(given);
  const LawsAt at = [&](const Trial& trial, const std::vector<Vector>& others, std::vector<std::string>&) {
    return prox_laws(f, trial, others);
  };
  return tried([&](const Metric&) { return at; }, points_near_solutions(f, n), trial_metrics(n),
               companions(n));
}

LawReport laws(const Subject& given, const std::function<Subject(const Metric&)>& conjugate, Index n,
               bool cone) {
  const Subject f = remembered(given);
  const auto laws_in = [&](const Metric& W) -> LawsAt {
    const ConjugatePair pair{f, remembered(conjugate(W)), cone};
    return
        [pair](const Trial& trial, const std::vector<Vector>& others, std::vector<std::string>& no_evidence) {
          std::vector<Check> checks = prox_laws(pair.f, trial, others);
          for (Check& check : conjugate_laws(pair, trial, others, no_evidence))
            checks.push_back(std::move(check));
          return checks;
        };
  };
  return tried(laws_in, points_near_solutions(f, n), trial_metrics(n), companions(n));
}

LawReport laws(const Function& f, const std::vector<Vector>& points,
               const std::vector<NamedMetric>& metrics) {
  const auto laws_in = [&](const Metric& W) -> LawsAt {
    ConjugatePair pair = conjugate_pair(f, W);
    pair.f = remembered(pair.f);
    pair.g = remembered(pair.g);
    return [&f, pair](const Trial& trial, const std::vector<Vector>& others,
                      std::vector<std::string>& no_evidence) {
      std::vector<Check> checks = prox_laws(pair.f, trial, others);
      for (Check& check : conjugate_laws(pair, trial, others, no_evidence))
        checks.push_back(std::move(check));
      for (Check& check : function_laws(f, pair.f, trial, others, no_evidence))
        checks.push_back(std::move(check));
      return checks;
    };
  };
  const Index n = points.empty() ? 0 : points.front().size();
  return tried(laws_in, points, metrics, companions(n));
}

LawReport laws(const Function& f, Index n) {
  const Subject subject = conjugate_pair(f, Metric::identity(n)).f;
  return laws(f, points_near_solutions(subject, n), trial_metrics(n));
}

}  // namespace convex::inline law_checks
