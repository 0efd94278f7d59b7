#include <daqp/api.h>

#include <vector>

#include "cli/measurement/peer_module/peer_program.hpp"

/// DAQP: Arnström, Bemporad and Axehill 2022, a dual active set method.
extern "C" int moreau_peer(PeerProgram* program) {
  const auto m = static_cast<std::size_t>(program->m), n = static_cast<std::size_t>(program->n);
  constexpr double unbounded = 1e30;
  constexpr int equality = 5;  // active, and never to be dropped
  std::vector<double> H(program->A, program->A + n * n), U(program->U, program->U + m * n), linear(n);
  std::vector<double> lower(program->s, program->s + m), upper(m, unbounded), multipliers(m + n);
  std::vector<int> sense(m, 0);
  for (std::size_t i = 0; i < n; ++i) linear[i] = -program->z[i];
  for (std::size_t a = 0; a < m; ++a)
    if (program->two_sided[a] != 0) {
      upper[a] = lower[a];
      sense[a] = equality;
    }
  DAQPSettings settings{};
  daqp_default_settings(&settings);
  program->own_tolerance = settings.primal_tol;
  if (program->tolerance > 0) settings.primal_tol = settings.dual_tol = program->tolerance;
  DAQPProblem problem{};
  problem.n = program->n;
  problem.m = program->m;
  problem.H = H.data();
  problem.f = linear.data();
  problem.A = U.data();
  problem.bupper = upper.data();
  problem.blower = lower.data();
  problem.sense = sense.data();
  DAQPResult result{};
  result.x = program->q;
  result.lam = multipliers.data();
  daqp_quadprog(&result, &problem, &settings);
  if (result.exitflag == DAQP_EXIT_OPTIMAL) return peer_solved;
  return result.exitflag == DAQP_EXIT_INFEASIBLE ? peer_infeasible : peer_failed;
}
