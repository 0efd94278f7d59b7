#include <doctest/doctest.h>

#include "tests/convex/operations/samples.hpp"

using convex::Prox;
using samples::Matrix;
using samples::Metric;
using samples::Vector;

namespace {

/// A prox whose answer is known: z is the answer and a multiple of a subgradient there.
struct Known {
  const char* f;
  Vector z, x;
  Matrix W;
};

Known in_place(const char* f, const Vector& z) { return {f, z, z, Matrix::Identity(z.size(), z.size())}; }

/// The solution is on the graph of an infimum, which holds a height with the multiplier 0, or at the origin
/// of its perspective: what the infimum is taken over is held by nothing else.
std::vector<Known> cases() {
  return {
      in_place("indicator(epigraph(envelope(logistic(),0.5)))",
               Vector{{-1.9403985389889413, 0.13048034519762525}}),
      in_place("indicator(epigraph(envelope(conjugate(log_barrier(-4.625)),4.75)))", Vector{{3.75, 6}}),
      {"conjugate(indicator(epigraph(envelope(simplex(2),1))))", Vector{{2.5, 1.5, 1}}, Vector::Zero(3),
       Matrix::Identity(3, 3)},
      {"perspective(sum(envelope(squared_norm2(2.125),0.5),logistic()))",
       Vector{{1.6012544566941602, 0.21674504929256957}}, Vector::Zero(2), Matrix::Identity(2, 2)},
      {"dilate(indicator(epigraph(inf_convolution(logistic(),tilt(entropy(),[-0.02931223075135632])))),-3)",
       Vector{{-13.500000000000064, -10.501314562563808}}, Vector{{-13.5, -10.501314562563792}},
       Matrix{{1.75, -2.5}, {-2.5, 5.5}}},
  };
}

}  // namespace

TEST_CASE("a prox is as near as its bound says where a multiplier vanishes that alone holds an infimum") {
  for (const auto& [text, z, x, gram] : cases()) {
    CAPTURE(std::string(text));
    const Metric W = Metric::dense(gram);
    const Prox found = samples::function(text, W).prox(z, W);
    CHECK(found.error_bound <= 1e-8);
    CHECK(W.norm(found.x - x) <= found.error_bound + 1e-14 * (W.norm(z) + 1));
  }
}
