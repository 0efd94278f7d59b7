// A shared module, loaded when the method `ceres` is asked for and not before: what Ceres links to (OpenBLAS,
// OpenMP) costs 6 ms at the start of a process.
#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>

namespace {

using Columns = Eigen::Map<const Eigen::MatrixXd>;
using Values = Eigen::Map<const Eigen::VectorXd>;

/// The residuals d and root(1/theta) (push_a - v_a·d)₊, without the positive part where `is_free`, with their
/// derivative.
class HingeResidual final : public ceres::CostFunction {
 public:
  HingeResidual(const Columns& V, const Values& push, const char* is_free, double theta)
      : V_(V), push_(push), is_free_(is_free), weight_(1 / std::sqrt(theta)) {
    set_num_residuals(static_cast<int>(V.rows() + V.cols()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(V.rows()));
  }
  bool Evaluate(double const* const* parameters, double* residual, double** jacobian) const override {
    const Eigen::Index n = V_.rows(), k = V_.cols();
    const Values d(parameters[0], n);
    Eigen::Map<Eigen::VectorXd> r(residual, n + k);
    r.head(n) = d;
    r.tail(k) = push_ - V_.transpose() * d;
    const bool wanted = jacobian != nullptr && jacobian[0] != nullptr;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> J(
        wanted ? jacobian[0] : nullptr, wanted ? n + k : 0, n);
    if (wanted) J.topRows(n).setIdentity();
    for (Eigen::Index a = 0; a < k; ++a) {
      const bool held = is_free_[a] != 0 || r[n + a] > 0;
      r[n + a] = held ? weight_ * r[n + a] : 0;
      if (!wanted) continue;
      if (held)
        J.row(n + a) = -weight_ * V_.col(a).transpose();
      else
        J.row(n + a).setZero();
    }
    return true;
  }

 private:
  Columns V_;
  Values push_;
  const char* is_free_;
  double weight_;
};

}  // namespace

/// Minimises ½|d|² + Σ ½/theta (push_a - v_a·d)²₊ over d, without the positive part where `is_free`. V: n×k
/// by columns; push: k; d: n, start and result. Returns the number of iterations, or -1 when Ceres fails.
extern "C" long moreau_hinge_least_squares(long n, long k, const double* V, const double* push,
                                           const char* is_free, double theta, double* d,
                                           long most_iterations) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // a step without progress is for the judge to report
  ceres::Problem problem;
  problem.AddResidualBlock(new HingeResidual(Columns(V, n, k), Values(push, k), is_free, theta), nullptr, d);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = static_cast<int>(most_iterations);
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-15;
  options.initial_trust_region_radius = 1e12;
  options.max_trust_region_radius = 1e30;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE) return -1;
  return static_cast<long>(summary.iterations.size());
}
