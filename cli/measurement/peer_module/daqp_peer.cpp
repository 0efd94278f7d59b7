#include "cli/measurement/peer_module/daqp_program.hpp"
#include "cli/measurement/peer_module/peer_program.hpp"

/// DAQP: a dual active set method.
extern "C" int moreau_peer(PeerProgram* program) {
  DaqpProgram daqp(program->n, program->m, program->A, program->z, program->U, program->s, program->two_sided,
                   program->q);
  DAQPSettings settings{};
  daqp_default_settings(&settings);
  program->own_tolerance = settings.primal_tol;
  if (program->tolerance > 0) settings.primal_tol = settings.dual_tol = program->tolerance;
  daqp_quadprog(&daqp.result, &daqp.problem, &settings);
  if (daqp.is_solved()) return peer_solved;
  return daqp.is_infeasible() ? peer_infeasible : peer_failed;
}
