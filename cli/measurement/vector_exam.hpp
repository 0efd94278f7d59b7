#pragma once

#include "cli/measurement/contest.hpp"
#include "convex/double_double.hpp"
#include "convex/metric.hpp"

namespace cli::inline measurement {

/// A vector with its truth, to be found in several ways: a prox, a projection on a polar.
struct VectorExam {
  std::string name;
  convex::Metric W = convex::Metric::identity(0);
  convex::DoubleDoubleVector truth;
  double scale = 1;  ///< the error is ||x - truth||_W over this
};

/// What a way has found, and its bound on ||x - truth||_W.
struct FoundVector {
  convex::Vector x;
  double bound = 0;
  bool gave_up = false;
};

/// A way of finding the vector.
struct Way {
  std::string method;
  convex::MethodKind kind = convex::MethodKind::direct;
  std::string refused;  ///< why it does not apply; empty when it does
  std::function<FoundVector(double tolerance)> find;
};

/// Every way before an exam.
std::vector<Contest> contests(VectorExam, std::vector<Way>);

}  // namespace cli::inline measurement
