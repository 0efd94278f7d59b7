#include "peers.hpp"

#ifdef MOREAU_HAS_EIQUADPROG
#include <eiquadprog/eiquadprog-fast.hpp>

namespace speed {
namespace {

/// eiquadprog, its fast variant: Goldfarb and Idnani 1983. It keeps nothing from one solve to the next: the
/// inverse factor that it can be given starts it, up to 1.2.9, from the wrong sign of the unconstrained
/// answer.
class Eiquadprog final : public Peer {
 public:
  explicit Eiquadprog(const DenseProblem& problem)
      : A_(problem.A), linear_(-problem.z), U_(problem.U), offset_(-problem.s), none_(0, problem.z.size()) {
    answer.resize(problem.z.size());
    solver_.reset(static_cast<std::size_t>(U_.cols()), 0, static_cast<std::size_t>(U_.rows()));
  }
  Outcome cold() override {
    using namespace eiquadprog::solvers;
    switch (solver_.solve_quadprog(A_, linear_, none_, Vector(0), U_, offset_, answer)) {
      case EIQUADPROG_FAST_OPTIMAL:
        return Outcome::solved;
      case EIQUADPROG_FAST_INFEASIBLE:
      case EIQUADPROG_FAST_UNBOUNDED:  // the dual is
        return Outcome::infeasible;
      default:
        return Outcome::failed;
    }
  }
  Outcome again(const Vector& z, const Vector& s) override {
    linear_ = -z;
    offset_ = -s;
    return cold();
  }

 private:
  Matrix A_;
  Vector linear_;
  Matrix U_;
  Vector offset_;
  Matrix none_;
  eiquadprog::solvers::EiquadprogFast solver_;
};

}  // namespace

std::unique_ptr<Peer> make_eiquadprog(const DenseProblem& problem) {
  return std::make_unique<Eiquadprog>(problem);
}

}  // namespace speed
#else
std::unique_ptr<speed::Peer> speed::make_eiquadprog(const DenseProblem&) { return nullptr; }
#endif
