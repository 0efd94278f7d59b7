#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/drawing/label_column.hpp"
#include "cli/measurement/cone_exams.hpp"
#include "cli/measurement/exams.hpp"
#include "cli/measurement/prox_exams.hpp"
#include "cli/measurement/rank_correlation.hpp"
#include "cli/measurement/vector_exam.hpp"

using namespace cli;

namespace {

Trial timed_trial(const char* method, double seconds, double error = 1e-12) {
  Trial t;
  t.problem = "one";
  t.method = method;
  t.seconds = seconds;
  t.judgement.error = error;
  return t;
}

}  // namespace

TEST_CASE("labels keep their order, stand apart and inside, and stay where they want to be when they can") {
  for (const std::vector<double>& wanted : std::vector<std::vector<double>>{
           {5}, {1, 9, 5}, {5, 5, 5, 5}, {-3, -3, 12, 12}, {0, 0.1, 0.2, 8}, {9.9, 9.8, 9.7}}) {
    const std::vector<double> placed = label_positions(wanted, 1, 0, 10);
    REQUIRE(placed.size() == wanted.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      CHECK(placed[i] >= -1e-12);
      CHECK(placed[i] <= 10 + 1e-12);
      for (std::size_t j = 0; j < placed.size(); ++j) {
        if (i != j) CHECK(std::abs(placed[i] - placed[j]) >= 1 - 1e-12);
        if (wanted[i] < wanted[j]) CHECK(placed[i] < placed[j]);
      }
    }
  }
  CHECK(label_positions({1, 9, 5}, 1, 0, 10) == std::vector<double>{1, 9, 5});
  const std::vector<double> crowded = label_positions(std::vector<double>(30, 5.0), 1, 0, 10);
  CHECK(*std::min_element(crowded.begin(), crowded.end()) >= -1e-9);
  CHECK(*std::max_element(crowded.begin(), crowded.end()) <= 10 + 1e-9);
}

TEST_CASE("the rank correlation is 1 for the same order, -1 for the opposite one, by Spearman between") {
  const std::vector<Trial> first{timed_trial("a", 1), timed_trial("b", 2), timed_trial("c", 3)},
      slower{timed_trial("a", 10), timed_trial("b", 30), timed_trial("c", 31)},
      opposite{timed_trial("a", 9), timed_trial("b", 5), timed_trial("c", 1)},
      swapped{timed_trial("b", 1), timed_trial("a", 2), timed_trial("c", 3)};
  CHECK(rank_correlations(first, slower)[0].value == doctest::Approx(1));
  CHECK(rank_correlations(first, opposite)[0].value == doctest::Approx(-1));
  CHECK(rank_correlations(first, swapped)[0].value == doctest::Approx(0.5));  // 1 - 6 (1 + 1)/(3 (9 - 1))
}

TEST_CASE("an answer that misses 1e-9 has the last place, however fast it came") {
  const std::vector<Trial> first{timed_trial("a", 1, 1e-3), timed_trial("b", 2), timed_trial("c", 3)},
      second{timed_trial("b", 2), timed_trial("c", 3), timed_trial("a", 9)};
  CHECK(rank_correlations(first, second)[0].value == doctest::Approx(1));
}

TEST_CASE("the planted proxes and projections are what the default finds, to rounding") {
  const auto check = [](const std::vector<Contest>& contests, double most) {
    for (const Contest& contest : contests) {
      if (contest.method != "auto") continue;
      CAPTURE(contest.problem);
      contest.work({});
      const Judgement judged = contest.judged();
      CHECK(judged.verdict == Verdict::ok);
      CHECK(judged.error <= most);
    }
  };
  for (const Charted f : {Charted::norm1, Charted::simplex, Charted::ball2, Charted::second_order_cone})
    for (const double condition : {1.0, 1e3, 1e6}) check(prox_contests(f, condition), 1e-13);
  for (const Sorting f : {Sorting::simplex, Sorting::ball1, Sorting::sum_largest})
    for (const double gap : {1.0, 1e-7, 1e-14, 0.0}) check(tie_contests(f, gap), 1e-15);
  // The part in the polar keeps as many digits as the distance from the boundary leaves.
  for (const CurvedCone cone : {CurvedCone::exponential, CurvedCone::power})
    for (const double distance : {1.0, 1e-4, 1e-8, 1e-12})
      check(boundary_contests(cone, distance), 1e-14 / distance);
  for (const double slope : {1.0, 1e-5, 1e-14}) check(flat_polar_contests(slope), 1e-14);
}

TEST_CASE("a trial tells apart what is right, wrong, given up, crashed, too slow and refused") {
  using convex::Vector;
  const Vector truth{{3, 4}};
  const auto answer = [&](double off, double bound, bool gave_up = false) {
    return [=](double) { return FoundVector{truth + Vector{{off, 0}}, bound, gave_up}; };
  };
  const auto direct = convex::MethodKind::direct;
  std::vector<Way> ways{{"right", direct, "", answer(1e-10, 1e-10)},
                        {"wrong", direct, "", answer(1e-8, 1e-10)},
                        {"wrong at rounding", direct, "", answer(1e-13, 0)},
                        {"gave up", direct, "", answer(1, 1, true)},
                        {"without a bound", direct, "", answer(0, INFINITY)},
                        {"crashed", direct, "", [](double) -> FoundVector { std::abort(); }},
                        {"threw", direct, "", [](double) -> FoundVector { throw std::bad_alloc(); }},
                        {"too slow", direct, "",
                         [](double) -> FoundVector {
                           for (volatile int k = 0;;) k = k + 1;
                         }},
                        {"refused", direct, "does not apply", {}}};
  const std::vector<Verdict> expected{Verdict::ok,      Verdict::wrong,    Verdict::wrong,
                                      Verdict::gave_up, Verdict::gave_up,  Verdict::crashed,
                                      Verdict::crashed, Verdict::too_slow, Verdict::refused};
  const std::vector<Contest> all =
      contests({"two numbers", convex::Metric::identity(2), convex::DoubleDoubleVector(truth), 5}, ways);
  for (std::size_t k = 0; k < all.size(); ++k) {
    CAPTURE(all[k].method);
    const Trial t = trial(all[k], {}, {1e-6, 0.2});
    CHECK(verdict_text(t.verdict()) == verdict_text(expected[k]));
    if (all[k].method == "right") CHECK(t.judgement.error == doctest::Approx(1e-10 / 5));
  }
}

TEST_CASE("an answer to a problem that has none is wrong, unless only rounding speaks against it") {
  const Exam hopeless = gallery_exam(*convex::find_family("infeasible"), 8, 1);
  convex::Solution said;
  said.status = convex::Status::solved;
  said.q = convex::Vector::Zero(8);
  said.error_bound = 1e-12;
  CHECK(judgement(hopeless, said).verdict == Verdict::wrong);
  said.status = convex::Status::gave_up;
  CHECK(judgement(hopeless, said).verdict == Verdict::gave_up);
  said.status = convex::Status::infeasible;
  CHECK(judgement(hopeless, said).verdict == Verdict::ok);
  Exam solvable = gallery_exam(*convex::find_family("well-posed"), 8, 0.5);
  CHECK(judgement(solvable, said).verdict == Verdict::wrong);
}
