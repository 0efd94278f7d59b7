#include "convex/nearest_point/methods/every_method.hpp"

#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/loaded_module.hpp"
#include "convex/nearest_point/methods/iteration.hpp"
#include "convex/nearest_point/reductions/whitened_problem.hpp"

namespace convex::inline algorithms {
namespace {

/// Calls of Ceres, each from the point of the last, and its iterations in each.
constexpr Index most_calls = 100, iterations_of_a_call = 100;

/// The weight of the proximal term, rows being of length 1: it falls from the first to the last.
constexpr double first_theta = 1e-2, last_theta = 1e-6, fall = 0.1;

using HingeLeastSquares = long (*)(long, long, const double*, const double*, const char*, double, double*,
                                   long);

struct Module {
  HingeLeastSquares solve = nullptr;
  std::string reason;  ///< why there is none
};

Module load() {
#ifdef MOREAU_CERES_MODULE
  const LoadedModule found =
      load_symbol(MOREAU_CERES_MODULE, MOREAU_CERES_FOLDER, "moreau_hinge_least_squares");
  if (found.symbol != nullptr) return {reinterpret_cast<HingeLeastSquares>(found.symbol), {}};
  return {nullptr, found.reason + "; build again, or take another method"};
#else
  return {nullptr, "not built: install libceres-dev and build again"};
#endif
}

const Module& module() {
  static const Module loaded = load();
  return loaded;
}

}  // namespace

std::string why_no_ceres() { return module().reason; }

Solution ceres_method(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "ceres", accuracy)) return *found;
  if (module().solve == nullptr) throw InvalidInput("method \"ceres\": " + module().reason);
  const WhitenedProblem white(problem);
  const Index n = problem.dimension(), k = white.size();
  Vector d = Vector::Zero(n), y = Vector::Zero(k), before = y;
  std::vector<char> free;
  for (Index a = 0; a < k; ++a) free.push_back(white.is_free(a) ? 1 : 0);
  double theta = first_theta;
  const Accuracy by_calls{accuracy.tolerance,
                          accuracy.step_limit > 0 ? std::min(accuracy.step_limit, most_calls) : 0};
  return iterate(
      problem, by_calls, most_calls,
      [&](Index) {
        before = y;
        const Vector push = white.b + theta * y;
        module().solve(n, k, white.V.data(), push.data(), free.data(), theta, d.data(), iterations_of_a_call);
        y = (push - white.V.transpose() * d) / theta;
        for (Index a = 0; a < k; ++a)
          if (!white.is_free(a)) y[a] = std::max(0.0, y[a]);
        theta = std::max(last_theta, fall * theta);
        return true;
      },
      [&](Index) { return unscaled("ceres", white, {}, y, y - before); });
}

}  // namespace convex::inline algorithms
