#include "peers.hpp"

#ifdef MOREAU_HAS_QUADPROG
#include <Eigen/Cholesky>
#include <algorithm>

extern "C" int qpgen2_(double* G, double* a, int n, double* x, double* multipliers, double* value, double* C,
                       double* b, int m, int equalities, int* active, int* active_count, int* iterations,
                       double* work, int factorized);

namespace speed {
namespace {

/// The C code of Python's quadprog: Goldfarb and Idnani 1983, after Turlach. Again: with the inverse factor
/// of A.
class Quadprog final : public Peer {
 public:
  explicit Quadprog(const DenseProblem& problem)
      : A_(problem.A),
        z_(problem.z),
        columns_(problem.U.transpose()),
        s_(problem.s),
        lambda_(problem.s.size()) {
    const Index n = z_.size(), m = s_.size(), r = std::min(n, m);
    answer.resize(n);
    active_.resize(static_cast<std::size_t>(m));
    work_.resize(2 * n + 2 * m + r * (r + 5) / 2);
  }
  Outcome cold() override {
    overwritten_ = A_;
    return solve(false);
  }
  Outcome again(const Vector& z, const Vector& s) override {
    if (inverse_factor_.size() == 0) {
      inverse_factor_ = Matrix::Identity(z.size(), z.size());
      Eigen::LLT<Matrix>(A_).matrixU().solveInPlace(inverse_factor_);
    }
    overwritten_ = inverse_factor_;
    z_ = z;
    s_ = s;
    return solve(true);
  }

 private:
  Outcome solve(bool factorized) {
    linear_ = z_;
    int count = 0, iterations[2] = {};
    double value = 0;
    const int code = qpgen2_(overwritten_.data(), linear_.data(), static_cast<int>(z_.size()), answer.data(),
                             lambda_.data(), &value, columns_.data(), s_.data(), static_cast<int>(s_.size()),
                             0, active_.data(), &count, iterations, work_.data(), factorized);
    return code == 0 ? Outcome::solved : code == 1 ? Outcome::infeasible : Outcome::failed;
  }

  Matrix A_, inverse_factor_, overwritten_;
  Vector z_, linear_;
  Matrix columns_;
  Vector s_, lambda_, work_;
  std::vector<int> active_;
};

}  // namespace

std::unique_ptr<Peer> make_quadprog(const DenseProblem& problem) {
  return std::make_unique<Quadprog>(problem);
}

}  // namespace speed
#else
std::unique_ptr<speed::Peer> speed::make_quadprog(const DenseProblem&) { return nullptr; }
#endif
