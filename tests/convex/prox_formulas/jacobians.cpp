#include <doctest/doctest.h>

#include <functional>
#include <random>
#include <string>

#include "convex/functions/function.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/prox_formulas/capped_simplex.hpp"
#include "convex/prox_formulas/exponential_cone.hpp"
#include "convex/prox_formulas/isotonic.hpp"
#include "convex/prox_formulas/nuclear_norm.hpp"
#include "convex/prox_formulas/power_cone.hpp"
#include "convex/prox_formulas/second_order_cone.hpp"
#include "convex/prox_formulas/simplex.hpp"
#include "convex/prox_formulas/spectral.hpp"
#include "convex/prox_formulas/total_variation.hpp"
#include "convex/sets/subdifferential.hpp"

using convex::Index;
using convex::Matrix;
using convex::Vector;
namespace k = convex::prox_formulas;

namespace {

/// A prox in metric d with its Jacobian. Those that know the plain metric only are given d = 1.
struct Case {
  std::string name;
  Index n;
  bool plain;
  std::function<Vector(const Vector& z, const Vector& d)> prox;
  std::function<Matrix(const Vector& z, const Vector& d)> jacobian;
};

Vector of3(const Eigen::Vector3d& x) { return x; }
Matrix of33(const Eigen::Matrix3d& J) { return J; }
Matrix square(const Vector& z) { return Eigen::Map<const Matrix>(z.data(), 3, 3); }

/// As users have them.
Case of_function(const std::string& name, Index n, bool plain, const convex::Function& f) {
  return {name, n, plain,
          [f](const Vector& z, const Vector& d) { return f.prox(z, convex::Metric::diagonal(d)).x; },
          [f](const Vector& z, const Vector& d) {
            return convex::prox_jacobian(f, z, convex::Metric::diagonal(d));
          }};
}

std::vector<Case> metric_cases() {
  using V = const Vector&;
  return {
      {"simplex", 6, false, [](V z, V d) { return k::proj_simplex(z, 2, d); },
       [](V z, V d) { return k::proj_simplex_jacobian(z, 2, d); }},
      {"ball1", 6, false, [](V z, V d) { return k::proj_ball1(z, 2, d); },
       [](V z, V d) { return k::proj_ball1_jacobian(z, 2, d); }},
      {"max", 6, false, [](V z, V d) { return k::prox_max(z, 1.5, d); },
       [](V z, V d) { return k::prox_max_jacobian(z, 1.5, d); }},
      {"norm_inf", 6, false, [](V z, V d) { return k::prox_norm_inf(z, 2, d); },
       [](V z, V d) { return k::prox_norm_inf_jacobian(z, 2, d); }},
      {"capped simplex", 6, false, [](V z, V d) { return k::proj_capped_simplex(z, 0.8, 2, d); },
       [](V z, V d) { return k::proj_capped_simplex_jacobian(z, 0.8, 2, d); }},
      of_function("sum_largest", 6, false, convex::sum_largest(2)),
      {"isotonic", 6, false, [](V z, V d) { return k::proj_monotone(z, d).x; },
       [](V z, V d) { return k::blocks_jacobian(k::proj_monotone(z, d), d); }},
      {"total_variation", 6, false, [](V z, V d) { return k::prox_total_variation(z, 0.7, d).x; },
       [](V z, V d) { return k::blocks_jacobian(k::prox_total_variation(z, 0.7, d), d); }},
  };
}

std::vector<Case> plain_cases() {
  using V = const Vector&;
  const Vector center = Vector::LinSpaced(4, -1, 1);
  std::vector<Case> found{
      of_function("ball2", 4, true, convex::indicator(convex::ball2(1.5, center))),
      of_function("norm2", 4, true, convex::norm2(1.5)),
      of_function("norm2 of many", 64, true, convex::norm2(1.5)),
      of_function("group norm", 6, true, convex::group_norm(1, {1, 3, 2})),
      {"second-order cone", 5, true, [](V z, V) { return k::proj_second_order_cone(z); },
       [](V z, V) { return k::proj_second_order_cone_jacobian(z); }},
      {"rotated second-order cone", 4, true, [](V z, V) { return k::proj_rotated_cone(z); },
       [](V z, V) { return k::proj_rotated_cone_jacobian(z); }},
      {"exponential cone", 3, true, [](V z, V) { return of3(k::proj_exponential_cone(z)); },
       [](V z, V) { return of33(k::proj_exponential_cone_jacobian(z)); }},
      {"psd cone", 9, true, [](V z, V) { return k::proj_psd_cone(z); },
       [](V z, V) { return k::psd_projection(square(z)).jacobian(); }},
      {"log det", 9, true, [](V z, V) { return k::prox_log_det(z, 0.7); },
       [](V z, V) { return k::log_det_prox(square(z), 0.7).jacobian(); }},
  };
  for (double alpha : {0.5, 0.2, 0.9})
    found.push_back({"power cone " + std::to_string(alpha), 3, true,
                     [=](V z, V) { return of3(k::proj_power_cone(z, alpha)); },
                     [=](V z, V) { return of33(k::proj_power_cone_jacobian(z, alpha)); }});
  for (Index rows : {1, 2, 3, 4, 12})
    found.push_back(
        {"nuclear norm", 12, true, [=](V z, V) { return k::prox_nuclear_norm(z, 1, rows); },
         [=](V z, V) {
           return k::nuclear_norm_prox(Eigen::Map<const Matrix>(z.data(), rows, 12 / rows), 1).jacobian();
         }});
  return found;
}

Matrix difference_quotient(const Case& f, const Vector& z, const Vector& d, double h) {
  Matrix J(f.n, f.n);
  for (Index j = 0; j < f.n; ++j) {
    const Vector step = h * Vector::Unit(f.n, j);
    J.col(j) = (f.prox(z + step, d) - f.prox(z - step, d)) / (2 * h);
  }
  return J;
}

void check_jacobians(const std::vector<Case>& cases) {
  std::mt19937 generator(9);
  std::normal_distribution<double> normal;
  for (const Case& f : cases) {
    int smooth = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
      Vector z(f.n), d(f.n);
      for (double& v : z) v = 2 * normal(generator);
      for (double& v : d) v = f.plain ? 1 : std::exp(0.5 * normal(generator));
      CAPTURE(f.name);
      CAPTURE(z.transpose());
      const Matrix J = f.jacobian(z, d);
      // In the metric the Jacobian of a prox is symmetric with eigenvalues in [0, 1].
      const Vector root = d.cwiseSqrt();
      const Matrix S = root.asDiagonal() * J * root.cwiseInverse().asDiagonal();
      CHECK((S - S.transpose()).cwiseAbs().maxCoeff() <= 1e-13);
      const double most = (S.transpose() * S).trace();
      CHECK(most <= static_cast<double>(f.n) + 1e-12);
      CHECK((S - S * S).trace() >= -1e-12);
      // Two steps that agree show that there is no bend near.
      const Matrix near = difference_quotient(f, z, d, 0x1p-17), far = difference_quotient(f, z, d, 0x1p-16);
      if ((near - far).cwiseAbs().maxCoeff() > 1e-6) continue;
      ++smooth;
      CHECK((J - near).cwiseAbs().maxCoeff() <= 1e-6);
    }
    CHECK(smooth > 50);
  }
}

}  // namespace

TEST_CASE("the Jacobians in a diagonal metric are the difference quotients, and symmetric in it") {
  check_jacobians(metric_cases());
}

TEST_CASE("the Jacobians in the plain metric are the difference quotients, and symmetric") {
  check_jacobians(plain_cases());
}

TEST_CASE("at ties, bends and apexes a Jacobian is still symmetric, between 0 and the identity") {
  for (const std::vector<Case>& cases : {metric_cases(), plain_cases()})
    for (const Case& f : cases)
      for (int code = 0; code < 81; ++code) {
        Vector z = Vector::Zero(f.n);
        for (Index i = 0, rest = code; i < f.n; ++i, rest = i % 4 == 0 ? code : rest / 3)
          z[i] = static_cast<double>(rest % 3) - 1;
        CAPTURE(f.name);
        CAPTURE(z.transpose());
        const Matrix J = f.jacobian(z, Vector::Ones(f.n));
        REQUIRE(J.allFinite());
        CHECK((J - J.transpose()).cwiseAbs().maxCoeff() <= 1e-13);
        CHECK((J - J * J).trace() >= -1e-12);
        CHECK((J * J).trace() <= static_cast<double>(f.n) + 1e-12);
      }
}
