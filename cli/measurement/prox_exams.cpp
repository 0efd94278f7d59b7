#include "cli/measurement/prox_exams.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <memory>

#include "cli/measurement/exams.hpp"
#include "cli/measurement/vector_exam.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/linear_quadratic/prox.hpp"

namespace cli::inline measurement {
namespace {

using convex::Function;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Prox;
using convex::Vector;

/// f, the metric as numbers, z, and the planted prox.
struct ProxExam {
  std::string name;
  Function f;
  Metric W;
  Vector z, x;
};

FoundVector found(const Prox& prox) {
  return {prox.x, prox.error_bound, prox.status == convex::Status::gave_up};
}

/// x = prox_f(y - W(y - z)/L) of the plain f/L, accelerated (Nesterov 1983, for a strongly convex function),
/// until ||W(x - z) + v||_(W⁻¹) <= tolerance (||z||_W + ||x||_W), v the subgradient that the plain prox
/// shows.
FoundVector proximal_gradient(const ProxExam& exam, const Metric& W, double tolerance) {
  constexpr int most_steps = 200000;
  const Vector spectrum = convex::linear_algebra::eigenvalues(W.dense_gram());
  const double L = spectrum.maxCoeff(), root = std::sqrt(spectrum.minCoeff() / L),
               momentum = (1 - root) / (1 + root);
  const Metric step = Metric::identity(exam.z.size()).scaled(L);
  Vector x = exam.z, y = exam.z, before;
  double bound = INFINITY;
  for (int k = 1; k <= most_steps; ++k) {
    before = x;
    const Vector from = y - convex::metric_difference(W, y, exam.z) / L;
    x = exam.f.prox(from, step).x;
    y = x + momentum * (x - before);
    if (k % 8 != 0 && k > 8) continue;
    bound = W.dual_norm(convex::metric_difference(W, x, exam.z) + L * (from - x));
    if (bound <= tolerance * (W.norm(exam.z) + W.norm(x))) return {x, bound, false};
  }
  return {x, bound, true};
}

std::vector<Contest> every_way(ProxExam given) {
  const double scale = std::max(given.W.norm(given.x), given.W.norm(given.z));
  VectorExam vector{given.name, given.W, convex::DoubleDoubleVector(given.x), scale};
  const auto exam = std::make_shared<const ProxExam>(std::move(given));
  const bool is_plain = exam->W.kind() == convex::MetricKind::identity;
  const Index n = exam->z.size();
  using enum convex::MethodKind;
  std::vector<Way> ways;
  ways.push_back(
      {"auto", direct, "", [exam](double) { return found(exam->f.prox(exam->z, anew(exam->W))); }});
  const bool has_form = exam->f.node().linear_quadratic(n).has_value();
  ways.push_back({"active-set", direct, has_form ? "" : "not piecewise quadratic", [exam, n](double) {
                    return found(convex::linear_quadratic::prox(*exam->f.node().linear_quadratic(n), exam->z,
                                                                anew(exam->W)));
                  }});
  const bool has_graph = exam->f.node().graph(n).has_value();
  ways.push_back({"iterative", direct, has_graph ? "" : "no graph form", [exam, n](double) {
                    return found(convex::prox(*exam->f.node().graph(n), exam->z, anew(exam->W)));
                  }});
  ways.push_back({"both-halves", direct, "", [exam](double) {
                    const convex::Decomposition split = convex::decompose(exam->f, exam->z, anew(exam->W));
                    return FoundVector{split.x.x, split.error_bound, split.status == convex::Status::gave_up};
                  }});
  ways.push_back({"proximal-gradient", iterative, is_plain ? "one step, in the plain metric" : "",
                  [exam](double tolerance) { return proximal_gradient(*exam, anew(exam->W), tolerance); }});
  return contests(std::move(vector), std::move(ways));
}

/// Of the coordinates of the exams with a Hadamard matrix.
constexpr Index order = 16;

/// Hadamard's matrix of 16 rows.
Matrix hadamard() {
  Matrix H(order, order);
  for (Index i = 0; i < order; ++i)
    for (Index j = 0; j < order; ++j) H(i, j) = std::popcount(static_cast<unsigned>(i & j)) % 2 == 0 ? 1 : -1;
  return H;
}

/// v times this is as large in ||·||_(W⁻¹) as x is in ||·||_W, and has few bits still.
double part_of(double condition) { return std::exp2(-std::round(std::log2(condition) / 2)); }

ProxExam planted(const std::string& name, Function f, const Vector& x, const Vector& v, double condition) {
  const double range = std::round(std::log2(condition));
  Vector D(order);
  for (Index k = 0; k < order; ++k)
    D[k] = std::exp2(-std::round(range * static_cast<double>(k) / (order - 1)));
  const Matrix H = hadamard();
  const Vector step = H * (H * v).cwiseQuotient(D) / static_cast<double>(order);
  return {fmt::format("{}, cond(W) {:g}", name, condition), std::move(f),
          Metric::dense(H * D.asDiagonal() * H / static_cast<double>(order)), x + step, x};
}

/// A dyadic number near x.
double dyadic(double x) { return x > 0 ? std::exp2(std::round(std::log2(x))) : 0; }

}  // namespace

std::vector<Contest> prox_contests(Charted f, double condition) {
  // Nine entries ±1 and four ±2 make up a length of 5.
  const double part = part_of(condition);
  const Vector five{{1, -1, 0, 1, 2, -1, 0, 1, -2, 1, -1, 2, 0, 1, -2, 1}};
  Vector v(order), x = five;
  switch (f) {
    case Charted::norm1:
      for (Index i = 0; i < order; ++i) v[i] = x[i] > 0 ? 4 : x[i] < 0 ? -4 : static_cast<double>(i % 7) - 3;
      return every_way(planted("norm1", convex::norm1(4 * part), x, part * v, condition));
    case Charted::simplex:
      x = five.cwiseMax(0);
      for (Index i = 0; i < order; ++i) v[i] = x[i] > 0 ? 3 : 2 - static_cast<double>(i % 5);
      return every_way(planted("simplex", convex::simplex(x.sum()).indicator, x, part * v, condition));
    case Charted::ball2:
      v = 2 * x;
      return every_way(planted("ball2(radius=5)", convex::ball2(5).indicator, x, part * v, condition));
    case Charted::second_order_cone:
      break;
  }
  x[order - 1] = 0;  // |x| without it: root of 24
  x[2] = 1;
  x[order - 1] = 5;
  v = x;
  v[order - 1] = -5;
  return every_way(
      planted("second-order cone", convex::second_order_cone().indicator, x, part * v, condition));
}

std::vector<Contest> tie_contests(Sorting f, double gap) {
  const double g = dyadic(gap) / 16;
  const auto exam = [&](const char* name, Function function, const Vector& x, const Vector& v) {
    return every_way({fmt::format("{}, ties {:g} apart", name, gap), std::move(function),
                      Metric::identity(x.size()), x + v, x});
  };
  if (f == Sorting::sum_largest) {
    // Four entries at the level share two of the three places.
    const Vector x{{2, 2 - g, 2, 2 + g, 1, 2, 2 - g, 2, 0, -3, 2 - 2 * g, 1}};
    Vector v = Vector::Zero(x.size());
    for (Index i = 0; i < x.size(); ++i) v[i] = i == 3 ? 1 : i == 0 || i == 2 || i == 5 || i == 7 ? 0.5 : 0;
    return exam("sum_largest(3)", convex::sum_largest(3), x, v);
  }
  const bool is_simplex = f == Sorting::simplex;
  Vector x{{0.25, 0, 0.25, g, 0, 0.25, g, 0, 0, 0.25 - 2 * g, 0, 0}}, v(x.size());
  for (Index i = 0; i < x.size(); ++i) v[i] = x[i] > 0 ? 0.5 : 0.5 - static_cast<double>(i % 3) * g;
  if (is_simplex) return exam("simplex", convex::simplex(1).indicator, x, v);
  for (Index i = 0; i < x.size(); i += 2) {
    x[i] = -x[i];
    v[i] = -v[i];
  }
  return exam("ball1", convex::ball1(1).indicator, x, v);
}

}  // namespace cli::inline measurement
