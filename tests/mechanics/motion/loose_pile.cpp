#include <doctest/doctest.h>

#include "tests/mechanics/motion/followed.hpp"

using namespace tests;

TEST_CASE("discs that come to rest in rows of many dependent contacts stay there, step by step") {
  const SystemText text{{"x[1..N]", "y[1..N]"},
                        "sum(i in 1..N, (x[i]'^2+y[i]'^2)/2)",
                        "sum(i in 1..N, 9.81*y[i])",
                        {{"N", "30"}, {"r", "0.5"}, {"W", "7"}},
                        {},
                        {},
                        {{"wl[i in 1..N]", "x[i]>=r"},
                         {"wr[i in 1..N]", "x[i]<=W-r"},
                         {"fl[i in 1..N]", "y[i]>=r"},
                         {"d[i in 1..N, j in i+1..N]", "sqrt((x[i]-x[j])^2+(y[i]-y[j])^2)>=2*r"}}};
  const std::vector<double> q{
      0.5,      1.556949, 2.605275, 3.645101, 4.699909, 5.74899,  0.523032, 1.575774, 2.611877, 3.660567,
      4.726715, 5.768655, 0.505246, 1.540042, 2.598908, 3.654431, 4.694575, 5.758905, 0.528029, 1.560612,
      2.610509, 3.670828, 4.728783, 5.767624, 0.5,      1.548442, 2.590581, 3.644434, 4.698758, 5.749916,
      0.52,     0.52,     0.52,     0.52,     0.52,     0.52,     1.54,     1.54,     1.54,     1.54,
      1.54,     1.54,     2.56,     2.56,     2.56,     2.56,     2.56,     2.56,     3.58,     3.58,
      3.58,     3.58,     3.58,     3.58,     4.6,      4.6,      4.6,      4.6,      4.6,      4.6};
  const auto discs = system(text);
  mechanics::MotionOptions options;
  options.method = mechanics::MotionMethod::time_stepping;
  options.restitution =
      mechanics::Vector::Constant(static_cast<mechanics::Index>(discs->constraints().size()), 0.3);
  mechanics::State start;
  start.q = Eigen::Map<const mechanics::Vector>(q.data(), 60);
  start.v = mechanics::Vector::Zero(60);
  mechanics::Motion motion(*discs, start, options);
  while (motion.advance(2)) {
  }
  CHECK(motion.why() == "");
  CHECK(motion.status() == mechanics::MotionStatus::done);
  CHECK(motion.state().t == 2);
  CHECK(motion.state().v.norm() <= 1e-12);
}
