#include "cli/petsc/grid_part.hpp"

#include <algorithm>
#include <stdexcept>

namespace cli::petsc {

using convex::Index;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::Window;

void require(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc reports error " + std::to_string(code));
}

/// What all processes hold together.
double sum_of_all(double own) {
  double all = 0;
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return all;
}

GridPart::GridPart(const LiquidScene& scene, DM grid) {
  require(DMDAGetLocalInfo(grid, &info_));
  const std::array<PetscInt, 3> points{info_.mx, info_.my, info_.mz}, first{info_.xs, info_.ys, info_.zs},
      count{info_.xm, info_.ym, info_.zm};
  std::array<Index, 3> cells{1, 1, 1};
  Window window;
  for (std::size_t i = 0; i < scene.dimension(); ++i) {
    cells[i] = points[i] - 1;
    const Index from = std::max<Index>(0, first[i] - Window::margin);
    window.first[i] = from;
    window.points[i] = std::min<Index>(points[i], first[i] + count[i] + Window::margin) - from;
  }
  cells_ = mechanics::liquid::cut_cells(scene, cells, window);
  pendants_.assign(index_of(cells_.grid.size()), -1);
  next_pendant_.assign(cells_.grid.pendants.size(), -1);
  for (std::size_t a = 0; a < cells_.grid.pendants.size(); ++a) {
    std::ptrdiff_t& head = pendants_[index_of(cells_.grid.pendants[a].point)];
    next_pendant_[a] = head;
    head = static_cast<std::ptrdiff_t>(a);
  }
  for (std::size_t i = 0; i < scene.dimension(); ++i)
    fixed_diagonal_ += 2 * cells_.face_area(i) / cells_.step[i];
}

GridPart::Row GridPart::row(Index k, PetscInt ghosted, const PetscScalar* q) const {
  Row row;
  const convex::CutGrid& grid = cells_.grid;
  if (!grid.is_unknown(k)) {
    row.column[0] = ghosted;
    row.entry[0] = fixed_diagonal_;
    row.count = 1;
    row.residual = fixed_diagonal_ * q[ghosted];
    return row;
  }
  const std::array<PetscInt, 3> strides{1, info_.gxm, info_.gxm * info_.gym};
  double diagonal = grid.pull[index_of(k)];
  row.residual = diagonal * q[ghosted] - grid.load[index_of(k)];
  for (std::size_t axis = 0; axis < grid.dimension; ++axis)
    for (const int by : {-1, 1}) {
      const double link = grid.link[axis][index_of(by > 0 ? k : k - grid.stride(axis))];
      if (!(link > 0)) continue;
      const PetscInt there = ghosted + by * strides[axis];
      row.column[index_of(row.count)] = there;
      row.entry[index_of(row.count++)] = -link;
      diagonal += link;
      row.residual += link * (q[ghosted] - q[there]);
    }
  for (std::ptrdiff_t a = pendants_[index_of(k)]; a >= 0; a = next_pendant_[index_of(a)]) {
    const convex::Pendant& pendant = grid.pendants[index_of(a)];
    const double lack = q[ghosted] + pendant.shift;
    if (!(lack < 0)) continue;
    row.residual += pendant.conductance * lack;
    diagonal += pendant.conductance;
  }
  row.column[index_of(row.count)] = ghosted;
  row.entry[index_of(row.count++)] = diagonal;
  return row;
}

}  // namespace cli::petsc
