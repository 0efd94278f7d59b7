#include "mechanics/liquid/polygon.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using mechanics::liquid::narrow_place;
using mechanics::liquid::Vertex;

TEST_CASE("a channel, a notch, a strip and a slit are narrow places of a polygon, as wide as they are") {
  const std::vector<Vertex> channel{{-1, -0.5},     {-0.1, -0.5},    {-0.1, 0.25}, {0.1, 0.25},
                                    {0.1, -0.5},    {1, -0.5},       {1, 0.5},     {0.1, 0.5},
                                    {0.1, 0.28125}, {-0.1, 0.28125}, {-0.1, 0.5},  {-1, 0.5}};
  CHECK(!narrow_place(channel, 0.03125));
  const auto in_channel = narrow_place(channel, 0.032);
  REQUIRE(in_channel);
  CHECK(std::abs((*in_channel)[0]) <= 0.1);
  CHECK((*in_channel)[1] == doctest::Approx(0.265625));

  const std::vector<Vertex> notch{{-1, 0},     {1, 0},        {1, 1},     {0.5, 1},
                                  {0.5, 0.25}, {0.375, 0.25}, {0.375, 1}, {-1, 1}};
  CHECK(!narrow_place(notch, 0.125));
  CHECK(narrow_place(notch, 0.13));

  // A strip of width 1e-3 along (4, 3)/5.
  const std::vector<Vertex> strip{{0, 0}, {0.8, 0.6}, {0.7994, 0.6008}, {-0.0006, 0.0008}};
  CHECK(!narrow_place(strip, 0.99e-3));
  CHECK(narrow_place(strip, 1.01e-3));

  const std::vector<Vertex> slit{{-1, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0.5}, {0, 1}, {-1, 1}};
  CHECK(narrow_place(slit, 1e-300));
}

TEST_CASE("corners and many short sides are no narrow places") {
  CHECK(!narrow_place({{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}, 0.49));
  CHECK(!narrow_place({{0, 0}, {1, 0}, {1, 0.1}}, 0.01));
  std::vector<Vertex> circle;
  for (int k = 0; k < 500; ++k)
    circle.push_back({std::cos(k * std::numbers::pi / 250), std::sin(k * std::numbers::pi / 250)});
  CHECK(!narrow_place(circle, 0.7));  // the chord of an eighth is 2 sin(pi/8)
}
