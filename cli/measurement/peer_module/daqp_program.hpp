#pragma once

#include <daqp/api.h>

#include <cstddef>
#include <vector>

/// minimise ½ q·Aq - z·q over Uq >= s as DAQP takes it (Arnström, Bemporad and Axehill 2022), with equality
/// where `two_sided`, null for nowhere, is not 0. A: n×n; U: m×n by rows; the answer goes to q, of which
/// there are n.
struct DaqpProgram {
  static constexpr double unbounded = 1e30;
  static constexpr int equality = 5;  ///< active, and never to be dropped

  std::vector<double> H, U, linear, lower, upper, multipliers;
  std::vector<int> sense;
  DAQPProblem problem{};
  DAQPResult result{};

  DaqpProgram(int variables, int rows, const double* A, const double* z, const double* by_rows,
              const double* s, const unsigned char* two_sided, double* q) {
    const auto n = static_cast<std::size_t>(variables), m = static_cast<std::size_t>(rows);
    H.assign(A, A + n * n);
    U.assign(by_rows, by_rows + m * n);
    lower.assign(s, s + m);
    upper.assign(m, unbounded);
    sense.assign(m, 0);
    multipliers.resize(m + n);
    linear.resize(n);
    for (std::size_t i = 0; i < n; ++i) linear[i] = -z[i];
    for (std::size_t a = 0; two_sided != nullptr && a < m; ++a)
      if (two_sided[a] != 0) {
        upper[a] = lower[a];
        sense[a] = equality;
      }
    problem.n = variables;
    problem.m = rows;
    problem.H = H.data();
    problem.f = linear.data();
    problem.A = U.data();
    problem.bupper = upper.data();
    problem.blower = lower.data();
    problem.sense = sense.data();
    result.x = q;
    result.lam = multipliers.data();
  }
  DaqpProgram(const DaqpProgram&) = delete;
  DaqpProgram& operator=(const DaqpProgram&) = delete;

  bool is_solved() const { return result.exitflag == DAQP_EXIT_OPTIMAL; }
  bool is_infeasible() const { return result.exitflag == DAQP_EXIT_INFEASIBLE; }
};
