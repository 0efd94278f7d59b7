#include "mechanics/motion/terms.hpp"

#include <algorithm>
#include <cstring>

#include "convex/processor.hpp"
#include "mechanics/motion/eight.hpp"

namespace mechanics::inline motions {
namespace {

/// Eight terms at a time, from the first: their sums and the largest ones, by lane.
MOREAU_CLONES void find_terms(const double* c, std::size_t count, double h, double* sums, double* most) {
  const double square = h * h, cube = square * h, fourth = square * square;
  const double eighth = fourth * fourth;
  Wide power{h, square, cube, fourth, fourth * h, fourth * square, fourth * cube, eighth};
  Wide sum{}, largest{}, term;
  for (std::size_t k = 0; k < count; k += Eight::count, power *= eighth) {
    if (k + Eight::count <= count) {
      std::memcpy(&term, c + k, sizeof term);
    } else {
      Eight last;
      std::copy(c + k, c + count, last.of);
      std::memcpy(&term, last.of, sizeof term);
    }
    term = (term < 0 ? -term : term) * power;
    sum += term;
    largest = largest < term ? term : largest;
  }
  std::memcpy(sums, &sum, sizeof sum);
  std::memcpy(most, &largest, sizeof largest);
}

struct Terms {
  Eight sums, most;
  Terms(std::span<const double> c, double h) {
    if (c.size() > 1) find_terms(c.data() + 1, c.size() - 1, h, sums.of, most.of);
  }
};

}  // namespace

double sum_of_terms(std::span<const double> c, double h) {
  const Terms terms(c, h);
  double sum = 0;
  for (const double part : terms.sums.of) sum += part;
  return sum;
}

double largest_term(std::span<const double> c, double h) {
  const Terms terms(c, h);
  return *std::max_element(terms.most.of, terms.most.of + Eight::count);
}

}  // namespace mechanics::inline motions
