#include "peers.hpp"

#ifdef MOREAU_HAS_DAQP
#include "cli/measurement/peer_module/daqp_program.hpp"

#include <algorithm>
extern "C" {
#include <daqp/utils.h>
}

namespace speed {
namespace {

/// DAQP, a dual active set method. Again: its factors and rows are kept.
class Daqp final : public Peer {
 public:
  explicit Daqp(const DenseProblem& problem)
      : with_room_(answer, problem.z.size()),
        program_(static_cast<int>(problem.z.size()), static_cast<int>(problem.s.size()), problem.A.data(),
                 problem.z.data(), problem.U.data(), problem.s.data(), nullptr, answer.data()) {}
  ~Daqp() override {
    if (!kept_) return;
    free_daqp_workspace(&work_);
    free_daqp_ldp(&work_);
  }
  Daqp(const Daqp&) = delete;
  Daqp& operator=(const Daqp&) = delete;

  Outcome cold() override {
    std::fill(program_.sense.begin(), program_.sense.end(), 0);
    daqp_quadprog(&program_.result, &program_.problem, nullptr);
    return outcome();
  }
  Outcome again(const Vector& z, const Vector& s) override {
    Vector::Map(program_.linear.data(), z.size()) = -z;
    Vector::Map(program_.lower.data(), s.size()) = s;
    if (kept_)
      daqp_update_ldp(DAQP_UPDATE_v | DAQP_UPDATE_d, &work_, &program_.problem);
    else
      kept_ = setup_daqp(&program_.problem, &work_, nullptr) >= 0;
    daqp_solve(&program_.result, &work_);
    return outcome();
  }

 private:
  /// Makes room for the answer before the program points to it.
  struct Room {
    Room(Vector& answer, Index n) { answer.resize(n); }
  };

  Outcome outcome() const {
    if (program_.is_solved()) return Outcome::solved;
    return program_.is_infeasible() ? Outcome::infeasible : Outcome::failed;
  }

  Room with_room_;
  DaqpProgram program_;
  DAQPWorkspace work_{};
  bool kept_ = false;
};

}  // namespace

std::unique_ptr<Peer> make_daqp(const DenseProblem& problem) { return std::make_unique<Daqp>(problem); }

}  // namespace speed
#else
std::unique_ptr<speed::Peer> speed::make_daqp(const DenseProblem&) { return nullptr; }
#endif
