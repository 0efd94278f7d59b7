#include "cli/measurement/progress.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace cli {
namespace {

volatile std::sig_atomic_t stop = 0;

void remember(int) { stop = 1; }

}  // namespace

Progress::Progress(int steps)
    : steps_(steps), shown_(isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()) {
  stop = 0;
  std::signal(SIGINT, remember);
}

Progress::~Progress() {
  std::signal(SIGINT, SIG_DFL);
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::step(const std::string& what) {
  ++done_;
  if (!shown_) return;
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const int width = 24, filled = steps_ > 0 ? width * done_ / steps_ : width;
  const std::string bar(static_cast<std::size_t>(filled), '#'),
      rest(static_cast<std::size_t>(width - filled), '.');
  std::fprintf(stderr, "\r\033[K[%s%s] %d/%d, %.0f s left  %s", bar.c_str(), rest.c_str(), done_, steps_,
               spent / done_ * (steps_ - done_), what.c_str());
  std::fflush(stderr);
}

bool Progress::interrupted() { return stop != 0; }

}  // namespace cli
