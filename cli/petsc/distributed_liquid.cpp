#include "cli/petsc/distributed_liquid.hpp"

#include <petscdmda.h>
#include <petscsnes.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "convex/invalid_input.hpp"
#include "mechanics/liquid/grid_scene.hpp"

namespace cli::petsc {
namespace {

using convex::CutPoint;
using convex::Index;
using mechanics::liquid::CutCells;
using mechanics::liquid::GridNesting;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::Point;
using mechanics::liquid::Window;

/// PETSc has told its error by then.
void require(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc reports error " + std::to_string(code));
}

std::size_t index_of(Index k) { return static_cast<std::size_t>(k); }

/// The nodes of this process on one grid: their rows, and where they stand in PETSc's vectors.
class Part {
 public:
  Part(const LiquidScene& scene, DM grid) {
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

  /// Calls work(node of the window, place in a vector with ghosts, place in one without).
  template <class Work>
  void for_own(Work work) const {
    for (PetscInt c = info_.zs; c < info_.zs + info_.zm; ++c)
      for (PetscInt b = info_.ys; b < info_.ys + info_.ym; ++b)
        for (PetscInt a = info_.xs; a < info_.xs + info_.xm; ++a) {
          const Index k = cells_.grid.at(a - cells_.first[0], b - cells_.first[1], c - cells_.first[2]);
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
  Row row(Index k, PetscInt ghosted, const PetscScalar* q) const {
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

  const CutCells& cells() const { return cells_; }
  PetscInt points() const { return info_.mx * info_.my * info_.mz; }

 private:
  DMDALocalInfo info_{};
  CutCells cells_;
  std::vector<std::ptrdiff_t> pendants_, next_pendant_;
  double fixed_diagonal_ = 0;
};

/// The part on the grid in work; kept while the iteration stays on that grid.
struct PartInWork {
  const LiquidScene* scene;
  std::unique_ptr<Part> part;

  const Part& on(DM grid) {
    DMDALocalInfo info;
    require(DMDAGetLocalInfo(grid, &info));
    if (!part || part->points() != info.mx * info.my * info.mz) part = std::make_unique<Part>(*scene, grid);
    return *part;
  }
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

PetscErrorCode residual(SNES snes, Vec q, Vec f, void* context) {
  DM grid;
  require(SNESGetDM(snes, &grid));
  const Part& part = static_cast<PartInWork*>(context)->on(grid);
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
  const Part& part = static_cast<PartInWork*>(context)->on(grid);
  const Ghosted ghosted(grid, q);
  require(MatZeroEntries(made));
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    const Part::Row row = part.row(k, there, ghosted.values());
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
  const Part& part = static_cast<PartInWork*>(context)->on(grid);
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

/// What all processes hold together.
double sum_of_all(double own) {
  double all = 0;
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return all;
}

struct Best {
  double value;
  int rank;
};

void summarise(const LiquidScene& scene, const Part& part, DM grid, Vec q, DistributedPressure& made) {
  const Ghosted ghosted(grid, q);
  const CutCells& cells = part.cells();
  const double whole_cell = cells.face_area(3);
  double unknowns = 0, cavity = 0, volume = 0;
  Best best{-1, 0};
  Point at{};
  part.for_own([&](Index k, PetscInt there, PetscInt) {
    volume += whole_cell * mechanics::liquid::part_in_domain(scene.domain, cells.at(k), cells.step);
    const double p = ghosted.values()[there];
    if (!cells.grid.is_unknown(k)) {
      if (cells.given[index_of(k)] > best.value) {
        best.value = cells.given[index_of(k)];
        at = cells.at(k);
      }
      return;
    }
    ++unknowns;
    const bool is_bounded = cells.grid.kind[index_of(k)] == CutPoint::bounded;
    if (is_bounded && p <= 0 && cells.h[index_of(k)] < 0) cavity += cells.volume[index_of(k)];
    if (is_bounded && p > best.value) {
      best.value = p;
      at = cells.at(k);
    }
  });
  for (const auto& given : cells.pressures)
    if (given.pressure > best.value) {
      best.value = given.pressure;
      at = given.at;
    }
  int rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  best.rank = rank;
  Best first{};
  MPI_Allreduce(&best, &first, 1, MPI_DOUBLE_INT, MPI_MAXLOC, PETSC_COMM_WORLD);
  MPI_Bcast(at.data(), static_cast<int>(at.size()), MPI_DOUBLE, first.rank, PETSC_COMM_WORLD);
  made.largest = first.value;
  made.largest_at = at;
  made.unknowns = static_cast<Index>(sum_of_all(unknowns));
  made.cavity_measure = sum_of_all(cavity);
  made.volume = sum_of_all(volume);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  double most = 1024 * static_cast<double>(used.ru_maxrss);
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  made.bytes_of_a_rank = most;
}

/// The nodes that hold a pressure, in the order of the grid: the first process gathers and writes.
void write_table(const LiquidScene& scene, const Part& part, DM grid, Vec q, const std::string& file) {
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
  DM grid = coarsest_grid(scene.dimension(), nesting.cells(from));
  SNES snes;
  require(SNESCreate(PETSC_COMM_WORLD, &snes));
  require(SNESSetDM(snes, grid));
  require(SNESSetApplicationContext(snes, &context));
  require(SNESSetFunction(snes, nullptr, residual, &context));
  require(SNESSetJacobian(snes, nullptr, nullptr, derivative, &context));
  require(SNESVISetComputeVariableBounds(snes, bounds));
  require(SNESSetGridSequence(snes, static_cast<PetscInt>(nesting.doublings - from)));
  require(SNESSetFromOptions(snes));
  require(SNESSolve(snes, nullptr, nullptr));

  DistributedPressure made;
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
  Vec q;
  DM finest;
  require(SNESGetSolution(snes, &q));
  require(SNESGetDM(snes, &finest));
  const Part& part = context.on(finest);
  summarise(scene, part, finest, q, made);
  if (!files.table.empty()) write_table(scene, part, finest, q, files.table);
  if (!files.vtk.empty()) write_vtk(scene, finest, q, files.vtk);
  require(SNESDestroy(&snes));
  require(DMDestroy(&grid));
  return made;
}

}  // namespace cli::petsc
