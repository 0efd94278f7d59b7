#include "convex/composite/epigraph.hpp"

#include <doctest/doctest.h>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/composite/conjugate_atom.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/composite/perspective.hpp"
#include "tests/convex/composite/extended_truth.hpp"
#include "tests/convex/composite/sample_atoms.hpp"

using namespace samples;
using AtomPointer = std::shared_ptr<const Atom>;

namespace {

std::vector<std::pair<const char*, AtomPointer>> functions() {
  return {{"norm2", std::make_shared<Norm2>()},
          {"norm1", std::make_shared<Norm1>()},
          {"exponential", std::make_shared<Exponential>()},
          {"entropy", std::make_shared<Entropy>()},
          {"barrier", std::make_shared<LogBarrier>()},
          {"half square", convex::half_square_atom()}};
}

/// prox_diagonal in the metric d, against its derivative by differences.
void check_jacobian(const Atom& f, const Vector& z, double d) {
  const Vector metric = Vector::Constant(z.size(), d);
  const Matrix J = f.prox_jacobian(z, metric);
  const double h = 1e-6 * (1 + z.norm());
  for (Index i = 0; i < z.size(); ++i) {
    const Vector step = h * Vector::Unit(z.size(), i);
    const Vector difference =
        (f.prox_diagonal(z + step, metric) - f.prox_diagonal(z - step, metric)) / (2 * h);
    CHECK((J.col(i) - difference).norm() <= 1e-4);
  }
  CHECK((J - J.transpose()).norm() <= 1e-10);
}

}  // namespace

TEST_CASE("the nearest point of an epigraph is on the graph, along a normal (subgradient, -1)") {
  for (const auto& [name, f] : functions())
    for (unsigned seed = 0; seed < 40; ++seed) {
      CAPTURE(std::string(name));
      CAPTURE(seed);
      std::mt19937 generator(seed);
      const Index n = 1 + seed % 4;
      const AtomPointer set = convex::epigraph_atom(f, n);
      const Vector z = random_vector(generator, n + 1, std::pow(10.0, static_cast<int>(seed % 4) - 2));
      const Vector p = set->prox_diagonal(z, Vector::Ones(n + 1));
      CHECK(set->value(p) <= 0);
      const double mu = p[n] - z[n];
      if (mu <= 0) {
        // Inside, or over the wall of the positive orthant, where entropy ends.
        const bool outside = f->value(z.head(n)) == infinity;
        const Vector nearest = outside ? Vector(z.head(n).cwiseMax(0.0)) : Vector(z.head(n));
        CHECK((p.head(n) - nearest).norm() <= 1e-12 * z.norm());
        CHECK(f->value(nearest) <= z[n]);
        continue;
      }
      const double height = f->value(p.head(n));
      CHECK(std::abs(height - p[n]) <= 1e-12 * (std::abs(p[n]) + std::abs(z[n])));
      // (z - p)_x / mu is a subgradient: Fenchel's equality, with the conjugate's own formula.
      const Vector v = (z - p).head(n) / mu;
      const double gap = height + f->conjugate().node().value(v) - v.dot(p.head(n));
      CHECK(std::abs(gap) <= 1e-10 * (1 + std::abs(height) + v.norm() * p.norm()));
      check_jacobian(*set, z, 1);
    }
}

TEST_CASE("the epigraph of the norm is the second-order cone") {
  std::mt19937 generator(1);
  const AtomPointer set = convex::epigraph_atom(std::make_shared<Norm2>(), 3);
  for (double size : {1e-8, 1.0, 1e8})
    for (int count = 0; count < 30; ++count) {
      const Vector z = random_vector(generator, 4, size), d = Vector::Ones(4);
      CHECK((set->prox_diagonal(z, d) - SecondOrderCone().prox_diagonal(z, d)).norm() <= 1e-14 * z.norm());
      CHECK((Matrix(set->prox_jacobian(z, d)) - Matrix(SecondOrderCone().prox_jacobian(z, d))).norm() <=
            1e-12);
    }
}

TEST_CASE("a point below a domain that is not everything goes to the graph or to its wall") {
  // Entropy at x = 0 is 0, with vertical slope: from (-1, 1) the nearest point is (0, 1).
  const AtomPointer set = convex::epigraph_atom(std::make_shared<Entropy>(), 1);
  const Vector z = Eigen::Vector2d(-1, 1), wall = Eigen::Vector2d(0, 1);
  CHECK((set->prox_diagonal(z, Vector::Ones(2)) - wall).norm() <= 1e-15);
}

TEST_CASE("perspectives of functions with known perspectives") {
  const double e = std::exp(1.0);
  const auto value = [](const AtomPointer& f, Vector x, double s) {
    Vector z(x.size() + 1);
    z << x, s;
    return convex::perspective_atom(f, x.size())->value(z);
  };
  const Vector x = Eigen::Vector2d(3, 4);
  CHECK(value(convex::half_square_atom(), x, 5) == doctest::Approx(2.5));  // |x|² / 2s
  CHECK(value(std::make_shared<Exponential>(), x, 1 / 1.0) ==
        doctest::Approx(std::pow(e, 3) + std::pow(e, 4)));
  CHECK(value(std::make_shared<Norm2>(), x, 0.1) == doctest::Approx(5));
  CHECK(value(std::make_shared<Norm2>(), x, 0) == doctest::Approx(5));
  CHECK(value(convex::half_square_atom(), x, 0) == infinity);
  CHECK(value(convex::half_square_atom(), Vector::Zero(2), 0) == 0);
  CHECK(value(std::make_shared<Norm2>(), x, -1) == infinity);
}

TEST_CASE("the prox of a perspective and the projection on its conjugate's set are two parts of z") {
  for (const auto& [name, f] : functions())
    for (unsigned seed = 0; seed < 40; ++seed) {
      CAPTURE(std::string(name));
      CAPTURE(seed);
      std::mt19937 generator(seed);
      const Index n = 1 + seed % 3;
      const double d = std::pow(2.0, static_cast<int>(seed % 5) - 2);
      const AtomPointer cone = convex::perspective_atom(f, n);
      const Vector z = random_vector(generator, n + 1, std::pow(10.0, static_cast<int>(seed % 3) - 1));
      const Vector p = cone->prox_diagonal(z, Vector::Constant(n + 1, d)), v = d * (z - p);
      // v is in {(v, r) : f*(v) <= -r}, and v·p = g(p), as for every support function. The distance to the
      // set decides: near its walls f* itself is steep beyond rounding.
      const AtomPointer set = convex::epigraph_atom(convex::conjugate_atom(f, n), n, -1);
      const double size = 1 + z.norm() * (1 + d) + std::abs(v[n]);
      CHECK((set->prox_diagonal(v, Vector::Ones(n + 1)) - v).norm() <= 1e-13 * size);
      CHECK(p[n] >= 0);
      if (p[n] > 1e-6) CHECK(std::abs(cone->value(p) - v.dot(p)) <= 1e-11 * size * size);
      if (p.norm() > 0 && p[n] > 1e-3) check_jacobian(*cone, z, d);
    }
}

TEST_CASE("an epigraph and a perspective in other units are the plain ones with the last entry stretched") {
  for (const auto& [name, f] : functions())
    for (double unit : {0.125, 1.5, -3.0}) {
      CAPTURE(std::string(name));
      CAPTURE(unit);
      std::mt19937 generator(5);
      const AtomPointer set = convex::epigraph_atom(f, 2, unit), cone = convex::perspective_atom(f, 2, unit);
      const AtomPointer plain = convex::epigraph_atom(f, 2), homogeneous = convex::perspective_atom(f, 2);
      const Vector stretch = Eigen::Vector3d(1, 1, unit), d = Vector::Constant(3, 0.5);
      for (int count = 0; count < 20; ++count) {
        const Vector z = random_vector(generator, 3, 2);
        // A part of z each; the support function of a set is taken where the normal is.
        const Vector p = set->prox_diagonal(z, d), v = d.cwiseProduct(z - p);
        CHECK(plain->value(stretch.cwiseProduct(p)) == 0);
        const convex::Function conjugate = set->conjugate();
        const Atom& support = dynamic_cast<const Atom&>(conjugate.node());
        CHECK((support.prox_diagonal(d.cwiseProduct(z), d.cwiseInverse()) - v).norm() <=
              1e-11 * (1 + z.norm()));
        const Vector q = cone->prox_diagonal(z, d);
        CHECK(cone->value(q) == doctest::Approx(homogeneous->value(stretch.cwiseProduct(q))).epsilon(1e-12));
        if (q.norm() > 0 && std::abs(q[2]) > 1e-3) check_jacobian(*cone, z, 0.5);
        if ((z - p).norm() > 1e-3 && f->value(z.head(2)) < infinity) check_jacobian(*set, z, 0.5);
      }
    }
}

TEST_CASE("(x, s) -> |x|² / 2s has its prox in any metric") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    std::mt19937 generator(seed);
    const Index n = 2 + seed % 3;
    const convex::Metric W = random_metric(generator, n, 1e4);
    Vector z = random_vector(generator, n, 3);
    z[n - 1] += 5;
    const convex::GraphForm f = convex::perspective(convex::graph_of(convex::half_square_atom(), n - 1));
    const convex::Prox found = prox(f, z, W);
    if (found.x[n - 1] < 0.1) continue;  // smooth elsewhere
    const Truth exact = truth(W.dense_gram(), z,
                              {[n](const ExtendedVector& x) {
                                 ExtendedVector g(n);
                                 g << x.head(n - 1) / x[n - 1],
                                     -x.head(n - 1).squaredNorm() / (2 * x[n - 1] * x[n - 1]);
                                 return g;
                               },
                               [n](const ExtendedVector& x) {
                                 const Extended s = x[n - 1];
                                 ExtendedMatrix H = ExtendedMatrix::Identity(n, n) / s;
                                 H.col(n - 1).head(n - 1) = -x.head(n - 1) / (s * s);
                                 H.row(n - 1) = H.col(n - 1).transpose();
                                 H(n - 1, n - 1) = x.head(n - 1).squaredNorm() / (s * s * s);
                                 return H;
                               },
                               {},
                               {}},
                              found.x);
    check_accuracy(found, exact.x, W, z);
  }
}
