#include <Eigen/Core>
#include <limits>
#include <piqp/piqp.hpp>

#include "cli/measurement/peer_module/peer_program.hpp"

/// PIQP: Schwan, Jiang, Kuhn and Jones 2023, a proximal interior-point method.
extern "C" int moreau_peer(PeerProgram* program) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index n = program->n, m = program->m;
  const Eigen::MatrixXd P = Eigen::Map<const Eigen::MatrixXd>(program->A, n, n);
  const Eigen::VectorXd c = -Eigen::Map<const Eigen::VectorXd>(program->z, n);
  const Eigen::Map<const Rows> U(program->U, m, n);
  Eigen::Index equalities = 0;
  for (Eigen::Index a = 0; a < m; ++a) equalities += program->two_sided[a] != 0 ? 1 : 0;
  Eigen::MatrixXd A(equalities, n), G(m - equalities, n);
  Eigen::VectorXd b(equalities), lower(m - equalities);
  for (Eigen::Index a = 0, held = 0, free = 0; a < m; ++a) {
    if (program->two_sided[a] != 0) {
      A.row(held) = U.row(a);
      b[held++] = program->s[a];
    } else {
      G.row(free) = U.row(a);
      lower[free++] = program->s[a];
    }
  }
  piqp::DenseSolver<double> solver;
  program->own_tolerance = solver.settings().eps_abs;
  if (program->tolerance > 0) {
    solver.settings().eps_abs = solver.settings().eps_rel = program->tolerance;
    solver.settings().eps_duality_gap_abs = solver.settings().eps_duality_gap_rel = program->tolerance;
  }
  solver.setup(P, c, A, b, G, lower);
  const piqp::Status said = solver.solve();
  Eigen::Map<Eigen::VectorXd>(program->q, n) = solver.result().x;
  if (said == piqp::Status::PIQP_SOLVED) return peer_solved;
  return said == piqp::Status::PIQP_PRIMAL_INFEASIBLE ? peer_infeasible : peer_failed;
}
