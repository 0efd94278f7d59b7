#include "peers.hpp"

#ifdef MOREAU_HAS_DAQP
#include <daqp/api.h>

#include <algorithm>
extern "C" {
#include <daqp/utils.h>
}

namespace speed {
namespace {

/// DAQP: Arnström, Bemporad and Axehill 2022, a dual active set method. Again: its factors and rows are kept.
class Daqp final : public Peer {
 public:
  explicit Daqp(const DenseProblem& problem)
      : A_(problem.A),
        U_(problem.U),
        linear_(-problem.z),
        lower_(problem.s),
        upper_(Vector::Constant(problem.s.size(), 1e30)),
        lambda_(problem.s.size()),
        sense_(static_cast<std::size_t>(problem.s.size()), 0) {
    answer.resize(problem.z.size());
    problem_.n = static_cast<int>(problem.z.size());
    problem_.m = static_cast<int>(problem.s.size());
    problem_.H = A_.data();
    problem_.f = linear_.data();
    problem_.A = U_.data();
    problem_.bupper = upper_.data();
    problem_.blower = lower_.data();
    problem_.sense = sense_.data();
    result_.x = answer.data();
    result_.lam = lambda_.data();
  }
  ~Daqp() override {
    if (!kept_) return;
    free_daqp_workspace(&work_);
    free_daqp_ldp(&work_);
  }
  Daqp(const Daqp&) = delete;
  Daqp& operator=(const Daqp&) = delete;

  Outcome cold() override {
    std::fill(sense_.begin(), sense_.end(), 0);
    daqp_quadprog(&result_, &problem_, nullptr);
    return outcome();
  }
  Outcome again(const Vector& z, const Vector& s) override {
    linear_ = -z;
    lower_ = s;
    if (kept_)
      daqp_update_ldp(DAQP_UPDATE_v | DAQP_UPDATE_d, &work_, &problem_);
    else
      kept_ = setup_daqp(&problem_, &work_, nullptr) >= 0;
    daqp_solve(&result_, &work_);
    return outcome();
  }

 private:
  Outcome outcome() const {
    if (result_.exitflag == DAQP_EXIT_OPTIMAL) return Outcome::solved;
    return result_.exitflag == DAQP_EXIT_INFEASIBLE ? Outcome::infeasible : Outcome::failed;
  }

  Matrix A_;
  RowMatrix U_;
  Vector linear_, lower_, upper_, lambda_;
  std::vector<int> sense_;
  DAQPProblem problem_{};
  DAQPResult result_{};
  DAQPWorkspace work_{};
  bool kept_ = false;
};

}  // namespace

std::unique_ptr<Peer> make_daqp(const DenseProblem& problem) { return std::make_unique<Daqp>(problem); }

}  // namespace speed
#else
std::unique_ptr<speed::Peer> speed::make_daqp(const DenseProblem&) { return nullptr; }
#endif
