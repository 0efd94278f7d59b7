// Time of the algebra of piecewise linear-quadratic functions by the number of pieces, and of their prox by
// the entry beside a plain copy of the vector; of the Legendre transform by the grid point.
//   plq_speed [--smoke]
// Pieces are random, half of the joints kinks. Prints the median processor time of repeated runs; an
// operation is linear in the pieces when ns/piece stays level down its column but for what leaves the caches.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "convex/grid/legendre_transform.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/pieces.hpp"
#include "convex/piecewise/scalar_prox.hpp"

namespace {

using convex::Index;
using convex::PiecewiseQuadratic;
using convex::Vector;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds(const std::function<void()>& work, int repetitions) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const double start = processor_seconds();
    work();
    times.push_back(processor_seconds() - start);
  }
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[static_cast<std::size_t>(repetitions / 2)];
}

convex::Pieces random_pieces(Index count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> number(0, 1);
  convex::Pieces made{Vector(count - 1), convex::Matrix(count, 3)};
  const double step = 2 / static_cast<double>(count);
  double x = -1, slope = -1, value = 1;
  for (Index i = 0; i < count; ++i) {
    const double c2 = number(generator), width = step * (0.5 + number(generator));
    made.coefficients.row(i) << c2, slope - c2 * x, value - slope * x + c2 / 2 * x * x;
    if (i + 1 == count) break;
    value += width * (slope + c2 / 2 * width);
    slope += c2 * width + (generator() % 2 ? step * number(generator) : 0);
    x += width;
    made.breaks[i] = x;
  }
  return made;
}

void algebra(const std::vector<Index>& sizes, int repetitions) {
  std::printf("%-20s", "ms (ns/piece)");
  for (Index n : sizes) std::printf("%12ld pieces  ", static_cast<long>(n));
  std::printf("\n");
  std::vector<PiecewiseQuadratic> f, g;
  std::vector<convex::Pieces> given;
  for (Index n : sizes) {
    given.push_back(random_pieces(n, 1));
    const convex::Pieces other = random_pieces(n, 2);
    f.push_back(convex::piecewise_quadratic(given.back().breaks, given.back().coefficients));
    g.push_back(convex::piecewise_quadratic(other.breaks, other.coefficients));
  }
  std::size_t corners = 0;  // keeps the work from being left out
  const auto row = [&](const char* name, const std::function<std::size_t(std::size_t)>& work) {
    std::printf("%-20s", name);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double time = seconds([&] { corners += work(i); }, repetitions);
      std::printf("%12.3f (%4.0f)  ", time * 1e3, time * 1e9 / static_cast<double>(sizes[i]));
    }
    std::printf("\n");
  };
  const auto size = [](const PiecewiseQuadratic& result) { return result.corners().size(); };
  row("from pieces", [&](std::size_t i) {
    return size(convex::piecewise_quadratic(given[i].breaks, given[i].coefficients));
  });
  row("to pieces",
      [&](std::size_t i) { return static_cast<std::size_t>(convex::pieces(f[i]).breaks.size()); });
  row("conjugate", [&](std::size_t i) { return size(convex::conjugate(f[i])); });
  row("envelope", [&](std::size_t i) { return size(convex::envelope(f[i], 0.5)); });
  row("dilate", [&](std::size_t i) { return size(convex::dilate(f[i], -0.7)); });
  row("sum", [&](std::size_t i) { return size(convex::sum(f[i], g[i])); });
  row("pointwise max", [&](std::size_t i) { return size(convex::pointwise_max(f[i], g[i])); });
  row("inf-convolution", [&](std::size_t i) { return size(convex::inf_convolution(f[i], g[i])); });
  row("proximal average",
      [&](std::size_t i) { return size(convex::proximal_average(f[i], g[i], 0.3, 0.5)); });
  if (corners == 0) std::printf("no corners\n");
}

void prox(Index n, int repetitions) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal(0, 2);
  Vector z(n), d(n), x(n);
  for (Index i = 0; i < n; ++i) z[i] = normal(generator), d[i] = 0.5 + std::abs(normal(generator));
  double kept = 0;
  const double copy = seconds(
      [&] {
        const Vector c = z;
        kept += c[n / 2];
      },
      repetitions);
  const auto per_entry = [n](double time) { return time * 1e9 / static_cast<double>(n); };
  std::printf("\nprox of %ld entries: ns/entry (times a copy, %.2f ns)\n%-20s%20s%20s\n",
              static_cast<long>(n), per_entry(copy), "", "one weight", "a weight an entry");
  const auto row = [&](const char* name, const PiecewiseQuadratic& f) {
    const double one = seconds([&] { convex::prox(f, z, 0.7, x); }, repetitions);
    const double each = seconds([&] { convex::prox(f, z, d, x); }, repetitions);
    kept += x[n / 2];
    std::printf("%-20s%12.2f (%5.2f)%12.2f (%5.2f)\n", name, per_entry(one), one / copy, per_entry(each),
                each / copy);
  };
  row("norm1", convex::piecewise::absolute());
  row("box", convex::piecewise::indicator(-1, 1));
  row("huber", convex::piecewise::huber(0.5));
  row("hinge", convex::piecewise::hinge());
  row("elastic_net", convex::piecewise::elastic_net(0.3, 2));
  for (Index count : {10, 1000}) {
    const convex::Pieces given = random_pieces(count, 4);
    row((std::to_string(count) + " pieces").c_str(),
        convex::piecewise_quadratic(given.breaks, given.coefficients));
  }
  if (kept == 0) std::printf("nothing\n");
}

void grids(const std::vector<std::vector<Index>>& shapes, int repetitions) {
  std::printf("\nLegendre transform and envelope on grids: ms (ns/point)\n");
  double kept = 0;
  for (const std::vector<Index>& shape : shapes) {
    std::vector<Vector> axes, slopes;
    std::string name;
    Index count = 1;
    for (Index n : shape) {
      axes.push_back(Vector::LinSpaced(n, -2, 2));
      slopes.push_back(Vector::LinSpaced(n, -3, 3));
      name += (name.empty() ? "" : " x ") + std::to_string(n);
      count *= n;
    }
    const convex::GridFunction f =
        convex::sample([](const Vector& x) { return std::cos(3 * x.sum()) + x.squaredNorm(); }, axes);
    const double conjugate = seconds([&] { kept += convex::conjugate(f, slopes).values[0]; }, repetitions);
    const double envelope = seconds([&] { kept += convex::envelope(f, 0.5, axes).values[0]; }, repetitions);
    const double per_point = 1e9 / static_cast<double>(count);
    std::printf("%-20s%12.3f (%4.0f)%12.3f (%4.0f)\n", name.c_str(), conjugate * 1e3, conjugate * per_point,
                envelope * 1e3, envelope * per_point);
  }
  if (kept == 0) std::printf("nothing\n");
}

}  // namespace

int main(int count, char** arguments) {
  const bool smoke = count > 1 && std::strcmp(arguments[1], "--smoke") == 0;
  algebra(smoke ? std::vector<Index>{100} : std::vector<Index>{1000, 10000, 100000, 1000000}, smoke ? 1 : 11);
  for (Index n : smoke ? std::vector<Index>{1000} : std::vector<Index>{1000, 1000000})
    prox(n, smoke ? 1 : 21);
  if (smoke)
    grids({{100}}, 1);
  else
    grids({{1000}, {10000}, {100000}, {1000000}, {100, 100}, {1000, 1000}, {20, 20, 20}, {100, 100, 100}}, 5);
  return 0;
}
