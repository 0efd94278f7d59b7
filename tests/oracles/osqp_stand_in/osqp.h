#pragma once

/// The part of OSQP 1's interface that its module uses, for a test without the package: names and order of
/// arguments are the package's (osqp.org, C interface), the solver behind them is a plain one.

using OSQPInt = long long;
using OSQPFloat = double;

struct OSQPCscMatrix {
  OSQPInt m, n;
  OSQPInt *p, *i;
  OSQPFloat* x;
  OSQPInt nzmax, nz, owned;
};

struct OSQPSettings {
  OSQPInt verbose, max_iter, polishing;
  OSQPFloat eps_abs, eps_rel;
};

struct OSQPSolution {
  OSQPFloat *x, *y;
};

struct OSQPInfo {
  OSQPInt status_val;
};

struct OSQPSolver {
  OSQPSettings* settings;
  OSQPSolution* solution;
  OSQPInfo* info;
  void* work;
};

constexpr OSQPFloat OSQP_INFTY = 1e30;
enum { OSQP_SOLVED = 1, OSQP_PRIMAL_INFEASIBLE = 3, OSQP_MAX_ITER_REACHED = 7 };

void OSQPCscMatrix_set_data(OSQPCscMatrix*, OSQPInt m, OSQPInt n, OSQPInt nzmax, OSQPFloat* x, OSQPInt* i,
                            OSQPInt* p);
void osqp_set_default_settings(OSQPSettings*);
/// min ½ x·Px + q·x, l <= Ax <= u; P: its upper half. Not 0: refused.
OSQPInt osqp_setup(OSQPSolver**, const OSQPCscMatrix* P, const OSQPFloat* q, const OSQPCscMatrix* A,
                   const OSQPFloat* l, const OSQPFloat* u, OSQPInt m, OSQPInt n, const OSQPSettings*);
OSQPInt osqp_solve(OSQPSolver*);
OSQPInt osqp_cleanup(OSQPSolver*);
