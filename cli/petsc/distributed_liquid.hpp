#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/liquid/liquid_scene.hpp"

namespace cli::petsc {

/// The pressure of a liquid on a grid that is divided among the processes of MPI.
struct DistributedPressure {
  bool has_converged = false;
  std::string reason;  ///< PETSc's, why the iteration ended
  convex::Index cells = 0, unknowns = 0;
  long newton_steps = 0;
  double largest = 0;  ///< p, over nodes and what is given on the boundary
  mechanics::liquid::Point largest_at{};
  double cavity_measure = 0;  ///< the sum of the cells whose node is held at p = 0 where h < 0
  std::optional<std::pair<mechanics::liquid::Point, mechanics::liquid::Point>> cavity_extent;  ///< of them
  double error_bound = 0;                 ///< an estimate from grids, as the embedded solver makes it
  std::vector<std::string> parted_walls;  ///< walls of which any piece parts
  double volume = 0;                      ///< of the domain, to second order in the step
  double bytes_of_a_rank = 0;
};

/// Files to write: the nodes with p as a table, by the first process; a structured grid for ParaView, by all.
struct DistributedFiles {
  std::string table, vtk;
};

/// The least p >= 0 with -Δp >= h on about so many cells along the longest side: the same rows as the
/// embedded solver's (Gibou, Fedkiw, Cheng and Kang 2002; Purvis and Burkhalter 1979), each process making
/// those of its own nodes; solved by the active sets of `vinewtonrsls` (Benson and Munson 2006), each reduced
/// equation by conjugate gradients with geometric multigrid, Galerkin's operators on the coarse grids, and
/// begun from the grid before. PETSc is initialised. Throws InvalidInput, maybe on one process alone, also
/// for a scene without a free part.
DistributedPressure solve_distributed(const mechanics::liquid::LiquidScene&, long cells,
                                      const DistributedFiles&);

}  // namespace cli::petsc
