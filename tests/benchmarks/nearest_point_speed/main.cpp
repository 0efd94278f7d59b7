// The nearest point from bare (A, z, U, s) beside a floor and beside other solvers, in one process, in turn.
//   nearest_point_speed [--smoke] [--markdown] [--rounds N] [TEXT...]     families whose name contains a TEXT
// A line: family, microseconds of ours, ours in doubles (`refine` off), the floor, and each peer that the
// program was built with; ours over the floor; ours over the fastest peer that is right; whether ours is
// right. A peer that is not right, to 1e-9 on all problems of the family, bears a mark. Processor time, least
// of N rounds, means over the problems. Warm: eight problems about the first, again and again, per solve; the
// floor is that of a cold one. Exits 1 when an answer of ours is not right.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "clock.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/repeated_problem.hpp"
#include "floor.hpp"
#include "peers.hpp"
#include "truth.hpp"

namespace {

using speed::DenseProblem;
using speed::Outcome;
using speed::Peer;
using speed::Truth;

struct Cost {
  double seconds = 0;
  bool known = true, right = true;
};

struct Line {
  Cost ours, in_doubles, floor;
  std::vector<Cost> peers = std::vector<Cost>(speed::peer_kinds().size());
};

convex::Accuracy in_doubles() {
  convex::Accuracy accuracy;
  accuracy.refine = false;
  return accuracy;
}

bool is_right(const DenseProblem& problem, const Truth& truth, Outcome outcome, const speed::Vector& q) {
  if (!truth.feasible) return outcome == Outcome::infeasible;
  return outcome == Outcome::solved && error_of(problem, truth, q) <= speed::right_to;
}

volatile double sink;  // what a floor finds goes here, or it would be left out

void time_all(speed::Clock& clock, const speed::Floor& floor, int rounds, Line& line) {
  clock.add([&] { sink = floor.run(); });
  clock.run(rounds);
  std::size_t work = 0;
  line.ours.seconds += clock.least(work++);
  line.in_doubles.seconds += clock.least(work++);
  for (Cost& peer : line.peers)
    if (peer.known) peer.seconds += clock.least(work++);
  line.floor.seconds += clock.least(work);
}

std::vector<std::unique_ptr<Peer>> make_peers(const DenseProblem& problem, Line& line) {
  std::vector<std::unique_ptr<Peer>> peers;
  for (std::size_t k = 0; k < line.peers.size(); ++k) {
    peers.push_back(speed::peer_kinds()[k].make(problem));
    line.peers[k].known = peers.back() != nullptr;
  }
  return peers;
}

void cold(const DenseProblem& problem, int rounds, Line& line) {
  const Truth truth = truth_of(problem);
  const auto ours = [&](const convex::Accuracy& accuracy) {
    return convex::automatic(assembled(problem), accuracy);
  };
  speed::Clock clock;
  for (auto& [cost, accuracy] :
       {std::pair{&line.ours, convex::Accuracy{}}, {&line.in_doubles, in_doubles()}}) {
    cost->right = cost->right && is_right(problem, truth, ours(accuracy));
    clock.add([&ours, accuracy = accuracy] { ours(accuracy); });
  }
  const auto peers = make_peers(problem, line);
  for (std::size_t k = 0; k < peers.size(); ++k) {
    if (!peers[k]) continue;
    const Outcome outcome = peers[k]->cold();
    line.peers[k].right = line.peers[k].right && is_right(problem, truth, outcome, peers[k]->answer);
    clock.add([&peer = *peers[k]] { peer.cold(); });
  }
  time_all(clock, speed::Floor(problem, truth), rounds, line);
}

void warm(const DenseProblem& problem, bool move_bounds, int rounds, Line& line) {
  const std::vector<DenseProblem> points = speed::moved(problem, move_bounds);
  std::vector<Truth> truths;
  for (const DenseProblem& point : points) truths.push_back(truth_of(point));
  speed::Clock clock;
  // The second time round everything is warm.
  const auto add = [&](Cost& cost, const auto& solve, const auto& right) {
    for (std::size_t i = 0; i < 2 * points.size(); ++i) {
      const std::size_t at = i % points.size();
      solve(points[at]);
      cost.right = cost.right && right(points[at], truths[at]);
    }
    const auto round = [&points, solve] {
      for (const DenseProblem& point : points) solve(point);
    };
    clock.add(round, static_cast<double>(points.size()));
  };
  convex::RepeatedProblem repeated(assembled(problem)), coarse(assembled(problem), in_doubles());
  const convex::Solution* solution = nullptr;
  const auto ours_is_right = [&](const DenseProblem& at, const Truth& truth) {
    return is_right(at, truth, *solution);
  };
  add(
      line.ours, [&](const DenseProblem& at) { solution = &repeated.solve(at.z, at.s); }, ours_is_right);
  add(
      line.in_doubles, [&](const DenseProblem& at) { solution = &coarse.solve(at.z, at.s); }, ours_is_right);
  const auto peers = make_peers(problem, line);
  Outcome outcome = Outcome::failed;
  for (std::size_t k = 0; k < peers.size(); ++k)
    if (Peer* peer = peers[k].get())
      add(
          line.peers[k], [&outcome, peer](const DenseProblem& at) { outcome = peer->again(at.z, at.s); },
          [&](const DenseProblem& at, const Truth& truth) {
            return is_right(at, truth, outcome, peer->answer);
          });
  time_all(clock, speed::Floor(problem, truth_of(problem)), rounds, line);
}

void print(const speed::Family& family, const Line& line, double problems, bool markdown) {
  const char* bar = markdown ? " | " : " ";
  std::printf("%s%-26s", markdown ? "| " : "", family.name.c_str());
  const auto cell = [&](const Cost& cost) {
    if (cost.known)
      std::printf("%s%10.2f%s", bar, 1e6 * cost.seconds / problems, cost.right ? " " : "!");
    else
      std::printf("%s%10s ", bar, "-");
  };
  cell(line.ours), cell(line.in_doubles), cell(line.floor);
  std::size_t fastest = line.peers.size();
  for (std::size_t k = 0; k < line.peers.size(); ++k) {
    const Cost& peer = line.peers[k];
    cell(peer);
    if (peer.known && peer.right &&
        (fastest == line.peers.size() || peer.seconds < line.peers[fastest].seconds))
      fastest = k;
  }
  std::printf("%s%7.2f", bar, line.ours.seconds / line.floor.seconds);
  if (fastest == line.peers.size())
    std::printf("%s%7s %-10s", bar, "-", "");
  else
    std::printf("%s%7.2f %-10s", bar, line.ours.seconds / line.peers[fastest].seconds,
                speed::peer_kinds()[fastest].name.data());
  std::printf("%s%s%s\n", bar, line.ours.right ? "right" : "NOT RIGHT", markdown ? " |" : "");
  std::fflush(stdout);
}

void print_head(bool markdown) {
  const char* bar = markdown ? " | " : " ";
  std::printf("%s%-26s", markdown ? "| " : "", "family");
  for (const char* column : {"ours (us)", "doubles", "floor"}) std::printf("%s%10s ", bar, column);
  for (const speed::PeerKind& peer : speed::peer_kinds()) std::printf("%s%10.10s ", bar, peer.name.data());
  std::printf("%s%7s%s%-18s%sours%s\n", bar, "/ floor", bar, " / fastest right", bar, markdown ? " |" : "");
  if (markdown) std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

}  // namespace

int main(int argc, char** argv) {
  bool smoke = false, markdown = false, all_right = true;
  int rounds = 15;
  std::vector<const char*> texts;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--smoke") == 0)
      smoke = true;
    else if (std::strcmp(argv[i], "--markdown") == 0)
      markdown = true;
    else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
      rounds = std::max(1, std::atoi(argv[++i]));
    else
      texts.push_back(argv[i]);
  }
  print_head(markdown);
  for (const speed::Family& family : speed::families()) {
    bool wanted = texts.empty();
    for (const char* text : texts) wanted = wanted || family.name.find(text) != std::string::npos;
    if (!wanted || (smoke && family.coordinates > 20)) continue;
    Line line;
    const unsigned seeds = smoke ? 1 : static_cast<unsigned>(family.seeds);
    for (unsigned seed = 0; seed < seeds; ++seed) {
      const DenseProblem problem = family.make(seed);
      if (family.asked == speed::Asked::cold)
        cold(problem, smoke ? 1 : rounds, line);
      else
        warm(problem, family.move_bounds, smoke ? 1 : rounds, line);
    }
    print(family, line, seeds, markdown);
    all_right = all_right && line.ours.right;
  }
  return all_right ? 0 : 1;
}
