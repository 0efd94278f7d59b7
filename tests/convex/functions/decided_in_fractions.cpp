#include <doctest/doctest.h>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/decomposition.hpp"

using namespace convex;

namespace {

Decomposition split_of(const char* text, const Vector& at, const Metric& W) {
  return decompose(make_function(cli::parse_call(text, "f"), {W}), at, W);
}

}  // namespace

TEST_CASE("a point where a piecewise quadratic function is least is its own prox, though doubles miss it") {
  // Mw + b = 0 at w = (1, 1, 0, 0) to the last bit, and norms and distances are least at 0.
  const Vector at{{1, 1, 0, 0}};
  const Metric W = Metric::dense(Matrix{{1, 2, 0, 2}, {2, 8, -4, 8}, {0, -4, 5, -2}, {2, 8, -2, 13}});
  const Decomposition found = split_of(
      "inf_convolution(precompose(elastic_net(1,1024),[[3,0,2,-3],[1,3,3,0],[1,3,-2,-1]],[-1,3,3]),"
      "envelope(indicator(orthant()),3))",
      at, W);
  CHECK(found.status == Status::solved);
  CHECK(W.norm(found.x.x - at) <= found.error_bound);
  CHECK(W.norm(found.y.x) <= found.error_bound);
  CHECK(found.error_bound <= 1e-9);
}

TEST_CASE(
    "where values of programs differ by more than rounding, fractions decide the split and its values") {
  const Metric W = Metric::identity(2);
  for (const auto& [text, at] :
       {std::pair{"sum(precompose(inf_convolution(elastic_net(0.25,1024),elastic_net(0.25,1)),"
                  "[[-1,2],[0,-3],[3,-1]],[3,-1,-1]),sum_largest(1))",
                  Vector{{-3.5622280136082622, -7.065628360207265}}},
        std::pair{"conjugate(tilt(max_affine([[2,2],[-3,0],[-3,-2]],[3,-3,-3]),[3,1]))",
                  Vector{{4.9999999999999996e-06, -1}}}}) {
    CAPTURE(std::string(text));
    const Decomposition found = split_of(text, at, W);
    CHECK(found.status == Status::solved);
    // Fenchel's equality at the points that are told, in their own doubles.
    const double size = std::abs(found.f_x) + std::abs(found.g_y) + std::abs(found.inner);
    CHECK(std::abs(found.f_x + found.g_y - found.x.x.dot(found.y.x)) <= 1e-15 * size);
    CHECK((at - found.x.x - found.y.x).norm() <= 1e-15 * at.norm());
  }
}

TEST_CASE("where a quadratic is singular but for rounding, its conjugate off the range is left open") {
  // Doubles next to singular matrices, which [[0.1, 0.3], [0.3, 0.9]] is as it is written.
  for (const char* Q : {"[[1,1],[1,1.0000000000000002220446049250313]]", "[[0.1,0.3],[0.3,0.9]]"}) {
    CAPTURE(std::string(Q));
    const Function g =
        make_function(cli::parse_call("quadratic(" + std::string(Q) + ")", "f"), {Metric::identity(2)})
            .conjugate();
    CHECK(std::isinf(g.evaluate(Vector{{0, 1}}).error));
    const Vector on_range = Q[3] == ',' ? Vector{{1, 1}} : Vector{{1, 3}};
    const Value found = g.evaluate(on_range);
    const double half_square = Q[3] == ',' ? 0.5 : 5;
    CHECK(std::abs(found.value - half_square) <= found.error);
    CHECK(found.error <= 1e-9);
  }
  const Function flat =
      make_function(cli::parse_call("quadratic([[1,1],[1,1]])", "f"), {Metric::identity(2)}).conjugate();
  const Value off = flat.evaluate(Vector{{0, 1}});
  CHECK(std::isinf(off.value));
  CHECK(off.error == 0);
}
