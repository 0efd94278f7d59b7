#include "cli/measurement/charted_problems.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "cli/measurement/exams.hpp"
#include "cli/measurement/motion_exams.hpp"
#include "cli/measurement/peers.hpp"
#include "cli/measurement/prox_exams.hpp"

namespace cli::inline measurement {
namespace {

using convex::Index;

constexpr double charted_condition = 1e6;

ChartedProblem of_gallery(const char* family, Index size, double difficulty, const std::string& title,
                          bool peers) {
  return {title, [=] {
            Exam exam = gallery_exam(*convex::find_family(family), size, difficulty);
            exam.name = title;
            return everybody(exam, peers);
          }};
}

ChartedProblem of_prox(Charted f, const char* title) {
  const std::string name = fmt::format("prox of {}, cond(W) 1e6", title);
  return {name, [=] {
            std::vector<Contest> all = prox_contests(f, charted_condition);
            for (Contest& contest : all) contest.problem = name;
            return all;
          }};
}

}  // namespace

std::vector<ChartedProblem> charted_problems(bool quick, bool peers) {
  std::vector<ChartedProblem> all;
  all.push_back(of_gallery("well-posed", 12, 0.5, "small dense", peers));
  if (!quick) all.push_back(of_gallery("well-posed", 150, 0.5, "large dense", peers));
  all.push_back(of_gallery("redundant", quick ? 16 : 40, 4, "redundant", peers));
  all.push_back(of_gallery("ill-conditioned", 16, 1e8, "ill-conditioned, cond(A) 1e8", peers));
  all.push_back(of_gallery("chain", quick ? 40 : 300, 1e4, "chain, mass ratio 1e4", peers));
  if (!quick) {
    all.push_back(of_gallery("hexagonal-packing", 100, 0.5, "hexagonal packing", peers));
    all.push_back(of_gallery("obstacle", 16, 0.5, "obstacle", peers));
  }
  all.push_back(of_prox(Charted::norm1, "norm1"));
  if (!quick) all.push_back(of_prox(Charted::simplex, "the simplex"));
  all.push_back(of_prox(Charted::ball2, "a ball"));
  if (!quick) all.push_back(of_prox(Charted::second_order_cone, "a second-order cone"));
  return all;
}

std::vector<ChartedProblem> profiled_problems(bool quick, bool peers) {
  const Index small = quick ? 6 : 12;
  std::vector<ChartedProblem> all;
  for (const convex::GalleryFamily& family : convex::gallery()) {
    if (family.name == "infeasible") continue;
    const std::vector<double> usual{family.usual};
    for (const double difficulty : quick ? std::span<const double>(usual) : family.ladder)
      all.push_back(of_gallery(family.name.data(), small, difficulty,
                               fmt::format("{} {:g}", family.name, difficulty), peers));
  }
  return all;
}

std::vector<ChartedProblem> charted_motions(bool quick) {
  std::vector<ChartedProblem> all;
  const auto add = [&](const MotionExam& exam) {
    all.push_back({exam.name, [exam] { return motion_contests(exam); }});
  };
  const std::vector<double> falls = quick ? std::vector{2.} : std::vector{2., 6., 8.5},
                            swings = quick ? std::vector{20.} : std::vector{2., 20., 200.};
  for (const double until : falls) add(falling_ball(until));
  for (const double until : swings) add(stopped_oscillator(until));
  for (const int periods : quick ? std::vector{1} : std::vector{1, 10, 100}) add(kepler_orbit(periods));
  for (const int count : quick ? std::vector{1, 16} : std::vector{1, 4, 16, 64, 256, 1024})
    add(many_balls(count));
  return all;
}

ChartedProblem charted_file(const std::string& file, const std::vector<std::string>& settings, bool peers) {
  const auto exam = std::make_shared<const Exam>(file_exam(read_scene(file, {}, {settings})));
  return {exam->name, [exam, peers] { return everybody(*exam, peers); }};
}

}  // namespace cli::inline measurement
