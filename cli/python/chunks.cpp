#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "cli/python/batch.hpp"

namespace python {

using convex::Index;

void in_chunks(Index count, const std::function<void(Index first, Index last)>& work) {
  constexpr Index chunk = 256;
  const Index chunks = (count + chunk - 1) / chunk;
  std::atomic<Index> next = 0;
  std::mutex lock;
  Index failed_at = chunks;
  std::exception_ptr failed;
  const auto worker = [&] {
    for (Index c; (c = next++) < chunks;) try {
        work(c * chunk, std::min(count, (c + 1) * chunk));
      } catch (...) {
        const std::lock_guard guard(lock);
        if (c < failed_at) {
          failed_at = c;
          failed = std::current_exception();
        }
      }
  };
  const Index processors = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> others;
  for (Index k = 1; k < std::min(processors, chunks); ++k) others.emplace_back(worker);
  worker();
  for (std::thread& other : others) other.join();
  if (failed) std::rethrow_exception(failed);
}

}  // namespace python
