#include "cli/report/solve_progress.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>

namespace cli::inline reports {
namespace {

using Seconds = std::chrono::duration<double>;

/// Before that nothing is shown; so often the line changes.
constexpr Seconds patience{1}, period{0.1};

/// Of what a signal may call.
void end_at_once(int signal) {
  constexpr std::string_view on_terminal = "\r\033[Kmoreau: interrupted\n", told = "moreau: interrupted\n";
  const std::string_view text = isatty(STDERR_FILENO) == 1 ? on_terminal : told;
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

SolveProgress::SolveProgress()
    : terminal_(isatty(STDERR_FILENO) == 1),
      interrupted_before_(std::signal(SIGINT, end_at_once)),
      start_(std::chrono::steady_clock::now()),
      last_(start_),
      watch_([this](std::string_view method, convex::Index steps) { show(method, steps); }) {}

SolveProgress::~SolveProgress() {
  std::signal(SIGINT, interrupted_before_);
  if (shown_) std::fputs("\r\033[K", stderr);
}

void SolveProgress::show(std::string_view method, convex::Index steps) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - start_ < patience || (shown_ && now - last_ < period)) return;
  shown_ = true;
  last_ = now;
  std::fprintf(stderr, "\r\033[K%s: %ld steps, %.0f s", std::string(method).c_str(), static_cast<long>(steps),
               Seconds(now - start_).count());
  std::fflush(stderr);
}

}  // namespace cli::inline reports
