#pragma once

#include <petscdmda.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "mechanics/liquid/cut_cells.hpp"

namespace cli::petsc {

/// Throws std::runtime_error where PETSc reports an error, which it has told by then.
void require(PetscErrorCode);

inline std::size_t index_of(convex::Index k) { return static_cast<std::size_t>(k); }

/// What all processes hold together.
double sum_of_all(double own);

/// The nodes of this process on one grid: their rows, and where they stand in PETSc's vectors.
class GridPart {
 public:
  GridPart(const mechanics::liquid::LiquidScene&, DM grid);

  /// Calls work(node of the window, place in a vector with ghosts, place in one without).
  template <class Work>
  void for_own(Work work) const {
    for (PetscInt c = info_.zs; c < info_.zs + info_.zm; ++c)
      for (PetscInt b = info_.ys; b < info_.ys + info_.ym; ++b)
        for (PetscInt a = info_.xs; a < info_.xs + info_.xm; ++a) {
          const convex::Index k =
              cells_.grid.at(a - cells_.first[0], b - cells_.first[1], c - cells_.first[2]);
          const PetscInt ghosted =
              ((c - info_.gzs) * info_.gym + (b - info_.gys)) * info_.gxm + (a - info_.gxs);
          const PetscInt own = ((c - info_.zs) * info_.ym + (b - info_.ys)) * info_.xm + (a - info_.xs);
          work(k, ghosted, own);
        }
  }

  /// The row of a node: neighbours in a vector with ghosts, their entries, its own entry last; of the
  /// derivative at q. Returns how many.
  struct Row {
    std::array<PetscInt, 7> column;
    std::array<PetscScalar, 7> entry;
    PetscInt count = 0;
    double residual = 0;
  };
  Row row(convex::Index k, PetscInt ghosted, const PetscScalar* q) const;

  const mechanics::liquid::CutCells& cells() const { return cells_; }
  PetscInt points() const { return info_.mx * info_.my * info_.mz; }

 private:
  DMDALocalInfo info_{};
  mechanics::liquid::CutCells cells_;
  std::vector<std::ptrdiff_t> pendants_, next_pendant_;
  double fixed_diagonal_ = 0;
};

/// q with ghosts, for as long as it is needed.
class Ghosted {
 public:
  Ghosted(DM grid, Vec q) : grid_(grid) {
    require(DMGetLocalVector(grid_, &local_));
    require(DMGlobalToLocal(grid_, q, INSERT_VALUES, local_));
    require(VecGetArrayRead(local_, &values_));
  }
  Ghosted(const Ghosted&) = delete;
  Ghosted& operator=(const Ghosted&) = delete;
  ~Ghosted() {
    VecRestoreArrayRead(local_, &values_);
    DMRestoreLocalVector(grid_, &local_);
  }
  const PetscScalar* values() const { return values_; }

 private:
  DM grid_;
  Vec local_ = nullptr;
  const PetscScalar* values_ = nullptr;
};

/// The nodes that hold a pressure, in the order of the grid: the first process gathers and writes. Throws
/// InvalidInput on all processes when the file cannot be written.
void write_table(const mechanics::liquid::LiquidScene&, const GridPart&, DM grid, Vec q,
                 const std::string& file);
/// A structured grid for ParaView.
void write_vtk(const mechanics::liquid::LiquidScene&, DM grid, Vec q, const std::string& file);

}  // namespace cli::petsc
