// Time of the default method from raw (A, z, U, s), cold, beside the floor: one factorisation with the active
// set known. Then warm: `RepeatedProblem`, z and s moved by 1 % each time. In doubles: with `refine` off.
//   nearest_point_speed [--smoke]
// Problems are planted: A = BBᵀ/n + I and U Gaussian, min(n, m)/2 active rows with random positive
// multipliers, the others apart. Processor time, the least of 15 batches taken in turn, the mean of five
// problems. DAQP stands beside it when it was there to be linked (-DDAQP_ROOT=…), else its column is 0.
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <random>
#include <vector>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/repeated_problem.hpp"

#ifdef MOREAU_HAS_DAQP
#include <daqp/api.h>
extern "C" {
#include <daqp/utils.h>
}
#endif

namespace {

using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

struct RawProblem {
  Matrix A;
  RowMatrix U;
  Vector z, s, solution;
  std::vector<Index> active;
};

RawProblem planted(Index n, Index m, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto& M) {
    for (Index i = 0; i < M.size(); ++i) M.data()[i] = normal(generator);
  };
  RawProblem raw;
  Matrix B(n, n);
  fill(B);
  raw.A = B * B.transpose() / static_cast<double>(n) + Matrix::Identity(n, n);
  raw.U.resize(m, n);
  fill(raw.U);
  raw.solution.resize(n);
  fill(raw.solution);
  Vector lambda = Vector::Zero(m);
  raw.s = raw.U * raw.solution;
  std::vector<Index> rows(static_cast<std::size_t>(m));
  for (Index a = 0; a < m; ++a) rows[static_cast<std::size_t>(a)] = a;
  std::shuffle(rows.begin(), rows.end(), generator);
  const Index k = std::min(n, m) / 2;
  for (Index j = 0; j < m; ++j) {
    const Index a = rows[static_cast<std::size_t>(j)];
    if (j < k) {
      lambda[a] = std::abs(normal(generator)) + 0.01;
      raw.active.push_back(a);
    } else {
      raw.s[a] -= std::abs(normal(generator)) * std::sqrt(static_cast<double>(n));
    }
  }
  raw.z = raw.A * raw.solution - raw.U.transpose() * lambda;
  return raw;
}

/// One Cholesky factor, the active rows whitened, one Householder QR, three triangular solves.
Vector floor_solve(const RawProblem& raw) {
  const Eigen::LLT<Matrix> factor(raw.A);
  const Index n = raw.z.size(), k = static_cast<Index>(raw.active.size());
  Matrix V(n, k);
  Vector s(k);
  for (Index j = 0; j < k; ++j) {
    V.col(j) = raw.U.row(raw.active[static_cast<std::size_t>(j)]);
    s[j] = raw.s[raw.active[static_cast<std::size_t>(j)]];
  }
  factor.matrixL().solveInPlace(V);
  const Vector w_free = factor.matrixL().solve(raw.z);
  const Eigen::HouseholderQR<Matrix> qr(V);
  const auto R = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
  Vector t = qr.householderQ().transpose() * w_free;
  t.head(k) = R.transpose().solve(s);
  const Vector w = qr.householderQ() * t;
  return factor.matrixU().solve(w);
}

convex::NearestPointProblem assembled(const RawProblem& raw) {
  return {convex::Metric::dense(raw.A), raw.z, convex::ConstraintRows(raw.U), raw.s, {}};
}

/// From raw data: the metric factored, the problem assembled and solved.
Vector solve(const RawProblem& raw, convex::Status& status, const convex::Accuracy& accuracy = {}) {
  const convex::Solution solution = convex::automatic(assembled(raw), accuracy);
  status = solution.status;
  return solution.q;
}

convex::Accuracy in_doubles() {
  convex::Accuracy accuracy;
  accuracy.refine = false;
  return accuracy;
}

/// z and s of a problem, moved a little, one after the other and round again.
class Moved {
 public:
  explicit Moved(const RawProblem& raw) {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    const auto moved = [&](Vector x) {
      for (Index i = 0; i < x.size(); ++i) x[i] *= 1 + 0.01 * normal(generator);
      return x;
    };
    for (int k = 0; k < 16; ++k) {
      z_.push_back(moved(raw.z));
      s_.push_back(moved(raw.s));
    }
  }
  void next() { at_ = (at_ + 1) % z_.size(); }
  const Vector& z() const { return z_[at_]; }
  const Vector& s() const { return s_[at_]; }

 private:
  std::vector<Vector> z_, s_;
  std::size_t at_ = 0;
};

#ifdef MOREAU_HAS_DAQP
/// DAQP (Arnström, Bemporad and Axehill 2022) from the same data, with its default settings.
class Daqp {
 public:
  explicit Daqp(const RawProblem& raw)
      : A_(raw.A),
        U_(raw.U),
        f_(-raw.z),
        upper_(Vector::Constant(raw.s.size(), 1e30)),
        lower_(raw.s),
        x_(raw.z.size()),
        lambda_(raw.s.size()),
        sense_(static_cast<std::size_t>(raw.s.size()), 0) {
    problem_.n = static_cast<int>(raw.z.size());
    problem_.m = static_cast<int>(raw.s.size());
    problem_.H = A_.data();
    problem_.f = f_.data();
    problem_.A = U_.data();
    problem_.bupper = upper_.data();
    problem_.blower = lower_.data();
    problem_.sense = sense_.data();
    result_.x = x_.data();
    result_.lam = lambda_.data();
  }
  const Vector& cold() {
    std::fill(sense_.begin(), sense_.end(), 0);
    daqp_quadprog(&result_, &problem_, nullptr);
    return x_;
  }
  void set_up() {
    setup_daqp(&problem_, &work_, nullptr);
    daqp_solve(&result_, &work_);
  }
  void warm(const Vector& z, const Vector& s) {
    f_ = -z;
    lower_ = s;
    daqp_update_ldp(DAQP_UPDATE_v | DAQP_UPDATE_d, &work_, &problem_);
    daqp_solve(&result_, &work_);
  }

 private:
  DAQPWorkspace work_{};
  Matrix A_;
  RowMatrix U_;
  Vector f_, upper_, lower_, x_, lambda_;
  std::vector<int> sense_;
  DAQPProblem problem_{};
  DAQPResult result_{};
};
#endif

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work>
double seconds_per_call(Work work, int calls) {
  const double start = processor_seconds();
  for (int i = 0; i < calls; ++i) work();
  return (processor_seconds() - start) / calls;
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  std::vector<std::pair<Index, Index>> sizes{{6, 4},   {9, 7},    {12, 10},   {17, 20},   {30, 30},
                                             {45, 60}, {60, 120}, {100, 200}, {140, 280}, {200, 400}};
  if (smoke) sizes = {{6, 4}, {30, 30}};
  std::printf("%5s %5s %10s %10s %10s %10s %10s %10s %10s %10s  %s\n", "n", "m", "solve (us)", "in doubles",
              "floor", "DAQP", "warm", "in doubles", "DAQP", "error", "status");
  for (const auto& [n, m] : sizes) {
    constexpr unsigned problems = 5;
    constexpr double never = 1e9;
    double times[7] = {}, error = 0;
    bool solved = true;
    for (unsigned seed = 0; seed < problems; ++seed) {
      const RawProblem raw = planted(n, m, 100 * static_cast<unsigned>(n) + seed);
      convex::Status status{};
      const Vector q = solve(raw, status);
      solved = solved && status == convex::Status::solved;
      error = std::max(error, (q - raw.solution).norm() / raw.solution.norm());
      const double once = seconds_per_call([&] { solve(raw, status); }, 1);
      const int calls = smoke ? 1 : std::max(1, static_cast<int>(1e-3 / once));
      double best[7];
      std::fill(best, best + 7, never);
      const auto time = [&](int k, auto work, int times_over = 1) {
        best[k] = std::min(best[k], seconds_per_call(work, times_over * calls));
      };
      const int warm_over = smoke ? 1 : 16;  // once round what is moved, at least
      Moved moved(raw);
      convex::RepeatedProblem repeated(assembled(raw)), coarse(assembled(raw), in_doubles());
      repeated.solve(raw.z, raw.s);
      coarse.solve(raw.z, raw.s);
      const auto warm = [&](convex::RepeatedProblem& problem) {
        moved.next();
        solved = problem.solve(moved.z(), moved.s()).status == convex::Status::solved && solved;
      };
#ifdef MOREAU_HAS_DAQP
      Daqp daqp(raw), warm_daqp(raw);
      warm_daqp.set_up();
#endif
      for (int batch = 0; batch < (smoke ? 1 : 15); ++batch) {
        time(0, [&] { solve(raw, status); });
        time(1, [&] { solve(raw, status, in_doubles()); });
        time(2, [&] { floor_solve(raw); });
        time(
            4, [&] { warm(repeated); }, warm_over);
        time(
            5, [&] { warm(coarse); }, warm_over);
#ifdef MOREAU_HAS_DAQP
        time(3, [&] { daqp.cold(); });
        time(
            6,
            [&] {
              moved.next();
              warm_daqp.warm(moved.z(), moved.s());
            },
            warm_over);
#endif
      }
      for (int k = 0; k < 7; ++k) times[k] += best[k] < never ? best[k] / problems : 0;
    }
    std::printf("%5ld %5ld", static_cast<long>(n), static_cast<long>(m));
    for (const double time : times) std::printf(" %10.2f", time * 1e6);
    std::printf(" %10.1e  %s\n", error, solved ? "solved" : "NOT SOLVED");
  }
  return 0;
}
