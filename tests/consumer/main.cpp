#include <algorithm>
#include <cmath>
#include <cstdio>

#include "convex/laws/laws.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/lagrangian_text.hpp"
#include "mechanics/motion/motion.hpp"

/// f(x) = |a·x - b|, a function of our own with its prox in any metric.
struct Misfit {
  convex::Vector a;
  double b;
  double operator()(const convex::Vector& x) const { return std::abs(a.dot(x) - b); }
  convex::Vector prox(const convex::Vector& z, const convex::Metric& W) const {
    const convex::Vector normal = W.solve(a);
    return z - std::clamp((a.dot(z) - b) / a.dot(normal), -1.0, 1.0) * normal;
  }
};

/// A point of mass 2, one metre above a floor, as text: it lands and stays.
double height_at_the_end() {
  mechanics::LagrangianText text;
  text.coordinates = {{"y", {}}};
  text.kinetic = {"y'^2", {}};
  text.potential = mechanics::Text{"2*9.81*y", {}};
  text.constraints = {{{"floor", {}}, {"y >= 0", {}}}};
  const auto system = mechanics::lagrangian_system(text);
  mechanics::Motion motion(*system, mechanics::State{0, convex::Vector{{1}}, convex::Vector{{0}}}, {});
  while (motion.advance(2)) {
  }
  return motion.state().q[0];
}

int main() {
  const convex::LawReport report = convex::laws(Misfit{convex::Vector::LinSpaced(3, 1, 3), 0.5}, 3);
  std::puts(report.text().c_str());
  // A point of mass 2 that gravity presses on a floor: the floor pushes back with its weight.
  const auto number = [](double x) { return convex::Vector::Constant(1, x); };
  const convex::ConstraintRows rows{convex::RowMatrix::Identity(1, 1)};
  const auto solution =
      mechanics::solve({convex::Metric::diagonal(number(2)), number(-19.62), rows, number(0), {}});
  std::printf("reaction of the floor: %g\n", solution.reaction[0]);
  const double height = height_at_the_end();
  std::printf("height at the end: %g\n", height);
  return report.all_passed() && std::abs(solution.reaction[0] - 19.62) < 1e-12 && height == 0 ? 0 : 1;
}
