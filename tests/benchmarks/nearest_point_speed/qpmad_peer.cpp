#include "peers.hpp"

#ifdef MOREAU_HAS_QPMAD
#include <qpmad/solver.h>

namespace speed {
namespace {

/// qpmad: Goldfarb and Idnani 1983. Again: with the inverse factor of A that it hands back.
class Qpmad final : public Peer {
 public:
  explicit Qpmad(const DenseProblem& problem)
      : A_(problem.A),
        linear_(-problem.z),
        U_(problem.U),
        lower_(problem.s),
        upper_(Vector::Constant(problem.s.size(), 1e20)) {
    answer.resize(problem.z.size());
  }
  Outcome cold() override {
    factor_ = A_;
    return solve({});
  }
  Outcome again(const Vector& z, const Vector& s) override {
    qpmad::SolverParameters parameters;
    parameters.return_inverted_cholesky_factor_ = true;
    if (kept_)
      parameters.hessian_type_ = solver_.getHessianType();
    else
      factor_ = A_;
    kept_ = true;
    linear_ = -z;
    lower_ = s;
    return solve(parameters);
  }

 private:
  Outcome solve(const qpmad::SolverParameters& parameters) {
    try {
      const auto status = solver_.solve(answer, factor_, linear_, U_, lower_, upper_, parameters);
      return status == qpmad::Solver::OK ? Outcome::solved : Outcome::failed;
    } catch (const std::runtime_error&) {  // so it says that there is no answer
      return Outcome::infeasible;
    }
  }

  Matrix A_, factor_;
  Vector linear_;
  Matrix U_;
  Vector lower_, upper_;
  qpmad::Solver solver_;
  bool kept_ = false;
};

}  // namespace

std::unique_ptr<Peer> make_qpmad(const DenseProblem& problem) { return std::make_unique<Qpmad>(problem); }

}  // namespace speed
#else
std::unique_ptr<speed::Peer> speed::make_qpmad(const DenseProblem&) { return nullptr; }
#endif
