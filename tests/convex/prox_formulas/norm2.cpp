#include "convex/prox_formulas/norm2.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/invalid_input.hpp"

using convex::Index;
using convex::Vector;
namespace k = convex::prox_formulas;

namespace {

using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
constexpr long double few = 6 * 0x1p-53L;

std::vector<Vector> samples() {
  std::mt19937 generator(21);
  std::normal_distribution<double> normal;
  std::vector<Vector> found{Vector::Zero(3), Vector::Zero(1), Vector::Constant(2, 1e-320)};
  for (Index n : {1, 2, 7, 100})
    for (int exponent : {-1000, -500, 0, 500, 1000}) {
      Vector z(n);
      for (double& v : z) v = std::ldexp(normal(generator), exponent);
      found.push_back(z);
    }
  found.push_back((Vector(3) << 1e150, 1, 1e-150).finished());
  return found;
}

}  // namespace

TEST_CASE("the length of a vector is right at any scale") {
  for (const Vector& z : samples()) {
    const long double exact = z.cast<long double>().norm();
    CHECK(std::abs(k::length(z) - exact) <= few * exact + 1e-323L);
  }
  CHECK(k::length((Vector(2) << 3e200, 4e200).finished()) == doctest::Approx(5e200));
}

TEST_CASE("the ball takes z along its own direction, the norm's prox shortens it by the weight") {
  for (const Vector& z : samples()) {
    const LongVector lz = z.cast<long double>();
    const long double norm = lz.norm();
    for (double share : {0.0, 1e-300, 1e-9, 0.5, 1.0, 2.0}) {
      const double radius = share * static_cast<double>(norm);
      if (norm < 1e-310L || (radius > 0 && radius < 1e-310)) continue;
      const Vector x = k::proj_ball2(z, radius), y = k::prox_norm2(z, radius);
      const long double kept = std::min(1.0L, radius / norm), left = std::max(0.0L, (norm - radius) / norm);
      CHECK((x.cast<long double>() - kept * lz).stableNorm() <= few * kept * norm + 1e-322L);
      CHECK((y.cast<long double>() - left * lz).stableNorm() <= few * norm);
      if (share > 1) CHECK((x == z && y == Vector::Zero(z.size())));
    }
  }
}

TEST_CASE("negative radii are refused") {
  const Vector z = Vector::Ones(3);
  CHECK_THROWS_AS(k::proj_ball2(z, -1), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_ball2(z, std::nan("")), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_norm2(z, -1), convex::InvalidInput);
}
