#include "cli/measurement/progress.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace cli::inline measurement {
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

void Progress::now(const std::string& what) {
  what_ = what;
  show();
}

void Progress::step() {
  ++done_;
  show();
}

void Progress::show() const {
  if (!shown_) return;
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  constexpr int width = 24;
  const int filled = steps_ > 0 ? width * done_ / steps_ : width;
  const std::string bar(static_cast<std::size_t>(filled), '#'),
      rest(static_cast<std::size_t>(width - filled), '.');
  const std::string left =
      done_ > 0 ? std::to_string(static_cast<long>(spent / done_ * (steps_ - done_))) + " s left" : "";
  std::fprintf(stderr, "\r\033[K[%s%s] %d/%d %s  %s", bar.c_str(), rest.c_str(), done_, steps_, left.c_str(),
               what_.c_str());
  std::fflush(stderr);
}

bool Progress::interrupted() { return stop != 0; }

}  // namespace cli::inline measurement
