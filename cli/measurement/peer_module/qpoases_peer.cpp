#include <qpOASES.hpp>

#include <vector>

#include "cli/measurement/peer_module/peer_program.hpp"

/// qpOASES: Ferreau, Kirches, Potschka, Bock and Diehl 2014, a parametric active set method.
extern "C" int moreau_peer(PeerProgram* program) {
  const auto m = static_cast<std::size_t>(program->m), n = static_cast<std::size_t>(program->n);
  std::vector<double> linear(n), upper(m, qpOASES::INFTY);
  for (std::size_t i = 0; i < n; ++i) linear[i] = -program->z[i];
  for (std::size_t a = 0; a < m; ++a)
    if (program->two_sided[a] != 0) upper[a] = program->s[a];
  qpOASES::QProblem problem(program->n, program->m, qpOASES::HST_POSDEF);
  qpOASES::Options settings;
  program->own_tolerance = settings.terminationTolerance;
  if (program->tolerance > 0) settings.terminationTolerance = program->tolerance;
  settings.printLevel = qpOASES::PL_NONE;
  problem.setOptions(settings);
  qpOASES::int_t most_steps = 10 * (program->n + program->m) + 1000;
  const qpOASES::returnValue said = problem.init(program->A, linear.data(), program->U, nullptr, nullptr,
                                                 program->s, upper.data(), most_steps);
  problem.getPrimalSolution(program->q);
  if (said == qpOASES::SUCCESSFUL_RETURN) return peer_solved;
  return problem.isInfeasible() == qpOASES::BT_TRUE ? peer_infeasible : peer_failed;
}
