// A shared module, loaded when the method `ceres` is asked for and not before: what Ceres links to (OpenBLAS,
// OpenMP) costs 6 ms at the start of a process.
#include <ceres/ceres.h>

#include <Eigen/Core>
#include <vector>

namespace {

using Columns = Eigen::Map<const Eigen::MatrixXd>;

/// The residuals E y - f with their derivative E.
class LinearResidual final : public ceres::CostFunction {
 public:
  LinearResidual(const Columns& E, const double* f) : E_(E), f_(f) {
    set_num_residuals(static_cast<int>(E.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(E.cols()));
  }
  bool Evaluate(double const* const* y, double* residual, double** jacobian) const override {
    Eigen::Map<Eigen::VectorXd>(residual, E_.rows()) =
        E_ * Eigen::Map<const Eigen::VectorXd>(y[0], E_.cols()) -
        Eigen::Map<const Eigen::VectorXd>(f_, E_.rows());
    if (jacobian != nullptr && jacobian[0] != nullptr)
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobian[0], E_.rows(), E_.cols()) = E_;
    return true;
  }

 private:
  Columns E_;
  const double* f_;
};

}  // namespace

/// Minimises |E y - f|² over y_a >= 0, y_a free where `is_free`; E: rows×columns by columns; y: start and
/// result. Returns the number of iterations, or -1 when Ceres fails.
extern "C" long moreau_bounded_least_squares(long rows, long columns, const double* E, const double* f,
                                             const char* is_free, double* y, double radius,
                                             long most_iterations) {
  ceres::Problem problem;
  problem.AddResidualBlock(new LinearResidual(Columns(E, rows, columns), f), nullptr, y);
  for (long a = 0; a < columns; ++a)
    if (is_free[a] == 0) problem.SetParameterLowerBound(y, static_cast<int>(a), 0);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = static_cast<int>(most_iterations);
  options.function_tolerance = 0;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-15;
  options.initial_trust_region_radius = radius;
  options.max_trust_region_radius = radius;
  // What a step is expected to bring counts what the bounds take away from it, so that little of it remains.
  options.min_relative_decrease = 1e-14;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE) return -1;
  return static_cast<long>(summary.iterations.size());
}
