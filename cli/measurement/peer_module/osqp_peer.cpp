#include <osqp.h>

#include <vector>

#include "cli/measurement/peer_module/peer_program.hpp"

/// Columns of an m×n matrix of rows, or of the upper half of a symmetric one.
struct SparseColumns {
  std::vector<OSQPFloat> values;
  std::vector<OSQPInt> rows, starts{0};
  OSQPCscMatrix matrix{};

  SparseColumns(const double* by_rows, int m, int n, bool upper_half) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < (upper_half ? j + 1 : m); ++i) {
        const double entry =
            by_rows[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)];
        if (entry == 0) continue;
        values.push_back(static_cast<OSQPFloat>(entry));
        rows.push_back(static_cast<OSQPInt>(i));
      }
      starts.push_back(static_cast<OSQPInt>(values.size()));
    }
    OSQPCscMatrix_set_data(&matrix, m, n, static_cast<OSQPInt>(values.size()), values.data(), rows.data(),
                           starts.data());
  }
};

/// OSQP 1: Stellato, Banjac, Goulart, Bemporad and Boyd 2020, alternating directions; `polishing` is left as
/// its own settings have it. With a tolerance of ours it is on, and more steps are allowed.
extern "C" int moreau_peer(PeerProgram* program) {
  const auto m = static_cast<std::size_t>(program->m), n = static_cast<std::size_t>(program->n);
  std::vector<OSQPFloat> linear(n), upper(m, OSQP_INFTY), lower(program->s, program->s + m);
  for (std::size_t i = 0; i < n; ++i) linear[i] = static_cast<OSQPFloat>(-program->z[i]);
  for (std::size_t a = 0; a < m; ++a)
    if (program->two_sided[a] != 0) upper[a] = lower[a];
  const SparseColumns A(program->A, program->n, program->n, true),
      U(program->U, program->m, program->n, false);
  OSQPSettings settings{};
  osqp_set_default_settings(&settings);
  settings.verbose = 0;
  program->own_tolerance = settings.eps_abs;
  if (program->tolerance > 0) {
    constexpr int most_steps = 200000;
    settings.eps_abs = settings.eps_rel = program->tolerance;
    settings.max_iter = most_steps;
    settings.polishing = 1;
  }
  OSQPSolver* solver = nullptr;
  if (osqp_setup(&solver, &A.matrix, linear.data(), &U.matrix, lower.data(), upper.data(),
                 static_cast<OSQPInt>(m), static_cast<OSQPInt>(n), &settings) != 0)
    return peer_failed;
  osqp_solve(solver);
  for (std::size_t i = 0; i < n; ++i) program->q[i] = static_cast<double>(solver->solution->x[i]);
  const OSQPInt said = solver->info->status_val;
  osqp_cleanup(solver);
  if (said == OSQP_SOLVED) return peer_solved;
  return said == OSQP_PRIMAL_INFEASIBLE ? peer_infeasible : peer_failed;
}
