#pragma once

#include <functional>

#include "cli/python/solved_numbers.hpp"

namespace pybind11 {
class object;
class tuple;
}  // namespace pybind11

namespace python {

/// Problems of one size, the first axis their number: A (B, n, n), (B, n) for diagonals, or as one problem
/// has it; z (B, n) or (n); U (B, m, n) or (m, n); s (B, m) or (m). Returns accelerations (B, n) and
/// multipliers (B, m), not numbers where there is none; error bounds (B); codes of status (B); the Farkas
/// weights of what is infeasible, by number. Where A and U are common to all, their factors are made once,
/// and each chunk of problems begins from the rows active in the one before.
pybind11::tuple solve_batch(const pybind11::object& A, const pybind11::object& z, const pybind11::object& U,
                            const pybind11::object& s, const pybind11::object& two_sided, const SolveChoice&);

/// Does `work` for the chunks [first, last) of [0, count) on all processors. The chunks do not depend on how
/// many these are, and so neither do answers. Rethrows the error of the earliest chunk that had one. To be
/// called without the interpreter's lock.
void in_chunks(convex::Index count, const std::function<void(convex::Index first, convex::Index last)>& work);

}  // namespace python
