#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

extern char** environ;

namespace tests {
namespace {

constexpr std::chrono::seconds patience{60};
constexpr std::chrono::milliseconds between_looks{1};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The exit status of a child; one that hangs is ended, and fails the test.
int status_of(pid_t child) {
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - start > patience) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      FAIL_CHECK("the program hangs");
      break;
    }
    std::this_thread::sleep_for(between_looks);
  }
  constexpr int signalled = 128;
  return WIFSIGNALED(status) ? signalled + WTERMSIG(status) : WEXITSTATUS(status);
}

std::string changed(std::vector<std::string> lines, const Changes& changes) {
  std::string text;
  for (const auto& [number, line] : changes) lines.at(static_cast<std::size_t>(number - 1)) = line;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

Outcome run_on_file(std::vector<std::string> arguments, const std::string& bytes) {
  const Folder folder;
  arguments.push_back(folder.write("problem.toml", bytes));
  return run(arguments);
}

/// Runs the first word with the others as its arguments.
Outcome start(std::vector<std::string> words, const std::string& input) {
  const Folder folder;
  const std::string in = folder.write("in", input), out = folder.path("out"), err = folder.path("err");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int write_new = O_WRONLY | O_CREAT | O_TRUNC, for_its_owner = 0600;
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), write_new, for_its_owner);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), write_new, for_its_owner);
  pid_t child = 0;
  const int failure = posix_spawn(&child, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  REQUIRE_MESSAGE(failure == 0, "cannot start ", argv[0]);
  const int code = status_of(child);
  return {code, bytes_of(out), bytes_of(err)};
}

}  // namespace

Outcome run(const std::vector<std::string>& arguments, const std::string& input) {
  std::vector<std::string> words{program_file()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return start(words, input);
}

Outcome run_by_shell(const std::string& command, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"/bin/sh", "-c", command, program_file()});
  return start(arguments, "");
}

Outcome run_within(int megabytes, std::vector<std::string> arguments) {
#ifdef __SANITIZE_ADDRESS__
  static_cast<void>(megabytes);  // the sanitizer's own map of the memory has terabytes of addresses
  return run(arguments);
#endif
  return run_by_shell("ulimit -v " + std::to_string(megabytes * 1024) + " && exec \"$0\" \"$@\"",
                      std::move(arguments));
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "moreau-XXXXXX").string();
  REQUIRE(mkdtemp(name.data()) != nullptr);
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path_ / name, std::ios::binary) << bytes;
  return path(name);
}

Outcome run_on(const std::string& command, const std::string& bytes) { return run_on_file({command}, bytes); }

Outcome run_json_on(const std::string& command, const std::string& bytes) {
  return run_on_file({command, "--json"}, bytes);
}

std::string point_on_floor(const Changes& changes) {
  return changed({"[system]", R"(coordinates = ["x", "y"])", R"T(kinetic = "m/2*(x'^2 + y'^2)")T",
                  R"(potential = "m*g*y")", "[system.parameters]", "m = 2.0", "g = 9.81",
                  "[system.constraints]", R"(floor = "y >= 0")", "[state]", "position = { x = 0.0, y = 0.0 }",
                  "velocity = { x = 0.0 }", "[solve]", ""},
                 changes);
}

std::string pushing_at_dead_centre(const Changes& changes) {
  return changed(
      {"[system]", R"(coordinates = ["a", "b", "c"])", R"T(kinetic = "(a'^2 + b'^2 + c'^2)/4")T", "[state]",
       "position = { a = 0, b = 0, c = 0 }", "[system.forces]", "a = 1.2", "[system.constraints]",
       R"T(coupler = "(2 + cos(b) - cos(a))^2 + (sin(b) - sin(a))^2 = 4")T", R"(push = "c >= b")",
       "[state.velocity]", "a = 2", "b = 2", "c = 2", ""},
      changes);
}

std::string two_rows(const Changes& changes) {
  return changed({"[projection]", "A = [[2, 0], [0, 1]]", "z = [0, -9.81]", "U = [[0, 1], [1, 1]]",
                  "s = [0, 0]", "two_sided = []", ""},
                 changes);
}

}  // namespace tests
