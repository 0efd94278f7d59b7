#include <osqp.h>

#include <Eigen/Dense>

namespace {

using StandInMatrix = Eigen::MatrixXd;
using StandInVector = Eigen::VectorXd;

struct StandIn {
  OSQPSettings settings;
  OSQPSolution solution;
  OSQPInfo info;
  StandInMatrix P, A;
  StandInVector q, l, u, x, y;
};

/// False where an entry lies outside, or columns are not in order.
bool read(const OSQPCscMatrix& M, StandInMatrix& dense) {
  dense = StandInMatrix::Zero(M.m, M.n);
  for (OSQPInt j = 0; j < M.n; ++j)
    for (OSQPInt k = M.p[j]; k < M.p[j + 1]; ++k) {
      if (k >= M.nzmax || M.i[k] < 0 || M.i[k] >= M.m || (k > M.p[j] && M.i[k] <= M.i[k - 1])) return false;
      dense(M.i[k], j) = M.x[k];
    }
  return true;
}

StandIn& stand_in(OSQPSolver* solver) { return *static_cast<StandIn*>(solver->work); }

}  // namespace

void OSQPCscMatrix_set_data(OSQPCscMatrix* M, OSQPInt m, OSQPInt n, OSQPInt nzmax, OSQPFloat* x, OSQPInt* i,
                            OSQPInt* p) {
  *M = {m, n, p, i, x, nzmax, -1, 0};
}

void osqp_set_default_settings(OSQPSettings* settings) { *settings = {1, 4000, 0, 1e-3, 1e-3}; }

OSQPInt osqp_setup(OSQPSolver** solver, const OSQPCscMatrix* P, const OSQPFloat* q, const OSQPCscMatrix* A,
                   const OSQPFloat* l, const OSQPFloat* u, OSQPInt m, OSQPInt n,
                   const OSQPSettings* settings) {
  auto* made = new StandIn{*settings, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  const bool fits = P->m == n && P->n == n && A->m == m && A->n == n && read(*P, made->P) &&
                    read(*A, made->A) &&
                    made->P.triangularView<Eigen::StrictlyLower>().toDenseMatrix().isZero(0);
  made->P = StandInMatrix(made->P.selfadjointView<Eigen::Upper>());
  made->q = Eigen::Map<const StandInVector>(q, n);
  made->l = Eigen::Map<const StandInVector>(l, m);
  made->u = Eigen::Map<const StandInVector>(u, m);
  if (!fits || settings->verbose != 0 || (made->u.array() < made->l.array()).any() ||
      made->P.ldlt().isNegative()) {
    delete made;
    return 1;
  }
  *solver = new OSQPSolver{&made->settings, &made->solution, &made->info, made};
  return 0;
}

/// Alternating directions until both residuals are within eps_abs; a residual of the rows that stays is taken
/// for a contradiction.
OSQPInt osqp_solve(OSQPSolver* solver) {
  StandIn& s = stand_in(solver);
  constexpr double sigma = 1e-6, rho = 1, contradiction = 1e-2;
  s.x = StandInVector::Zero(s.q.size());
  s.y = StandInVector::Zero(s.l.size());
  StandInVector z = s.y;
  const StandInMatrix K =
      s.P + sigma * StandInMatrix::Identity(s.P.rows(), s.P.cols()) + rho * s.A.transpose() * s.A;
  const Eigen::LDLT<StandInMatrix> factor(K);
  s.info.status_val = OSQP_MAX_ITER_REACHED;
  double rows_miss = 0;
  for (OSQPInt k = 0; k < s.settings.max_iter; ++k) {
    s.x = factor.solve(sigma * s.x - s.q + s.A.transpose() * (rho * z - s.y));
    const StandInVector Ax = s.A * s.x;
    z = (Ax + s.y / rho).cwiseMax(s.l).cwiseMin(s.u);
    s.y += rho * (Ax - z);
    rows_miss = (Ax - z).lpNorm<Eigen::Infinity>();
    const double slope_miss = (s.P * s.x + s.q + s.A.transpose() * s.y).lpNorm<Eigen::Infinity>();
    if (std::max(rows_miss, slope_miss) > s.settings.eps_abs) continue;
    s.info.status_val = OSQP_SOLVED;
    break;
  }
  if (s.info.status_val != OSQP_SOLVED && rows_miss > contradiction)
    s.info.status_val = OSQP_PRIMAL_INFEASIBLE;
  s.solution = {s.x.data(), s.y.data()};
  return 0;
}

OSQPInt osqp_cleanup(OSQPSolver* solver) {
  delete static_cast<StandIn*>(solver->work);
  delete solver;
  return 0;
}
