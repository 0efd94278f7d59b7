#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/motion/impact.hpp"

using namespace mechanics;
using convex::Matrix;
using convex::Metric;

namespace {

/// n equal balls in a row, all touching, the first at speed 1.
std::vector<ImpactContact> cradle(Index n, double e) {
  std::vector<ImpactContact> contacts;
  for (Index k = 0; k + 1 < n; ++k) {
    Vector u = Vector::Zero(n);
    u[k] = -1;
    u[k + 1] = 1;
    contacts.push_back({u, k == 0 ? -1.0 : 0.0, e, false});
  }
  return contacts;
}

}  // namespace

TEST_CASE("all laws agree on one contact, and on contacts that do not feel each other") {
  const Metric A = Metric::dense(Matrix{{2, 1, 0}, {1, 3, 0}, {0, 0, 5}});
  for (const double e : {0.0, 0.3, 1.0}) {
    const std::vector<ImpactContact> one{{Vector{{1, 2, 0}}, -3, e, false}};
    const std::vector<ImpactContact> two{{Vector{{1, 2, 0}}, -3, e, false},
                                         {Vector{{0, 0, 1}}, -1, 0.5, false}};
    for (const auto& contacts : {one, two}) {
      const Vector wanted = impact(A, contacts, ImpactLaw::moreau).change;
      CHECK((impact(A, contacts, ImpactLaw::poisson).change - wanted).norm() <= 1e-14);
      CHECK((impact(A, contacts, ImpactLaw::sequential).change - wanted).norm() <= 1e-14);
    }
  }
}

TEST_CASE("one contact after the other, the last ball of the cradle alone goes on") {
  for (const Index n : {2, 5, 20}) {
    const ImpactOutcome found = impact(Metric::identity(n), cradle(n, 1), ImpactLaw::sequential);
    CHECK(std::abs(found.change[0] + 1) <= 1e-14);
    for (Index k = 1; k < n; ++k) CHECK(std::abs(found.change[k] - (k == n - 1 ? 1 : 0)) <= 1e-14);
    CHECK(found.remark.empty());
  }
}

TEST_CASE("a sequence without end has a limit: momentum is kept, nothing closes, energy falls") {
  for (const double e : {0.0, 0.5, 0.9}) {
    const ImpactOutcome found = impact(Metric::identity(4), cradle(4, e), ImpactLaw::sequential);
    REQUIRE(found.undetermined.empty());
    const Vector v = found.change + Vector{{1, 0, 0, 0}};
    CHECK(v.sum() == doctest::Approx(1).epsilon(1e-13));
    for (Index k = 0; k + 1 < 4; ++k) CHECK(v[k + 1] - v[k] >= -1e-12);
    CHECK(v.squaredNorm() <= 1);
  }
}

TEST_CASE("ties that do not commute are said") {
  // Two walls at 60 degrees, struck along the middle.
  const double c = 0.5, s = std::sqrt(0.75);
  const ImpactOutcome found =
      impact(Metric::identity(2), {{Vector{{s, c}}, -c, 1, false}, {Vector{{-s, c}}, -c, 1, false}},
             ImpactLaw::sequential);
  CHECK_FALSE(found.remark.empty());
  // What differs by more than rounding is no tie: the faster one strikes first.
  // Where the second one does, v+ leads to its other side: (0, -1) is (-0.96, -0.28) first, then (0.5376,
  // 0.8432).
  const ImpactOutcome told_apart =
      impact(Metric::identity(2),
             {{Vector{{0.8, 0.6}}, -0.6, 1, false}, {Vector{{-0.8, 0.6}}, -0.6 * (1 + 1e-13), 1, false}},
             ImpactLaw::sequential);
  CHECK(told_apart.remark.empty());
  CHECK(told_apart.change[0] == doctest::Approx(0.5376).epsilon(1e-12));
  // Unless the rates are the rest of larger numbers.
  CHECK_FALSE(
      impact(Metric::identity(2),
             {{Vector{{s, c}}, -c, 1, false, 1e3}, {Vector{{-s, c}}, -c * (1 + 1e-13), 1, false, 1e3}},
             ImpactLaw::sequential)
          .remark.empty());
}

TEST_CASE("Poisson's law gives back its part of the impulses of compression, and no contact closes") {
  const Metric A = Metric::dense(Matrix{{2, 1}, {1, 3}});
  const Vector before{{-1, -2}};
  const double e[] = {0.8, 0.3};
  std::vector<ImpactContact> contacts, plastic;
  for (const int k : {0, 1}) {
    const Vector u = k == 0 ? Vector{{1, 0.2}} : Vector{{-0.3, 1}};
    contacts.push_back({u, u.dot(before), e[k], false});
    plastic.push_back({u, u.dot(before), 0, false});
  }
  const Vector compression = impact(A, plastic).impulse;
  const ImpactOutcome found = impact(A, contacts, ImpactLaw::poisson);
  Vector applied = Vector::Zero(2);
  for (Index a = 0; a < 2; ++a) {
    const auto k = static_cast<std::size_t>(a);
    applied += found.impulse[a] * contacts[k].u;
    const double expansion = found.impulse[a] - compression[a], more = expansion - e[a] * compression[a];
    CHECK(more >= -1e-14);
    CHECK(found.rate[a] >= 0);
    CHECK(std::abs(more * found.rate[a]) <= 1e-14);
  }
  CHECK((A.multiply(found.change) - applied).norm() <= 1e-14);
}

TEST_CASE("Poisson's law does not determine redundant contacts of different restitution") {
  const auto twice = [](double e) {
    return std::vector<ImpactContact>{{Vector{{1}}, -1, 0.5, false}, {Vector{{1}}, -1, e, false}};
  };
  CHECK_FALSE(impact(Metric::identity(1), twice(0.9), ImpactLaw::poisson).undetermined.empty());
  const ImpactOutcome same = impact(Metric::identity(1), twice(0.5), ImpactLaw::poisson);
  CHECK(same.undetermined.empty());
  CHECK(same.change[0] == doctest::Approx(1.5).epsilon(1e-15));
}

TEST_CASE("rods written twice hold through an impact under every law as rods written once") {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const Vector rod{{c, s, 0, 0}}, other{{-s, -c, s, c}}, wall{{1, 0, 0, 0}}, far{{0, 0, 1, 0}};
  const Metric A = Metric::diagonal(Vector{{1, 1, 0.5, 0.5}});
  const std::vector<ImpactContact> once{
      {rod, 0, 0, true}, {other, 0, 0, true}, {wall, -0.7, 0.9, false}, {far, -0.3, 0.4, false}};
  std::vector<ImpactContact> twice = once;
  twice.push_back({3 * rod, 0, 0, true});
  twice.push_back({rod - other, 0, 0, true});
  for (const ImpactLaw law : impact_laws) {
    CAPTURE(name(law));
    const ImpactOutcome expected = impact(A, once, law), found = impact(A, twice, law);
    REQUIRE(found.excluding.empty());
    REQUIRE(found.undetermined.empty());  // the rods' impulses are not unique, those of the walls are
    CHECK((found.change - expected.change).norm() <= 1e-13);
  }
}

TEST_CASE("a stroke moves nothing along rows that two-sided ones hold, by no rounding either") {
  // The second contact is held by the third, twice over, from the side it may not leave and the other.
  const Metric A = Metric::dense(Matrix{{6, 4}, {4, 6}});
  for (const double side : {-2.0, 2.0, -1.0 / 3}) {
    CAPTURE(side);
    const ImpactOutcome found = impact(
        A,
        {{Vector{{-2, 2}}, -2, 0, false}, {Vector{{side, 0}}, 0, 0.75, false}, {Vector{{-1, 0}}, 0, 0, true}},
        ImpactLaw::sequential);
    CHECK(found.excluding.empty());
    REQUIRE(found.change.size() == 2);
    CHECK((found.change - Vector{{0, 1}}).norm() <= 1e-15);
    CHECK(found.rate == Vector{{0, 0, 0}});
    CHECK(found.impulse[1] == 0);
  }
}

TEST_CASE("an impact without an outcome has no change of the velocity") {
  // After the first stroke the second contact closes, which the third forbids to open.
  const ImpactOutcome found =
      impact(Metric::identity(2),
             {{Vector{{0, 1}}, -3, 0, false}, {Vector{{1, 0}}, -1, 0, false}, {Vector{{1, 0}}, 0, 0, true}},
             ImpactLaw::sequential);
  CHECK(found.excluding == std::vector<Index>{1, 2});
  CHECK(found.change.size() == 0);
}
