#include "cli/measurement/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>

#include "cli/measurement/progress.hpp"

namespace cli::inline measurement {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds between two looks at whether Ctrl-C was pressed.
constexpr long glance = 100;

/// More memory than any method should need on what is charted.
constexpr rlim_t most_memory = rlim_t{8} << 30;

[[noreturn]] void work_and_leave(int into, const std::function<std::vector<double>()>& work) {
  const rlimit memory{most_memory, most_memory}, no_core{0, 0};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CORE, &no_core);
  std::signal(SIGINT, SIG_IGN);  // the parent ends the child when it is told to stop
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  int code = 1;
  try {
    const std::vector<double> numbers = work();
    const auto* bytes = reinterpret_cast<const char*>(numbers.data());
    std::size_t left = numbers.size() * sizeof(double);
    while (left > 0) {
      const ssize_t written = write(into, bytes, left);
      if (written <= 0) break;
      bytes += written;
      left -= static_cast<std::size_t>(written);
    }
    code = left == 0 ? 0 : 1;
  } catch (const std::exception&) {
    code = 1;
  }
  _exit(code);
}

}  // namespace

ChildOutcome in_child(double seconds, const std::function<std::vector<double>()>& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {};
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return {};
  }
  if (child == 0) {
    close(ends[0]);
    work_and_leave(ends[1], work);
  }
  close(ends[1]);
  ChildOutcome outcome;
  std::vector<char> bytes;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  bool open = true, late = false;
  while (open && !late) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd ready{ends[0], POLLIN, 0};
    const int events = left > 0 ? poll(&ready, 1, static_cast<int>(std::min<long>(left, glance))) : 0;
    late = left <= 0 || Progress::interrupted();
    if (events <= 0 || late) continue;
    std::array<char, 4096> block{};
    const ssize_t count = read(ends[0], block.data(), block.size());
    if (count <= 0)
      open = false;
    else
      bytes.insert(bytes.end(), block.data(), block.data() + count);
  }
  close(ends[0]);
  if (late) kill(child, SIGKILL);
  int state = 0;
  waitpid(child, &state, 0);
  if (late) {
    outcome.ending = Progress::interrupted() ? Ending::interrupted : Ending::too_slow;
  } else if (WIFEXITED(state) && WEXITSTATUS(state) == 0) {
    outcome.ending = Ending::done;
    const auto* first = reinterpret_cast<const double*>(bytes.data());
    outcome.numbers.assign(first, first + bytes.size() / sizeof(double));
  }
  return outcome;
}

}  // namespace cli::inline measurement
