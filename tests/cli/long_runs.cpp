#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> found;
  for (std::string line; std::getline(file, line);) found.push_back(line);
  return found;
}

std::string bouncing_ball(const std::string& simulate, const std::string& position = "1") {
  return "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\npotential = "
         "\"9.81*y\"\n[system.constraints]\n"
         "floor = \"y >= 0\"\n[state]\nposition = { y = " +
         position + " }\n[simulate]\n" + simulate;
}

struct Ended {
  int code = -1;
  long kilobytes = 0;  ///< the most that it held in memory
};

/// Runs the program with its output into a file; interrupted after some time, if asked.
Ended ended(std::vector<std::string> arguments, const std::string& output, int interrupt_after = 0) {
  arguments.insert(arguments.begin(), tests::program_file());
  const pid_t child = fork();
  if (child == 0) {
    const int to = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(to, STDOUT_FILENO);
    std::vector<char*> words;
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    execv(words[0], words.data());
    _exit(127);
  }
  REQUIRE(child > 0);
  if (interrupt_after > 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(interrupt_after));
    kill(child, SIGINT);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, usage.ru_maxrss};
}

}  // namespace

TEST_CASE("Ctrl-C keeps what is done of a motion, and says where it was") {
  const Folder folder;
  // As far as the limit of steps allows: quick computers are still on the way.
  const std::string file = folder.write("ball.toml", bouncing_ball("until = 5e6\nrestitution = 1\n")),
                    events = folder.path("events.jsonl"), out = folder.path("out.json");
  const Ended found = ended({"simulate", file, "--json", "--events", events}, out, 700);
  CHECK(found.code == 3);
  const Json told = Json::parse(lines_of(out).at(0));
  CHECK(told["status"] == "stopped");
  CHECK(told["why"] == "interrupted");
  const auto kept = lines_of(events);
  CHECK(kept.size() == told["events"].get<std::size_t>());
  CHECK(Json::parse(kept.back())["t"].get<double>() <= told["t"].get<double>());
}

TEST_CASE("Ctrl-C keeps the rows of a branch of orbits that are done") {
  const Folder folder;
  const std::string
      file = folder.write(
          "o.toml",
          "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n"
          "[system.parameters]\nw = 2\n[system.forces]\nx = \"cos(w*t) - 0.2*x'\"\n[state]\nposition = { x "
          "= 0 }\n"),
      table = folder.path("b.csv"), out = folder.path("out.txt");
  const Ended found =
      ended({"orbit", file, "--period", "2*pi/w", "--over", "w=2:0.001:9", "--output", table}, out, 700);
  CHECK(found.code == 3);
  const auto rows = lines_of(table);
  CHECK(rows.at(0).rfind("w,period,", 0) == 0);
  CHECK(rows.size() > 2);
  CHECK(rows.size() < 7000);
}

TEST_CASE("a million events take no more memory than a few") {
  const Folder folder;
  const std::string file =
      folder.write("ball.toml", bouncing_ball("until = 0.1\nrestitution = 1\n", "0.001"));
  const auto most = [&](const std::string& until) {
    const Ended found = ended({"simulate", file, "--json", "--events", "/dev/null", "--output", "/dev/null",
                               "--set", "simulate.until=" + until},
                              folder.path("out.json"));
    CHECK(found.code == 0);
    return found.kilobytes;
  };
  const long few = most("0.1"), million = most("28557");
  CHECK(Json::parse(lines_of(folder.path("out.json")).at(0))["events"].get<long>() >= 1'000'000);
  CHECK(million - few < 200'000);
}
