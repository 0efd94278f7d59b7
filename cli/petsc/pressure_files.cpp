#include <cmath>
#include <fstream>

#include "cli/petsc/grid_part.hpp"
#include "convex/invalid_input.hpp"

namespace cli::petsc {

using convex::CutPoint;
using convex::Index;
using mechanics::liquid::CutCells;
using mechanics::liquid::LiquidScene;

/// The nodes that hold a pressure, in the order of the grid: the first process gathers and writes.
void write_table(const LiquidScene& scene, const GridPart& part, DM grid, Vec q, const std::string& file) {
  Vec shown, natural, all = nullptr;
  require(VecDuplicate(q, &shown));
  require(VecCopy(q, shown));
  PetscScalar* values;
  require(VecGetArray(shown, &values));
  part.for_own([&](Index k, PetscInt, PetscInt own) {
    const CutCells& cells = part.cells();
    const CutPoint kind = cells.grid.kind[index_of(k)];
    if (kind != CutPoint::bounded) values[own] = cells.given[index_of(k)];
  });
  require(VecRestoreArray(shown, &values));
  require(DMDACreateNaturalVector(grid, &natural));
  require(DMDAGlobalToNaturalBegin(grid, shown, INSERT_VALUES, natural));
  require(DMDAGlobalToNaturalEnd(grid, shown, INSERT_VALUES, natural));
  VecScatter gather;
  require(VecScatterCreateToZero(natural, &gather, &all));
  require(VecScatterBegin(gather, natural, all, INSERT_VALUES, SCATTER_FORWARD));
  require(VecScatterEnd(gather, natural, all, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt size;
  require(VecGetLocalSize(all, &size));
  bool has_failed = false;
  if (size > 0) {
    std::ofstream out(file);
    out.precision(17);
    for (const std::string& name : scene.coordinates) out << name << ',';
    out << "p\n";
    DMDALocalInfo info;
    require(DMDAGetLocalInfo(grid, &info));
    const PetscScalar* p;
    require(VecGetArrayRead(all, &p));
    const std::array<PetscInt, 3> points{info.mx, info.my, info.mz};
    for (PetscInt k = 0; k < size; ++k) {
      if (std::isnan(p[k])) continue;
      PetscInt rest = k;
      for (std::size_t i = 0; i < scene.dimension(); ++i) {
        out << part.cells().low[i] + part.cells().step[i] * static_cast<double>(rest % points[i]) << ',';
        rest /= points[i];
      }
      out << p[k] << '\n';
    }
    require(VecRestoreArrayRead(all, &p));
    has_failed = !out.flush();
  }
  require(VecScatterDestroy(&gather));
  for (Vec* one : {&all, &natural, &shown}) require(VecDestroy(one));
  if (sum_of_all(has_failed ? 1 : 0) > 0)
    throw convex::InvalidInput("--data " + file + ": it cannot be written");
}

void write_vtk(const LiquidScene& scene, DM grid, Vec q, const std::string& file) {
  const auto& d = scene.domain;
  require(DMDASetUniformCoordinates(grid, d.low[0], d.high[0], d.low[1], d.high[1], d.low[2], d.high[2]));
  require(PetscObjectSetName(reinterpret_cast<PetscObject>(q), "p"));
  PetscViewer viewer;
  require(PetscViewerVTKOpen(PETSC_COMM_WORLD, file.c_str(), FILE_MODE_WRITE, &viewer));
  require(VecView(q, viewer));
  require(PetscViewerDestroy(&viewer));
}

}  // namespace cli::petsc
