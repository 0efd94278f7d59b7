#include "cli/petsc/distributed_liquid.hpp"

#include <petscsnes.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "cli/petsc/grid_part.hpp"
#include "convex/invalid_input.hpp"
#include "mechanics/liquid/grid_error.hpp"
#include "mechanics/liquid/hidden_flux.hpp"
#include "mechanics/liquid/hidden_pressure.hpp"
#include "mechanics/liquid/largest_pressure.hpp"

namespace cli::petsc {
namespace {

using convex::CutPoint;
using convex::Index;
using mechanics::liquid::CutCells;
using mechanics::liquid::GridNesting;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::Point;

/// The part on the grid in work; kept while the iteration stays on that grid.
struct PartInWork {
  const LiquidScene* scene;
  std::unique_ptr<GridPart> part;

  const GridPart& on(DM grid) {
    DMDALocalInfo info;
    require(DMDAGetLocalInfo(grid, &info));
    if (!part || part->points() != info.mx * info.my * info.mz)
      part = std::make_unique<GridPart>(*scene, grid);
    return *part;
  }
};

PetscErrorCode residual(SNES snes, Vec q, Vec f, void* context) {
  DM grid;
  require(SNESGetDM(snes, &grid));
  const GridPart& part = static_cast<PartInWork*>(context)->on(grid);
  const Ghosted ghosted(grid, q);
  PetscScalar* out;
  require(VecGetArray(f, &out));
  part.for_own([&](Index k, PetscInt there, PetscInt own) {
    out[own] = part.row(k, there, ghosted.values()).residual;
  });
  require(VecRestoreArray(f, &out));
  return 0;
}

PetscErrorCode derivative(SNES snes, Vec q, Mat whole, Mat made, void* context) {
  DM grid;
  require(SNESGetDM(snes, &grid));
  const GridPart& part = static_cast<PartInWork*>(context)->on(grid);
  const Ghosted ghosted(grid, q);
  require(MatZeroEntries(made));
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    const GridPart::Row row = part.row(k, there, ghosted.values());
    require(
        MatSetValuesLocal(made, 1, &there, row.count, row.column.data(), row.entry.data(), INSERT_VALUES));
  });
  for (Mat one : {made, whole}) {
    require(MatAssemblyBegin(one, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(one, MAT_FINAL_ASSEMBLY));
  }
  return 0;
}

PetscErrorCode bounds(SNES snes, Vec low, Vec high) {
  DM grid;
  void* context;
  require(SNESGetDM(snes, &grid));
  require(SNESGetApplicationContext(snes, &context));
  const GridPart& part = static_cast<PartInWork*>(context)->on(grid);
  require(VecSet(high, PETSC_INFINITY));
  PetscScalar* out;
  require(VecGetArray(low, &out));
  part.for_own([&](Index k, PetscInt, PetscInt own) {
    out[own] = part.cells().grid.kind[index_of(k)] == CutPoint::bounded ? 0 : PETSC_NINFINITY;
  });
  require(VecRestoreArray(low, &out));
  return 0;
}

DM coarsest_grid(std::size_t dimension, const std::array<Index, 3>& cells) {
  DM grid;
  const auto points = [&](std::size_t i) { return static_cast<PetscInt>(cells[i]) + 1; };
  constexpr auto none = DM_BOUNDARY_NONE;
  constexpr auto star = DMDA_STENCIL_STAR;
  const PetscInt any = PETSC_DECIDE;
  if (dimension == 1)
    require(DMDACreate1d(PETSC_COMM_WORLD, none, points(0), 1, 1, nullptr, &grid));
  else if (dimension == 2)
    require(DMDACreate2d(PETSC_COMM_WORLD, none, none, star, points(0), points(1), any, any, 1, 1, nullptr,
                         nullptr, &grid));
  else
    require(DMDACreate3d(PETSC_COMM_WORLD, none, none, none, star, points(0), points(1), points(2), any, any,
                         any, 1, 1, nullptr, nullptr, nullptr, &grid));
  require(DMSetFromOptions(grid));
  require(DMSetUp(grid));
  return grid;
}

struct Best {
  double value;
  int rank;
};

/// The walls that push less than they would have to be followed. Each piece is judged by the process that has
/// the node that it hangs on: all see the pieces in a margin around their own nodes.
std::vector<std::string> parted_walls_of_all(const LiquidScene& scene, const GridPart& part,
                                             const Ghosted& q) {
  const CutCells& cells = part.cells();
  constexpr double elsewhere = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> p(index_of(cells.grid.size()), elsewhere), push = p;
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    if (!cells.grid.is_unknown(k)) return;
    p[index_of(k)] = q.values()[there];
    push[index_of(k)] = part.row(k, there, q.values()).residual;
  });
  double scale = 0;
  for (const auto& wall : cells.walls) scale = std::max(scale, std::abs(wall.load));
  MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  constexpr double digits = 1e-6;  // as the embedded solver has it
  std::vector<int> parts(scene.parts.size(), 0);
  for (const auto& wall : cells.walls) {
    if (!(wall.load < -digits * scale) || !scene.wall_leaves(scene.parts[wall.part], wall.at)) continue;
    double lacking = elsewhere;
    if (wall.pendant >= 0) {
      const convex::Pendant& pendant = cells.grid.pendants[index_of(wall.pendant)];
      lacking = -(p[index_of(pendant.point)] + pendant.shift) * pendant.conductance;
    } else if (const std::size_t k = index_of(wall.point);
               cells.grid.kind[k] == CutPoint::bounded && p[k] <= 0) {
      lacking = push[k] - std::max(0.0, -cells.h[k] * cells.volume[k]);
    }
    if (lacking > digits * scale) parts[wall.part] = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, parts.data(), static_cast<int>(parts.size()), MPI_INT, MPI_MAX,
                PETSC_COMM_WORLD);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (parts[k] != 0) names.push_back(scene.parts[k].name);
  return names;
}

double largest_of_all(double own) {
  MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return own;
}

/// The largest difference of p on two grids at the unknowns of the coarser one that are not below 0.
double difference_of_grids(const LiquidScene& scene, DM coarse, Vec q, DM fine, Vec p) {
  Mat injection;
  Vec there;
  require(DMCreateInjection(coarse, fine, &injection));
  require(VecDuplicate(q, &there));
  require(MatRestrict(injection, p, there));
  const PetscScalar *a, *b;
  require(VecGetArrayRead(q, &a));
  require(VecGetArrayRead(there, &b));
  const GridPart part(scene, coarse);
  double largest = 0;
  part.for_own([&](Index k, PetscInt, PetscInt own) {
    if (part.cells().grid.kind[index_of(k)] == CutPoint::bounded)
      largest = std::max(largest, std::abs(a[own] - b[own]));
  });
  require(VecRestoreArrayRead(q, &a));
  require(VecRestoreArrayRead(there, &b));
  require(VecDestroy(&there));
  require(MatDestroy(&injection));
  return largest_of_all(largest);
}

bool is_in_cavity(const CutCells& cells, Index k, double p, double largest) {
  constexpr double zero_part = 1e-10;  // of the largest p: what Newton's steps leave where it is 0
  return cells.grid.kind[index_of(k)] == CutPoint::bounded && cells.h[index_of(k)] < 0 &&
         p <= zero_part * largest;
}

void bound_error(const LiquidScene& scene, const GridPart& part, DM grid, Vec q,
                 const std::vector<double>& differences, DistributedPressure& made) {
  const Ghosted ghosted(grid, q);
  const CutCells& cells = part.cells();
  std::vector<double> p(index_of(cells.grid.size()), std::numeric_limits<double>::quiet_NaN());
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    p[index_of(k)] = cells.grid.is_unknown(k) ? ghosted.values()[there] : cells.given[index_of(k)];
    if (is_in_cavity(cells, k, p[index_of(k)], made.largest)) p[index_of(k)] = 0;
  });
  constexpr double digits = 1e-9;
  const auto across = static_cast<long>(made.cells);
  mechanics::liquid::Bends bends =
      mechanics::liquid::largest_bends(scene, cells, across, [&](Index k) { return p[index_of(k)]; });
  bends = {largest_of_all(bends.singular), largest_of_all(bends.beside), largest_of_all(bends.edge)};
  made.error_bound = mechanics::liquid::error_by(
                         mechanics::liquid::error_by_differences(scene, differences, across), bends) +
                     largest_of_all(cells.hidden + hidden_pressure(scene, cells, made.largest) +
                                    hidden_flux(scene, cells, made.largest)) +
                     digits * made.largest;
}

void summarise(const LiquidScene& scene, const GridPart& part, DM grid, Vec q, DistributedPressure& made) {
  const Ghosted ghosted(grid, q);
  const CutCells& cells = part.cells();
  const double whole_cell = cells.face_area(3);
  double unknowns = 0, cavity = 0, volume = 0;
  std::vector<double> p(index_of(cells.grid.size()), std::numeric_limits<double>::quiet_NaN());
  Best best{-1, 0};
  Point at{}, low{}, high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-low[0]);
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    volume += whole_cell * mechanics::liquid::part_in_domain(scene.domain, cells.at(k), cells.step);
    const bool is_unknown = cells.grid.is_unknown(k);
    p[index_of(k)] = is_unknown ? ghosted.values()[there] : cells.given[index_of(k)];
    unknowns += is_unknown ? 1 : 0;
  });
  const mechanics::liquid::LargestPressure largest =
      mechanics::liquid::largest_pressure(scene, cells, [&](Index k) { return p[index_of(k)]; });
  best.value = largest.p;
  at = largest.at;
  int rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  best.rank = rank;
  Best first{};
  MPI_Allreduce(&best, &first, 1, MPI_DOUBLE_INT, MPI_MAXLOC, PETSC_COMM_WORLD);
  MPI_Bcast(at.data(), static_cast<int>(at.size()), MPI_DOUBLE, first.rank, PETSC_COMM_WORLD);
  made.largest = first.value;
  made.largest_at = at;
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    if (!is_in_cavity(cells, k, ghosted.values()[there], made.largest)) return;
    cavity += cells.volume[index_of(k)];
    for (std::size_t i = 0; i < scene.dimension(); ++i) {
      low[i] = std::min(low[i], cells.at(k)[i] - 0.5 * cells.step[i]);
      high[i] = std::max(high[i], cells.at(k)[i] + 0.5 * cells.step[i]);
    }
  });
  made.unknowns = static_cast<Index>(sum_of_all(unknowns));
  made.cavity_measure = sum_of_all(cavity);
  made.volume = sum_of_all(volume);
  for (std::size_t i = 0; i < scene.dimension(); ++i) {
    low[i] = -largest_of_all(-low[i]);
    high[i] = largest_of_all(high[i]);
  }
  if (made.cavity_measure > 0) made.cavity_extent.emplace(low, high);
  made.parted_walls = parted_walls_of_all(scene, part, ghosted);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  double most = 1024 * static_cast<double>(used.ru_maxrss);
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  made.bytes_of_a_rank = most;
}

}  // namespace

DistributedPressure solve_distributed(const LiquidScene& scene, long cells, const DistributedFiles& files) {
  if (!scene.has_free_part())
    throw convex::InvalidInput(
        "free: none; moreau_petsc solves scenes with a free part, `moreau solve` those without");
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  // Each process has a few points of the coarsest grid.
  GridNesting nesting = mechanics::liquid::nest_grids(scene, cells);
  const auto points = [&](long times) {
    double product = 1;
    for (std::size_t i = 0; i < scene.dimension(); ++i)
      product *= static_cast<double>(nesting.cells(times)[i]) + 1;
    return product;
  };
  constexpr double least_points = 8;
  long from = 0;
  while (from < nesting.doublings && points(from) < least_points * ranks) ++from;
  if (points(nesting.doublings) > std::numeric_limits<PetscInt>::max())
    throw convex::InvalidInput("cells: PETSc was built with 32-bit indices, which this grid exceeds");

  PartInWork context{&scene, nullptr};
  DistributedPressure made;
  std::vector<double> differences;  // finest first
  DM grid = coarsest_grid(scene.dimension(), nesting.cells(from));
  DM coarse_grid = nullptr;
  Vec q, coarse = nullptr;
  require(DMCreateGlobalVector(grid, &q));
  require(VecSet(q, 0));
  SNES snes = nullptr;
  for (long level = from;; ++level) {
    require(SNESDestroy(&snes));
    require(SNESCreate(PETSC_COMM_WORLD, &snes));
    require(SNESSetDM(snes, grid));
    require(SNESSetApplicationContext(snes, &context));
    require(SNESSetFunction(snes, nullptr, residual, &context));
    require(SNESSetJacobian(snes, nullptr, nullptr, derivative, &context));
    require(SNESVISetComputeVariableBounds(snes, bounds));
    require(SNESSetFromOptions(snes));
    require(SNESSolve(snes, nullptr, q));
    if (level > from) {
      differences.insert(differences.begin(), difference_of_grids(scene, coarse_grid, coarse, grid, q));
      require(VecDestroy(&coarse));
      require(DMDestroy(&coarse_grid));
    }
    if (level == nesting.doublings) break;
    coarse_grid = grid;
    coarse = q;
    Mat between;
    require(DMRefine(coarse_grid, PETSC_COMM_WORLD, &grid));
    require(DMCreateInterpolation(coarse_grid, grid, &between, nullptr));
    require(DMCreateGlobalVector(grid, &q));
    require(MatInterpolate(between, coarse, q));
    require(MatDestroy(&between));
  }
  SNESConvergedReason reason;
  require(SNESGetConvergedReason(snes, &reason));
  made.has_converged = reason > 0;
  made.reason = SNESConvergedReasons[reason];
  PetscInt steps;
  require(SNESGetIterationNumber(snes, &steps));
  made.newton_steps = steps;
  made.cells = 0;
  for (std::size_t i = 0; i < scene.dimension(); ++i)
    made.cells = std::max(made.cells, nesting.cells(nesting.doublings)[i]);
  const GridPart& part = context.on(grid);
  summarise(scene, part, grid, q, made);
  bound_error(scene, part, grid, q, differences, made);
  if (!files.table.empty()) write_table(scene, part, grid, q, files.table);
  if (!files.vtk.empty()) write_vtk(scene, grid, q, files.vtk);
  require(SNESDestroy(&snes));
  require(VecDestroy(&q));
  require(DMDestroy(&grid));
  return made;
}

}  // namespace cli::petsc
