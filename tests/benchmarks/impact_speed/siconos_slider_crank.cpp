#include <SiconosKernel.hpp>
#include <cmath>
#include <memory>

#include "tests/benchmarks/impact_speed/siconos_events.hpp"
#include "tests/benchmarks/impact_speed/slider_crank.hpp"

namespace peers {
namespace {

using namespace slider_crank;

constexpr double coupling = (m2 / 2 + m3) * l1 * l2;

void mass(unsigned int, double* q, double* M, unsigned int, double*) {
  std::fill(M, M + 9, 0);
  M[0] = J1 + m1 * l1 * l1 / 4 + (m2 + m3) * l1 * l1;
  M[1] = M[3] = coupling * std::cos(q[0] - q[1]);
  M[4] = J2 + m2 * l2 * l2 / 4 + m3 * l2 * l2;
  M[8] = J3;
}

/// What stands beside A q'' on the left: of the velocities, and of gravity.
void gyroscopic(unsigned int, double* q, double* v, double* F, unsigned int, double*) {
  const double s = coupling * std::sin(q[0] - q[1]);
  F[0] = s * v[1] * v[1] + gravity * l1 * std::cos(q[0]) * (m1 / 2 + m2 + m3);
  F[1] = -s * v[0] * v[0] + gravity * l2 * std::cos(q[1]) * (m2 / 2 + m3);
  F[2] = 0;
}

/// A corner at (end a, face b) of the slider stays within the guide: h = c + b - face (Y3 + end a sin p3 +
/// face b cos p3).
class Corner : public LagrangianScleronomousR {
 public:
  Corner(double end, double face) : end_(end), face_(face) {
    _jachq = std::make_shared<SimpleMatrix>(1, 3);
    _jachqDot = std::make_shared<SimpleMatrix>(1, 3);
  }
  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override {
    const double Y3 = l1 * std::sin(q(0)) + l2 * std::sin(q(1));
    y(0) = c + b - face_ * (Y3 + end_ * a * std::sin(q(2)) + face_ * b * std::cos(q(2)));
  }
  void computeJachq(const BlockVector& q, BlockVector&) override {
    (*_jachq)(0, 0) = -face_ * l1 * std::cos(q(0));
    (*_jachq)(0, 1) = -face_ * l2 * std::cos(q(1));
    (*_jachq)(0, 2) = -face_ * (end_ * a * std::cos(q(2)) - face_ * b * std::sin(q(2)));
  }
  void computeDotJachq(const BlockVector& q, BlockVector&, const BlockVector& v) override {
    (*_jachqDot)(0, 0) = face_ * l1 * std::sin(q(0)) * v(0);
    (*_jachqDot)(0, 1) = face_ * l2 * std::sin(q(1)) * v(1);
    (*_jachqDot)(0, 2) = face_ * (end_ * a * std::sin(q(2)) + face_ * b * std::cos(q(2))) * v(2);
  }

 private:
  double end_, face_;
};

}  // namespace

Times slider_crank_by_siconos(double tolerance, double step) {
  auto q = std::make_shared<SiconosVector>(3), v = std::make_shared<SiconosVector>(3);
  (*v)(0) = w0;
  (*v)(1) = -w0 / 2;
  auto crank = std::make_shared<LagrangianDS>(q, v);
  crank->setComputeMassFunction(mass);
  crank->setComputeFGyrFunction(gyroscopic);
  auto model = std::make_shared<NonSmoothDynamicalSystem>(0, end);
  model->insertDynamicalSystem(crank);
  auto law = std::make_shared<NewtonImpactNSL>(restitution);
  for (const double face : {1.0, -1.0})
    for (const double side : {-1.0, 1.0})
      model->link(std::make_shared<Interaction>(law, std::make_shared<Corner>(side, face)), crank);
  return times_of_impacts(model, 0, tolerance, step);
}

}  // namespace peers
