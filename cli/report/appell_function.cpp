#include "cli/report/appell_function.hpp"

#include <cmath>

namespace cli::inline reports {

std::string appell_function(const Scene& scene, std::string (*number)(double)) {
  const auto& problem = scene.problem;
  const convex::Index n = problem.dimension();
  std::string text;
  const auto add = [&](double coefficient, const std::string& power) {
    if (coefficient == 0) return;
    text += text.empty() ? (coefficient < 0 ? "-" : "") : (coefficient < 0 ? " - " : " + ");
    if (std::abs(coefficient) != 1) text += number(std::abs(coefficient)) + " ";
    text += power;
  };
  const auto acceleration = [&](convex::Index i) {
    return scene.coordinates[static_cast<std::size_t>(i)] + "''";
  };
  for (convex::Index j = 0; j < n; ++j) {
    const convex::Vector column = problem.A.multiply(convex::Vector::Unit(n, j));
    add(column[j] / 2, acceleration(j) + "^2");
    for (convex::Index i = j + 1; i < n; ++i) add(column[i], acceleration(j) + " " + acceleration(i));
  }
  for (convex::Index i = 0; i < n; ++i) add(-problem.z[i], acceleration(i));
  return text;
}

}  // namespace cli::inline reports
