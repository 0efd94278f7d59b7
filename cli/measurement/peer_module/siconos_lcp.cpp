#include <siconos/numerics/LinearComplementarityProblem.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/lcp_cst.h>

#include <cstring>
#include <vector>

/// w = M lambda + q, w >= 0, lambda >= 0, w·lambda = 0 by a solver of Siconos with its own settings but for
/// the tolerance; 0 when it says that it is solved. M: m×m by columns; q, lambda: m.
extern "C" int moreau_siconos_lcp(const char* solver, int m, double* M, double* q, double tolerance,
                                  double* lambda) {
  const int name = std::strcmp(solver, "lemke") == 0 ? SICONOS_LCP_LEMKE
                   : std::strcmp(solver, "pgs") == 0 ? SICONOS_LCP_PGS
                                                     : SICONOS_LCP_NEWTON_FB_FBLSA;
  NumericsMatrix matrix;
  NM_null(&matrix);
  NM_fill(&matrix, NM_DENSE, m, m, M);
  LinearComplementarityProblem problem{m, &matrix, q};
  SolverOptions* options = solver_options_create(name);
  options->dparam[SICONOS_DPARAM_TOL] = tolerance;
  constexpr int most_iterations = 100000;
  if (name != SICONOS_LCP_LEMKE) options->iparam[SICONOS_IPARAM_MAX_ITER] = most_iterations;
  std::vector<double> w(static_cast<std::size_t>(m));
  const int info = linearComplementarity_driver(&problem, lambda, w.data(), options);
  solver_options_delete(options);
  return info;
}
