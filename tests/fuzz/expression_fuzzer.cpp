#include <fcntl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/fuzz/expression_checks.hpp"

/// Random expressions of the function language, split and judged:
///   expression_fuzzer [COUNT] [SEED] [FIRST]
/// A line for each that is wrong, refused or crashes, as the command that asks it again; a summary at the
/// end. Exit 1 when any is wrong or crashes, or more than one in a thousand is refused, and two.
///   expression_fuzzer 1000000 1966     by hand: hours
namespace {

using fuzz::Outcome;
using fuzz::Question;
using fuzz::Verdict;

constexpr int seconds_each = 20;  ///< of processor time, on slow processors too; more is a hang

struct Counts {
  long right = 0, wrong = 0, refused = 0, open = 0, invalid = 0, crashed = 0;
};

std::string command(const Question& q) {
  std::string line = "prox \"" + q.f + "\" --at \"" + q.z + "\"";
  return q.metric.empty() ? line : line + " --metric \"" + q.metric + "\"";
}

void start_clock() {
  itimerval limit{};
  limit.it_value.tv_sec = seconds_each;
  setitimer(ITIMER_PROF, &limit, nullptr);  // its signal ends the process
}

/// Judges questions from `first` on and writes a byte for each, and a line for those not right.
void work(std::uint64_t seed, long first, long end, int out) {
  for (long index = first; index < end; ++index) {
    start_clock();
    const Question question = fuzz::random_question(seed, static_cast<std::uint64_t>(index));
    Outcome found;
    try {
      found = fuzz::outcome(question);
    } catch (const std::exception& error) {
      found = {Verdict::wrong, std::string("exception: ") + error.what()};
    }
    if (found.verdict == Verdict::wrong || found.verdict == Verdict::refused) {
      std::printf("%s #%ld %s: %s\n", found.verdict == Verdict::wrong ? "WRONG" : "refused", index,
                  command(question).c_str(), found.why.c_str());
      std::fflush(stdout);
    }
    const char byte = static_cast<char>(found.verdict);
    if (write(out, &byte, 1) != 1) _exit(2);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 10000;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atol(argv[2]) : 1966);
  const long begin = argc > 3 ? std::atol(argv[3]) : 0;
  Counts counts;
  for (long next = begin; next < begin + count;) {
    int ends[2];
    if (pipe(ends) != 0) return 2;
    const pid_t worker = fork();
    if (worker < 0) return 2;
    if (worker == 0) {
      close(ends[0]);
      work(seed, next, begin + count, ends[1]);
      _exit(0);
    }
    close(ends[1]);
    char byte = 0;
    while (read(ends[0], &byte, 1) == 1) {
      ++next;
      switch (static_cast<Verdict>(byte)) {
        case Verdict::right:
          ++counts.right;
          break;
        case Verdict::wrong:
          ++counts.wrong;
          break;
        case Verdict::refused:
          ++counts.refused;
          break;
        case Verdict::open:
          ++counts.open;
          break;
        case Verdict::invalid:
          ++counts.invalid;
          break;
      }
    }
    close(ends[0]);
    int status = 0;
    waitpid(worker, &status, 0);
    if (next >= begin + count) break;
    const bool slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF;
    std::printf("%s #%ld %s\n", slow ? "HANG" : "CRASH", next,
                command(fuzz::random_question(seed, static_cast<std::uint64_t>(next))).c_str());
    std::fflush(stdout);
    ++counts.crashed;
    ++next;
  }
  const long valid = count - counts.invalid;
  std::printf(
      "right %ld (%ld more leave a value of the conjugate open), wrong %ld, refused %ld, crashed %ld; not "
      "functions of "
      "the language %ld\n",
      counts.right, counts.open, counts.wrong, counts.refused, counts.crashed, counts.invalid);
  return counts.wrong + counts.crashed > 0 || counts.refused > 2 + valid / 1000 ? 1 : 0;
}
