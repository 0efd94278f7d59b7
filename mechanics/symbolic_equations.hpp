#pragma once

#include <string>
#include <vector>

#include "mechanics/expression/lagrangian_model.hpp"

namespace mechanics {

/// A, z, U and s as expressions in q, q' and t (Moreau 1966, (7) and (8)): with p = ∂T/∂q' and g_a = df_a/dt,
///   A = ∂p/∂q',   z = ∂(T - V)/∂q + Q - (∂p/∂q) q' - ∂p/∂t,   u_a = ∂f_a/∂q,   s_a = -(∂g_a/∂q) q' -
///   ∂g_a/∂t.
/// Sums with 0, products with 0 and 1 and double signs are taken out; equal parts are one node.
struct SymbolicEquations {
  expression::Tape tape;
  std::vector<std::string> coordinates;
  std::vector<std::vector<expression::NodeId>> A;  ///< n×n, symmetric
  std::vector<expression::NodeId> z;               ///< n
  std::vector<std::vector<expression::NodeId>> U;  ///< by contact: n
  std::vector<expression::NodeId> s;               ///< by contact
};

/// How parameters and constants are to stand in the expressions: by their names, or computed.
enum class ConstantsAs { written, numbers };

/// `contacts`: the constraints wanted, in order. Throws InvalidInput where something has no derivative in
/// symbols.
SymbolicEquations symbolic_equations(const expression::LagrangianModel&, const std::vector<Index>& contacts,
                                     ConstantsAs constants);

}  // namespace mechanics
