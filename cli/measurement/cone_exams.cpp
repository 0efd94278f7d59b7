#include "cli/measurement/cone_exams.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <functional>

#include "cli/measurement/vector_exam.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/cones/cone_operations.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/node.hpp"

namespace cli::inline measurement {
namespace {

using convex::Function;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Prox;
using convex::unit_roundoff;
using convex::Vector;
using Wide = boost::multiprecision::cpp_bin_float_50;
using WideVector = std::array<Wide, 3>;

Wide determinant(const WideVector& a, const WideVector& b, const WideVector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
         c[0] * (a[1] * b[2] - a[2] * b[1]);
}

WideVector combined(const Wide& s, const WideVector& a, const Wide& t, const WideVector& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

/// A ray r of a cone and the ray s of its polar at right angles to it, with their derivatives by a parameter.
struct Rays {
  WideVector r, s, dr, ds;
};

Rays exponential_rays(const Wide& rho) {
  const Wide up = exp(rho), down = exp(-rho);
  return {{rho, 1, up}, {1, 1 - rho, -down}, {1, 0, up}, {0, -1, down}};
}

constexpr double alpha = 0.25;  ///< of the power cone x^alpha y^(1-alpha) >= |z|

Rays power_rays(const Wide& p) {
  const Wide a(alpha), b = 1 - a, one = exp(p), other = exp(-p), third = exp((2 * a - 1) * p),
                       left = -a * exp((2 * a - 2) * p), right = -b * exp(2 * a * p);
  return {{one, other, third},
          {left, right, 1},
          {one, -other, (2 * a - 1) * third},
          {(2 * a - 2) * left, 2 * a * right, 0}};
}

/// z = a r + b s rounded, and the truth for the rounded z: b s by Newton's method on z = a r + b s, whose
/// solution with a, b > 0 is Moreau's decomposition, since r and s are at right angles.
struct Split {
  Vector z;
  convex::DoubleDoubleVector y{3};
};

Split split(const std::function<Rays(const Wide&)>& rays, double parameter, double distance) {
  Wide a = 1, b = distance, p = parameter;
  Rays at = rays(p);
  const WideVector exact = combined(a, at.r, b, at.s);
  Split result;
  result.z.resize(3);
  for (std::size_t i = 0; i < 3; ++i) result.z[static_cast<Index>(i)] = static_cast<double>(exact[i]);
  for (int step = 0; step < 12; ++step) {
    at = rays(p);
    WideVector missing = combined(-a, at.r, -b, at.s);
    for (std::size_t i = 0; i < 3; ++i) missing[i] += result.z[static_cast<Index>(i)];
    const WideVector turn = combined(a, at.dr, b, at.ds);
    const Wide whole = determinant(at.r, at.s, turn);
    a += determinant(missing, at.s, turn) / whole;
    b += determinant(at.r, missing, turn) / whole;
    p += determinant(at.r, at.s, missing) / whole;
  }
  at = rays(p);
  for (std::size_t i = 0; i < 3; ++i) {
    const Wide entry = b * at.s[i];
    result.y.hi[static_cast<Index>(i)] = static_cast<double>(entry);
    result.y.lo[static_cast<Index>(i)] = static_cast<double>(entry - result.y.hi[static_cast<Index>(i)]);
  }
  return result;
}

FoundVector found(const Prox& prox) {
  return {prox.x, prox.error_bound, prox.status == convex::Status::gave_up};
}

/// z - x, which the rounding of x and of the difference spoils.
FoundVector difference(const Vector& z, const Prox& prox) {
  FoundVector rest = found(prox);
  rest.x = z - prox.x;
  rest.bound += unit_roundoff * (z.norm() + prox.x.norm());
  return rest;
}

std::vector<Way> polar_ways(const Function& cone, const Vector& z) {
  const Metric plain = Metric::identity(z.size());
  using enum convex::MethodKind;
  std::vector<Way> ways;
  ways.push_back({"auto", direct, "", [=](double) { return found(cone.conjugate().prox(z, plain)); }});
  ways.push_back({"difference", direct, "", [=](double) { return difference(z, cone.prox(z, plain)); }});
  const bool has_graph = cone.node().graph(z.size()).has_value();
  ways.push_back({"iterative", direct, has_graph ? "" : "no graph form", [=](double) {
                    return difference(z, convex::prox(*cone.node().graph(z.size()), z, plain));
                  }});
  return ways;
}

}  // namespace

std::vector<Contest> boundary_contests(CurvedCone which, double distance) {
  const bool exponential = which == CurvedCone::exponential;
  const Split known =
      exponential ? split(exponential_rays, -0.5, distance) : split(power_rays, 0.75, distance);
  const Function cone = (exponential ? convex::exponential_cone() : convex::power_cone(alpha)).indicator;
  return contests(
      {fmt::format("{} cone, {:g} from its boundary", exponential ? "exponential" : "power", distance),
       Metric::identity(3), known.y, known.y.hi.norm()},
      polar_ways(cone, known.z));
}

std::vector<Contest> flat_polar_contests(double slope) {
  const double e = std::exp2(std::round(std::log2(slope)));
  Matrix G(8, 3);
  G << 5, 0, e, 4, 3, e, 0, 5, e, -3, 4, e, -5, 0, e, -4, -3, e, 0, -5, e, 3, -4, e;
  const Eigen::Vector3d first = G.row(0), second = G.row(1);
  const Vector y = -first.cross(second);  // at right angles to both, and away from the others
  const Vector z = y + 2 * first + 3 * second;
  const Function cone = convex::cone(G).indicator;
  std::vector<Way> ways = polar_ways(cone, z);
  ways.push_back({"facets", convex::MethodKind::direct, "", [G, z](double) {
                    const convex::PolyhedralCone polar = convex::polar(convex::generated_cone(G));
                    const Matrix rays = convex::nearest_directions(polar.generators, 3);
                    FoundVector near = found(convex::cone(rays).indicator.prox(z, Metric::identity(3)));
                    near.bound += 4 * unit_roundoff * z.norm();  // the rays were rounded
                    return near;
                  }});
  return contests({fmt::format("polar of a cone of slope {:g}", slope), Metric::identity(3),
                   convex::DoubleDoubleVector(y), y.norm()},
                  std::move(ways));
}

}  // namespace cli::inline measurement
