#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#include "convex/double_double.hpp"
#include "convex/functions/quadratic.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/methods.hpp"
#include "tests/stability/naive_methods.hpp"

using convex::GalleryInstance;
using convex::Matrix;
using convex::Status;
using convex::Vector;

TEST_CASE("heavy on light: Gauss-Seidel is wholly wrong and says that it gave up, the default is right") {
  for (const double ratio : {1e4, 1e8, 1e12, 1e16}) {
    CAPTURE(ratio);
    const GalleryInstance instance = instance_of("heavy-on-light", 12, ratio);
    const naive::Answer answer = naive::gauss_seidel(
        instance.problem, [](double residual, double) { return residual <= 1e-9; }, 2000);
    CHECK(true_error(instance, answer.q) > 0.5);
    CHECK(naive::judged(instance.problem, answer) == Status::gave_up);
    const convex::Solution found = by_default(instance.problem);
    CHECK(found.status == Status::solved);
    CHECK(true_error(instance, found.q) <= few_roundings);
  }
}

TEST_CASE("heavy on light: the Delassus matrix loses digits with the mass ratio, and is told where") {
  double before = 0;
  for (const double ratio : {1e4, 1e8, 1e12, 1e16}) {
    CAPTURE(ratio);
    const GalleryInstance instance = instance_of("heavy-on-light", 12, ratio);
    const naive::Answer answer = naive::delassus_matrix(instance.problem, loaded_rows(instance));
    const double error = true_error(instance, answer.q);
    CHECK(error > before);
    before = error;
    CHECK((naive::judged(instance.problem, answer) == Status::solved) == (error <= 1e-9));
  }
  CHECK(before > 1e-3);
}

TEST_CASE("an explicit Delassus matrix squares the angle of a flat wedge") {
  for (const double angle : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    CAPTURE(angle);
    const GalleryInstance instance = instance_of("near-opposite", 8, angle);
    const naive::Answer answer = naive::delassus_matrix(instance.problem, loaded_rows(instance));
    CHECK(answer.says_solved);
    CHECK(true_error(instance, answer.q) > std::min(1e-2, 1e-17 / (angle * angle)));
    CHECK(naive::judged(instance.problem, answer) != Status::solved);
    const convex::Solution found = by_default(instance.problem);
    CHECK(found.status == Status::solved);
    CHECK(true_error(instance, found.q) <= few_roundings);
  }
}

TEST_CASE(
    "a wedge flatter than rounding is told from opposite rows in fractions; without these the default says "
    "so") {
  const GalleryInstance instance = instance_of("near-opposite", 8, 1e-16);
  const convex::Solution found = by_default(instance.problem);
  CHECK(found.status == Status::solved);
  CHECK(true_error(instance, found.q) <= few_roundings);
  const convex::Solution in_doubles = convex::automatic(instance.problem, {.limit = 0});
  CHECK(in_doubles.status != Status::solved);
  CHECK_FALSE(in_doubles.undecided.empty());
}

TEST_CASE("a matrix GᵀG of rounded entries need not be semidefinite: exact arithmetic finds no minimum") {
  int indefinite = 0;
  for (int k = 1; k <= 20; ++k) {
    CAPTURE(k);
    const Eigen::RowVector2d G(1.0 / (2 * k + 1), 1.0 / (3 * k + 2));
    const Matrix Q = G.transpose() * G;
    const convex::DoubleDouble down = convex::two_product(Q(0, 0), Q(1, 1)),
                               across = convex::two_product(Q(0, 1), Q(1, 0));
    const double determinant = (down.hi - across.hi) + (down.lo - across.lo);
    if (determinant < 0) ++indefinite;  // ½ x·Qx has no least value: "unbounded", whoever believes the digits
    const Vector z = Vector::Ones(2);
    // By Sherman and Morrison (1950): (I + gᵀg)⁻¹ z = z - gᵀ (g·z)/(1 + g·g).
    const Vector exact = z - G.transpose() * (G.dot(z) / (1 + G.squaredNorm()));
    const convex::Prox found = convex::quadratic(Q, Vector::Zero(2)).prox(z, convex::Metric::identity(2));
    CHECK(found.status == Status::solved);
    CHECK((found.x - exact).norm() <= 1e-15);
    CHECK((found.x - exact).norm() <= 2 * found.error_bound);
    // As a metric it is refused: some motion would have no energy.
    CHECK_THROWS_AS(convex::Metric::dense(Q), convex::InvalidInput);
  }
  CHECK(indefinite > 0);
}
