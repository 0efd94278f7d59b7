// Time to derive A, z, U, s from a built tape, and to read a family from text.
//   derivation_speed [--smoke]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "mechanics/gauss_problem.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace {

using mechanics::LagrangianText;
using mechanics::NamedText;
using mechanics::StateText;

NamedText named(const std::string& name, const std::string& value) { return {{name, {}}, {value, {}}}; }

/// A chain of N links hanging from a pivot at 45 degrees, with a wall that its end touches at rest.
std::pair<LagrangianText, StateText> pendulum_chain(int N) {
  LagrangianText text;
  text.coordinates = {{"a[1..N]", {}}};
  text.kinetic = {"sum(i in 1..N, m/2*(X[i]'^2 + Y[i]'^2))", {}};
  text.potential = mechanics::Text{"sum(i in 1..N, m*g*Y[i])", {}};
  text.parameters = {named("N", std::to_string(N)), named("m", "1"), named("g", "9.81"), named("l", "0.1")};
  text.definitions = {named("X[0]", "0"), named("Y[0]", "0"), named("X[i in 1..N]", "X[i-1] + l*sin(a[i])"),
                      named("Y[i in 1..N]", "Y[i-1] - l*cos(a[i])")};
  text.constraints = {named("wall", "X[N] <= N*l*sin(pi/4)")};
  StateText state;
  state.position = {named("a[i]", "pi/4")};
  return {text, state};
}

/// A column of N balls at rest.
std::pair<LagrangianText, StateText> column(int N) {
  LagrangianText text;
  text.coordinates = {{"x[1..N]", {}}};
  text.kinetic = {"sum(i in 1..N, m/2*x[i]'^2)", {}};
  text.parameters = {named("N", std::to_string(N)), named("m", "1"), named("r", "0.5")};
  text.forces = {named("x[i]", "-m*9.81")};
  text.constraints = {named("floor", "x[1] >= r"), named("gap[i in 1..N-1]", "x[i+1] - x[i] >= 2*r")};
  StateText state;
  state.position = {named("x[i]", "r + 2*r*(i-1)")};
  return {text, state};
}

template <class Work>
double seconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const char* name, const std::pair<LagrangianText, StateText>& texts, int repetitions) {
  std::unique_ptr<const mechanics::LagrangianSystem> system;
  mechanics::State state;
  const double read = seconds([&] {
    system = mechanics::lagrangian_system(texts.first);
    state = system->state(texts.second);
  });
  std::vector<double> derive;
  std::vector<convex::Index> all;
  for (std::size_t a = 0; a < system->constraints().size(); ++a) all.push_back(static_cast<convex::Index>(a));
  for (int k = 0; k < repetitions; ++k)
    derive.push_back(seconds([&] {
      system->inertia(state);
      system->contact_rows(state, all);
    }));
  std::sort(derive.begin(), derive.end());
  const convex::Vector tolerance =
      convex::Vector::Constant(static_cast<convex::Index>(all.size()), mechanics::default_contact_tolerance);
  mechanics::GaussSolution solution;
  const double solve = seconds(
      [&] { solution = mechanics::solve(mechanics::gauss_problem(*system, state, tolerance).problem); });
  std::printf(
      "%-28s read %9.3f ms   A, z, U, s from the tape %9.4f ms (median)   solve and judge %9.3f ms  %s\n",
      name, read * 1e3, derive[derive.size() / 2] * 1e3, solve * 1e3,
      solution.primal.status == convex::Status::solved ? "solved" : "NOT SOLVED");
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  const int repetitions = smoke ? 1 : 51;
  measure("pendulum chain, 64 links", pendulum_chain(smoke ? 8 : 64), repetitions);
  measure("column, 1000 balls", column(smoke ? 10 : 1000), repetitions);
  return 0;
}
