#include "cli/report/motion_progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace cli::inline reports {

MotionProgress::MotionProgress(double begin, double end)
    : begin_(begin),
      end_(end),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

MotionProgress::~MotionProgress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void MotionProgress::tell(const mechanics::Motion& motion) {
  using Seconds = std::chrono::duration<double>;
  constexpr Seconds silent{1}, between{0.1};
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - start_ < silent || (shown_ && now - last_ < between)) return;
  shown_ = true;
  last_ = now;
  const double part = (motion.state().t - begin_) / (end_ - begin_);
  std::fprintf(stderr,
               "\r\033[Kt = %.6g of %.6g (%.0f %%): %ld steps, %ld events, %.0f s; Ctrl-C keeps what is done",
               motion.state().t, end_, 100 * part, motion.record().steps, motion.record().events,
               Seconds(now - start_).count());
  std::fflush(stderr);
}

}  // namespace cli::inline reports
