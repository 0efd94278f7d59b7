#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cli/measurement/charted_problems.hpp"
#include "cli/measurement/peers.hpp"
#include "cli/measurement/stress_families.hpp"
#include "cli/measurement/trial.hpp"

/// What docs/speed-and-accuracy.md and docs/where-methods-fail.md claim, rerun small: digits and who fails,
/// never times.
namespace {

using cli::Contest;
using cli::Trial;
using cli::Verdict;

constexpr int failed = -1, all_digits = 15;
constexpr cli::TrialLimits limits{1e-6, 3};

/// Digits of the true error, at most 16; `failed` when the method did not answer, or said that it is unsure.
int digits(const Trial& t) {
  if (!t.is_right()) return failed;
  const double error = t.judgement.error;
  return error > 0 ? std::clamp(static_cast<int>(-std::log10(error)), 0, 16) : 16;
}

/// A method's own answer on a family's problem of so many coordinates.
Trial own(const char* family, double setting, const char* method, convex::Index size = 12,
          bool polish = false) {
  for (const cli::StressFamily& one : cli::stress_families(size, cli::why_no_peers().empty())) {
    if (one.name != family) continue;
    for (const Contest& contest : one.at(setting))
      if (contest.method == method) return cli::trial(contest, {.tolerance = 1e-9, .polish = polish}, limits);
  }
  FAIL("no such family or method");
  return {};
}

int own_digits(const char* family, double setting, const char* method) {
  CAPTURE(family);
  CAPTURE(setting);
  CAPTURE(method);
  const Trial t = own(family, setting, method);
  CHECK(t.verdict() != Verdict::wrong);
  return digits(t);
}

const std::vector<const char*> iterations{
    "semismooth-newton", "proximal-point",       "admm",
    "interior-point",    "accelerated-gradient", "projected-gauss-seidel"};

}  // namespace

TEST_CASE("claim: the default has all digits on every charted problem") {
  for (const cli::ChartedProblem& problem : cli::charted_problems(true, false))
    for (const Contest& contest : problem.contests()) {
      if (contest.method != "auto") continue;
      CAPTURE(problem.name);
      CHECK(digits(cli::trial(contest, {}, limits)) >= all_digits);
    }
}

TEST_CASE("claim: iterations deliver what they are asked for on a well-posed problem") {
  for (const char* method : iterations)
    for (const double asked : {1e-3, 1e-6, 1e-9}) {
      CAPTURE(method);
      CAPTURE(asked);
      for (const Contest& contest : cli::charted_problems(true, false).front().contests()) {
        if (contest.method != method) continue;
        const Trial t = cli::trial(contest, {.tolerance = asked, .polish = false}, limits);
        CHECK(t.is_right());
        CHECK(t.judgement.error <= 10 * asked);
      }
    }
}

TEST_CASE("claim: refinement of the rows found gives an iteration, or a pivoting, all digits") {
  for (const char* method : {"block-pivoting", "lemke", "nnls", "semismooth-newton", "proximal-point", "admm",
                             "accelerated-gradient", "projected-gauss-seidel"}) {
    CAPTURE(method);
    const int before = digits(own("redundant", 2, method)),
              after = digits(own("redundant", 2, method, 12, true));
    CHECK(before >= 7);
    CHECK(after >= all_digits);
    CHECK(after >= before);
  }
}

TEST_CASE(
    "claim: heavy on light, the default, block-pivoting's finite steps, ceres and exact keep all digits at a "
    "mass ratio of 1e16") {
  CHECK(own_digits("heavy-on-light", 1e16, "block-pivoting") >= all_digits);
  for (const char* method : {"auto", "active-set", "ceres", "exact", "certified"})
    for (const double ratio : {1e4, 1e10, 1e16})
      CHECK(own_digits("heavy-on-light", ratio, method) >= all_digits);
  for (const char* method : iterations) CHECK(own_digits("heavy-on-light", 1e16, method) == failed);
  CHECK(own_digits("heavy-on-light", 1e16, "lemke") == failed);
  CHECK(own_digits("heavy-on-light", 1e16, "nnls") < 5);
  CHECK(own_digits("heavy-on-light", 1e2, "nnls") > 12);
  CHECK(own_digits("heavy-on-light", 1e10, "projected-gauss-seidel") == failed);
  CHECK(own_digits("heavy-on-light", 1e10, "admm") == failed);
}

TEST_CASE("claim: a flat wedge stops neither the default nor fractions, and most methods") {
  for (const double angle : {1e-4, 1e-8, 1e-12}) {
    CHECK(own_digits("near-opposite", angle, "auto") >= all_digits);
    CHECK(own_digits("near-opposite", angle, "lemke") == failed);
    CHECK(own_digits("near-opposite", angle, "projected-gauss-seidel") == failed);
  }
  CHECK(own_digits("near-opposite", 1e-16, "auto") >= all_digits);
  CHECK(own_digits("near-opposite", 1e-16, "exact") >= all_digits);
  CHECK(own_digits("near-opposite", 1e-16, "certified") >= all_digits);
  CHECK(own_digits("near-opposite", 1e-12, "nnls") < own_digits("near-opposite", 1e-4, "nnls"));
}

TEST_CASE("claim: pivoting by blocks ends, whatever the condition of A and however many the rows") {
  for (const double condition : {1e10, 1e12, 1e14, 1e16})
    CHECK(own_digits("ill-conditioned", condition, "block-pivoting") >= all_digits);
  for (const double rows : {10.0, 100.0, 200.0}) CHECK(own_digits("tall", rows, "block-pivoting") >= 9);
  for (const double angle : {1e-6, 1e-12}) CHECK(own_digits("near-opposite", angle, "block-pivoting") >= 9);
}

TEST_CASE("claim: an ill-conditioned A costs the default nothing, first-order iterations the answer") {
  for (const double condition : {1e4, 1e10, 1e16})
    CHECK(own_digits("ill-conditioned", condition, "auto") >= all_digits);
  for (const char* method : {"admm", "accelerated-gradient", "projected-gauss-seidel"}) {
    CHECK(own_digits("ill-conditioned", 1, method) >= 9);
    CHECK(own_digits("ill-conditioned", 1e12, method) == failed);
  }
  for (const char* method : {"semismooth-newton", "proximal-point"}) {
    CHECK(own_digits("ill-conditioned", 1e10, method) >= 9);
    CHECK(own_digits("ill-conditioned", 1e16, method) == failed);
  }
}

TEST_CASE("claim: weakly active rows stop the interior point, and nobody who pivots") {
  CHECK(own_digits("weakly-active", 1, "interior-point") >= 9);
  CHECK(own_digits("weakly-active", 1e-8, "interior-point") == failed);
  CHECK(own_digits("weakly-active", 0, "interior-point") == failed);
  for (const double slack : {1e-4, 1e-10, 0.0})
    for (const char* method : {"auto", "active-set", "nnls", "lemke"})
      CHECK(own_digits("weakly-active", slack, method) >= 14);
}

TEST_CASE("claim: redundant rows stop no method but the rule that drops negative multipliers") {
  int dropped = 0;
  for (const double sums : {1.0, 4.0, 16.0}) {
    for (const char* method : {"auto", "active-set", "nnls", "lemke", "block-pivoting"})
      CHECK(own_digits("redundant", sums, method) >= 8);
    for (const char* method : iterations) CHECK(own_digits("redundant", sums, method) >= 7);
    if (own_digits("redundant", sums, "drop-negative") < 4) ++dropped;
  }
  CHECK(dropped > 0);
}

TEST_CASE("claim: in tiny units an unpolished iteration keeps few digits, for tolerances are those of 1") {
  for (const double unit : {1e-150, 1e-20, 1.0, 1e20, 1e150})
    CHECK(own_digits("scaled", unit, "auto") >= all_digits);
  for (const char* method : {"admm", "accelerated-gradient", "projected-gauss-seidel"}) {
    CHECK(own_digits("scaled", 1e-20, method) < 5);
    CHECK(own_digits("scaled", 1e20, method) >= 9);
    CHECK(digits(own("scaled", 1e-20, method, 12, true)) >= all_digits);
  }
}

TEST_CASE("claim: problems without a solution are told from those with one") {
  for (const char* method : {"auto", "active-set", "nnls", "lemke", "semismooth-newton", "proximal-point",
                             "interior-point", "admm", "accelerated-gradient", "exact"})
    for (const double margin : {1.0, 1e-4, 1e-8}) {
      CAPTURE(method);
      CAPTURE(margin);
      const Trial t = own("infeasible", margin, method);
      CHECK(t.is_right());
      CHECK(t.judgement.error == 0);
    }
}

TEST_CASE("claim: the direct ways to a prox do not feel the condition of the metric, gradients do") {
  for (const char* family : {"prox-norm1", "prox-simplex", "prox-second-order-cone"}) {
    for (const char* method : {"auto", "iterative", "both-halves"})
      for (const double condition : {1.0, 1e6, 1e12}) CHECK(own_digits(family, condition, method) >= 14);
    CHECK(own_digits(family, 1e4, "proximal-gradient") >= 8);
    CHECK(own_digits(family, 1e12, "proximal-gradient") == failed);
  }
}

TEST_CASE("claim: ties cost no digit") {
  for (const char* family : {"ties-simplex", "ties-ball1", "ties-sum-largest"})
    for (const double gap : {1e-4, 1e-14, 0.0})
      for (const char* method : {"auto", "active-set", "both-halves"})
        CHECK(own_digits(family, gap, method) >= all_digits);
}

TEST_CASE("claim: near the boundary of a curved cone the polar part keeps what its distance leaves") {
  for (const char* family : {"exponential-cone-boundary", "power-cone-boundary"})
    for (const char* method : {"auto", "difference"})
      for (const int lost : {0, 4, 8}) {
        const int kept = own_digits(family, std::pow(10, -lost), method);
        CHECK(kept >= 14 - lost);
        CHECK(kept <= 18 - lost);
      }
}

TEST_CASE("claim: polars of nearly flat cones are exact by active set and by facets in fractions") {
  for (const double slope : {1.0, 1e-6, 1e-14})
    for (const char* method : {"auto", "facets"})
      CHECK(own_digits("flat-cone-polar", slope, method) >= all_digits);
}

TEST_SUITE("siconos") {
  TEST_CASE("claim: solvers of Siconos say solved where they are wrong, on a flat wedge and in tiny units") {
    for (const char* solver : {"siconos-lemke", "siconos-pgs", "siconos-newton-fb"}) {
      CAPTURE(solver);
      CHECK(digits(own("well-posed", 0.5, solver)) >= 7);
      CHECK(own("near-opposite", 1e-8, solver, 8).verdict() == Verdict::wrong);
    }
    for (const char* solver : {"siconos-pgs", "siconos-newton-fb"})
      CHECK(own("scaled", 1e-150, solver, 8).verdict() == Verdict::wrong);
  }
}
