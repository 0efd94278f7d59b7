#include "convex/functions/cones.hpp"

#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/linear_quadratic/sets.hpp"
#include "convex/prox_formulas/exponential_cone.hpp"
#include "convex/prox_formulas/isotonic.hpp"
#include "convex/prox_formulas/power_cone.hpp"
#include "convex/prox_formulas/second_order_cone.hpp"
#include "convex/prox_formulas/spectral.hpp"

namespace convex::inline named_functions {
namespace {

/// The indicator of -K.
Call mirrored(const Call& K) { return {"dilate", {argument(indicator_call(K)), argument("rho", -1.0)}}; }

void require_two(Index n, const std::string& name) {
  if (n < 2) throw InvalidInput(name + ": " + counted(n, "entry", "entries") + "; give at least 2");
}

/// A cone in the plain metric by its projections.
template <class Project, class Polar, class Jacobian>
Cone plain_cone(Call call, Call polar_call, Index dimension, Project project, Polar polar,
                Jacobian jacobian) {
  return {.call = std::move(call),
          .polar_call = std::move(polar_call),
          .dimension = dimension,
          .project = [project](const Vector& z, const Vector&) -> Vector { return project(z); },
          .jacobian = [jacobian](const Vector& z, const Vector&) -> Matrix { return jacobian(z); },
          .project_polar = [polar](const Vector& z, const Vector&) -> Vector { return polar(z); }};
}

/// The dual -K° of a cone in R³: its projection is -polar(-z), its polar is -K.
template <class Project, class Polar, class Jacobian>
Cone dual_cone(const Call& call, const Call& of, Project project, Polar polar, Jacobian jacobian) {
  return plain_cone(
      call, mirrored(of), 3, [polar](const Vector& z) { return Vector(-polar(-z)); },
      [project](const Vector& z) { return Vector(-project(-z)); },
      [jacobian](const Vector& z) { return Matrix(Matrix::Identity(3, 3) - jacobian(-z)); });
}

void require_exponent(const char* cone, double alpha) {
  if (!(alpha > 0 && alpha < 1))
    throw InvalidInput(std::string(cone) + "(alpha): not between 0 and 1; give 0 < alpha < 1");
}

}  // namespace

Set second_order_cone() {
  const Call call{"second_order_cone"};
  return set_of(plain_cone(call, mirrored(call), 0, prox_formulas::proj_second_order_cone,
                           prox_formulas::proj_second_order_polar,
                           prox_formulas::proj_second_order_cone_jacobian));
}

Set rotated_second_order_cone() {
  const Call call{"rotated_second_order_cone"};
  Cone K = plain_cone(call, mirrored(call), 0, prox_formulas::proj_rotated_cone,
                      prox_formulas::proj_rotated_polar, prox_formulas::proj_rotated_cone_jacobian);
  K.require_size = require_two;
  return set_of(std::move(K));
}

Set psd_cone() {
  const Call call{"psd_cone"};
  Cone K = plain_cone(call, support_call(call), 0, prox_formulas::proj_psd_cone,
                      prox_formulas::proj_psd_polar, [](const Vector& z) {
                        const Index n = prox_formulas::order_of_stacked(z);
                        return prox_formulas::psd_projection(z.reshaped(n, n)).jacobian();
                      });
  K.require_size = [](Index n, const std::string& name) { require_square(name, n); };
  K.of_eigenvalues = true;
  return set_of(std::move(K));
}

Set exponential_cone() {
  return set_of(plain_cone({"exponential_cone"}, mirrored({"dual_exponential_cone"}), 3,
                           prox_formulas::proj_exponential_cone, prox_formulas::proj_exponential_polar,
                           prox_formulas::proj_exponential_cone_jacobian));
}

Set dual_exponential_cone() {
  return set_of(dual_cone({"dual_exponential_cone"}, {"exponential_cone"},
                          prox_formulas::proj_exponential_cone, prox_formulas::proj_exponential_polar,
                          prox_formulas::proj_exponential_cone_jacobian));
}

Set power_cone(double alpha) {
  require_exponent("power_cone", alpha);
  return set_of(plain_cone(
      {"power_cone", {argument("alpha", alpha)}}, mirrored({"dual_power_cone", {argument("alpha", alpha)}}),
      3, [alpha](const Vector& z) { return prox_formulas::proj_power_cone(z, alpha); },
      [alpha](const Vector& z) { return prox_formulas::proj_power_polar(z, alpha); },
      [alpha](const Vector& z) { return prox_formulas::proj_power_cone_jacobian(z, alpha); }));
}

Set dual_power_cone(double alpha) {
  require_exponent("dual_power_cone", alpha);
  return set_of(dual_cone(
      {"dual_power_cone", {argument("alpha", alpha)}}, {"power_cone", {argument("alpha", alpha)}},
      [alpha](const Vector& z) { return prox_formulas::proj_power_cone(z, alpha); },
      [alpha](const Vector& z) { return prox_formulas::proj_power_polar(z, alpha); },
      [alpha](const Vector& z) { return prox_formulas::proj_power_cone_jacobian(z, alpha); }));
}

Set monotone_cone() {
  const Call call{"monotone_cone"};
  return set_of(
      Cone{.call = call,
           .polar_call = support_call(call),
           .project = [](const Vector& z, const Vector& d) { return prox_formulas::proj_monotone(z, d).x; },
           .jacobian =
               [](const Vector& z, const Vector& d) {
                 return prox_formulas::blocks_jacobian(prox_formulas::proj_monotone(z, d), d);
               },
           .project_polar =
               [](const Vector& z, const Vector& d) {
                 const Vector covector = d.cwiseProduct(z), inverse = d.cwiseInverse();
                 const prox_formulas::Blocks runs = prox_formulas::proj_monotone(covector, inverse);
                 return prox_formulas::blocks_covector(runs, covector, inverse, Vector::Zero(z.size()));
               },
           .form = linear_quadratic::monotone_cone,
           .any_diagonal = true,
           .route = SplitRoute::support_prox_from_projection,  // its runs are those of the projection
           .make_conjugate = prox_formulas::keep_normal_to_monotone});
}

}  // namespace convex::inline named_functions
