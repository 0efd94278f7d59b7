#include "convex/nearest_point/solve_watch.hpp"

#include <utility>

namespace convex {
namespace {

thread_local SolveWatch* watching = nullptr;

}  // namespace

SolveWatch::SolveWatch(Listener listener)
    : listener_(std::move(listener)), before_(std::exchange(watching, this)) {}

SolveWatch::~SolveWatch() { watching = before_; }

void SolveWatch::tell(std::string_view method, Index steps) {
  if (watching != nullptr && watching->listener_) watching->listener_(method, steps);
}

}  // namespace convex
