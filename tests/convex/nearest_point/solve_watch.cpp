#include "convex/nearest_point/solve_watch.hpp"

#include <doctest/doctest.h>

#include <string>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

TEST_CASE("who watches a solve hears its steps rise, and the answer is the same to the byte") {
  for (const char* name : {"hexagonal-packing", "obstacle"}) {
    CAPTURE(name);
    const convex::GalleryInstance instance = convex::gallery_instance(*convex::find_family(name), 150, 0.5);
    const convex::Solution alone = convex::automatic(instance.problem);
    convex::Index last = 0, heard = 0;
    std::string method;
    {
      const convex::SolveWatch watch([&](std::string_view by, convex::Index steps) {
        CHECK(steps > 0);
        if (by == method) CHECK(steps >= last);
        method = by;
        last = steps;
        ++heard;
      });
      const convex::Solution watched = convex::automatic(instance.problem);
      CHECK(watched.q == alone.q);
      CHECK(watched.lambda == alone.lambda);
      CHECK(method == watched.method);
    }
    CHECK(heard > 1);
    const convex::Index before = heard;
    convex::automatic(instance.problem);
    CHECK(heard == before);
  }
}
