#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "cli/drawing/gnuplot.hpp"
#include "cli/measurement/peers.hpp"
#include "convex/nearest_point/methods.hpp"
#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::string bytes_of(const std::string& file) {
  std::stringstream bytes;
  bytes << std::ifstream(file).rdbuf();
  return bytes.str();
}

std::vector<std::vector<std::string>> table_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

/// PATH with one folder, and as it was afterwards.
class Path {
 public:
  explicit Path(const std::string& folder) { setenv("PATH", folder.c_str(), 1); }
  ~Path() { setenv("PATH", before_.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string before_ = std::getenv("PATH");
};

const char* const slope = R"([projection]
A = [[2, 1], [1, 3]]
z = [0, "-10/3"]
U = [[0, 1], [1, 1]]
s = [0, 0]
)";

}  // namespace

TEST_CASE("a chart of a file has every method, with the columns that were promised") {
  const Folder folder;
  const std::string data = folder.path("chart.csv");
  const Outcome outcome = run({"chart", folder.write("slope.toml", slope), "--data", data});
  CHECK(outcome.code == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows[0] ==
        std::vector<std::string>{"problem", "n", "m", "method", "setting", "seconds", "error", "status"});
  std::set<std::string> methods;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    REQUIRE(rows[k].size() == 8);
    methods.insert(rows[k][3]);
    CHECK(rows[k][1] == "2");
    if (rows[k][3] == "active-set") {
      CHECK(rows[k][7] == "ok");
      CHECK(std::stod(rows[k][6]) < 1e-15);
      CHECK(std::stod(rows[k][5]) > 0);
    }
  }
  CHECK(methods.size() == convex::methods().size() + 1);  // and the certified default
  const Json about = Json::parse(bytes_of(folder.path("chart.about.json")));
  CHECK(about["rows"].size() == rows.size() - 1);
  CHECK(outcome.out.find("active-set") != std::string::npos);
}

TEST_CASE(
    "the failure map has a row for every method and difficulty, and Delassus' rule is not called right") {
  const Folder folder;
  const std::string data = folder.path("stress.csv");
  CHECK(run({"stress", "near-parallel", "--data", data, "--quiet"}).code == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows[0] ==
        std::vector<std::string>{"family", "difficulty", "n", "m", "method", "seconds", "error", "status"});
  CHECK(rows.size() == 1 + (convex::methods().size() + 1) * 9);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    CHECK(rows[k][7] != "wrong");
    if (rows[k][4] == "active-set" || rows[k][4] == "auto") CHECK(rows[k][7] == "ok");
  }
}

TEST_CASE("the quick map has every family, and no cell of it is wrong without saying so") {
  const Folder folder;
  const std::string data = folder.path("stress.csv");
  const Outcome outcome = run({"stress", "--quick", "--data", data, "--output", folder.path("map.svg")});
  CHECK(outcome.code == 0);
  const auto rows = table_of(bytes_of(data));
  std::set<std::string> families;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    families.insert(rows[k][0]);
    CAPTURE(rows[k][0]);
    CAPTURE(rows[k][1]);
    CAPTURE(rows[k][4]);
    CHECK(rows[k][7] != "wrong");
    CHECK(rows[k][7] != "crashed");
  }
  for (const char* family : {"well-posed", "infeasible", "size", "prox-norm1", "prox-ball2", "ties-simplex",
                             "exponential-cone-boundary", "power-cone-boundary", "flat-cone-polar"})
    CHECK_MESSAGE(families.count(family) == 1, family);
  CHECK(outcome.out.find("first fails at") != std::string::npos);
}

TEST_CASE("what the default computes of the convex layer is right at every difficulty") {
  const Folder folder;
  const std::string data = folder.path("stress.csv");
  CHECK(run({"stress", "prox-norm1", "prox-simplex", "prox-ball2", "prox-second-order-cone", "ties-simplex",
             "ties-ball1", "ties-sum-largest", "flat-cone-polar", "--method", "auto", "--data", data,
             "--quiet"})
            .code == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows.size() > 50);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    CAPTURE(rows[k][0]);
    CAPTURE(rows[k][1]);
    CHECK(rows[k][7] == "ok");
    CHECK(std::strtod(rows[k][6].c_str(), nullptr) <= 1e-12);  // numbers too small for stod among them
  }
}

TEST_CASE("a quick chart without files has the gallery and the proxes, and tells how its order compares") {
  const Folder folder;
  const std::string data = folder.path("chart.csv");
  const Outcome outcome = run({"chart", "--quick", "--data", data});
  CHECK(outcome.code == 0);
  std::set<std::string> problems;
  const auto rows = table_of(bytes_of(data));
  for (std::size_t k = 1; k < rows.size(); ++k) problems.insert(rows[k][0]);
  CHECK(problems.count("small dense") == 1);
  CHECK(problems.count("redundant") == 1);
  CHECK(outcome.out.find("prox of norm1, cond(W) 1e6") != std::string::npos);
  CHECK(outcome.out.find("rank correlation") != std::string::npos);
}

TEST_CASE("Ctrl-C ends the work and keeps what is done") {
  const Folder folder;
  const std::string data = folder.path("stress.csv");
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    execl(tests::program_file().c_str(), "moreau", "stress", "--data", data.c_str(), nullptr);
    _exit(127);
  }
  REQUIRE(child > 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows.size() > 1);
  CHECK(rows[0][0] == "family");
  for (const auto& row : rows) CHECK(row.size() == 8);
}

TEST_CASE("the solvers of other packages are judged, or it is told how to get them") {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"stress", "well-posed", "--method", "active-set", "--quick", "--quiet",
                                 "--peers"},
        {"chart", "--profile", "--method", "active-set", "--quick", "--quiet", "--peers"}}) {
    const Outcome outcome = run(command);
    if (outcome.code == 2)
      CHECK(outcome.err.find("libsiconos-numerics-dev") != std::string::npos);
    else
      CHECK(outcome.code == 0);
  }
  const Outcome motions = run({"chart", "--motion", "--quick", "--peers"});
  CHECK(motions.code == 2);
  CHECK(motions.err.find("leave --motion out") != std::string::npos);
}

TEST_SUITE("siconos") {
  TEST_CASE("the solvers of Siconos are judged like ours, and are wrong where the others are not") {
    const Folder folder;
    const std::string data = folder.path("stress.csv");
    REQUIRE(run({"stress", "well-posed", "near-opposite", "--quick", "--peers", "--data", data}).code == 0);
    std::set<std::string> wrong;
    bool good = false;
    for (const auto& row : table_of(bytes_of(data))) {
      good = good || (row[4] == "siconos-lemke" && row[0] == "well-posed" && row[7] == "ok");
      if (row[7] == "wrong") wrong.insert(row[4]);
    }
    CHECK(good);
    const std::vector<std::string> peers = cli::peer_names();
    for (const std::string& method : wrong)
      CHECK(std::find(peers.begin(), peers.end(), method) != peers.end());
  }
}

TEST_CASE("pictures are drawn by gnuplot, and without it they are refused before any work") {
  const Folder folder;
  const std::string file = folder.write("slope.toml", slope);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"solve", "--quiet", "--plot"},
        {"chart", "--method", "active-set", "--output"},
        {"chart", "--method", "active-set", "--profile", "--output"}}) {
    const std::string picture = folder.path(command[0] + std::to_string(command.size()) + ".svg");
    std::vector<std::string> arguments = command;
    arguments.push_back(picture);
    arguments.push_back(file);
    {
      const Path nowhere(folder.path("nothing"));
      const Outcome refused = run(arguments);
      CHECK(refused.code == 2);
      CHECK_MESSAGE(refused.err.find("apt-get install gnuplot-nox") != std::string::npos, refused.err);
      CHECK_FALSE(std::filesystem::exists(picture));
    }
    if (!cli::has_gnuplot()) continue;
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 0);
    CHECK_MESSAGE(outcome.err.empty(), outcome.err);
    CHECK(bytes_of(picture).find("</svg>") != std::string::npos);
  }
}

TEST_CASE("what cannot be drawn or is not there is refused before any work") {
  const Folder folder;
  const std::string one = folder.write("one.toml", "[projection]\nA = [[1]]\nz = [0]\n");
  for (const auto& [arguments, words] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"solve", one, "--plot", folder.path("x.svg")},
            "a picture of the decomposition needs two; of a mechanism [draw] says what there is to draw"},
           {{"solve", one, "--plot", folder.path("x.gif")}, "named .svg, .png or .pdf"},
           {{"chart", "--output", "x.gif"}, "named .svg, .png or .pdf"},
           {{"chart", "--method", "simplex"}, "there is no such method"},
           {{"stress", "paralell"}, "did you mean"},
           {{"chart", "no-such-file.toml"}, "no-such-file.toml"}}) {
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(outcome.err.find(words) != std::string::npos, outcome.err);
  }
}

TEST_CASE("a chart of motions has both integrators, and the one that follows events keeps its tolerance") {
  const Folder folder;
  const std::string data = folder.path("motions.csv");
  const Outcome outcome = run({"chart", "--motion", "--quick", "--data", data});
  CHECK(outcome.code == 0);
  CHECK(outcome.out.find("following each event is quicker") != std::string::npos);
  const auto rows = table_of(bytes_of(data));
  std::set<std::string> methods;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    CAPTURE(rows[k][0]);
    CAPTURE(rows[k][4]);
    methods.insert(rows[k][3]);
    CHECK((rows[k][7] == "ok" || rows[k][7] == "too-slow"));
  }
  CHECK(methods == std::set<std::string>{"event-driven", "time-stepping"});
  CHECK(run({"chart", "--motion", "x.toml"}).code == 2);
}

TEST_CASE("no motion that is hard to follow is wrong without saying so") {
  const Folder folder;
  const std::string data = folder.path("stress.csv");
  CHECK(
      run({"stress", "motion-mass-ratio", "motion-grazing", "motion-near-simultaneous", "motion-accumulation",
           "motion-stiff-spring", "motion-drift", "--method", "event-driven", "--data", data, "--quiet"})
          .code == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows.size() > 30);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    CAPTURE(rows[k][0]);
    CAPTURE(rows[k][1]);
    CHECK((rows[k][7] == "ok" || rows[k][7] == "too-slow" ||
           (rows[k][0] == "motion-near-simultaneous" && rows[k][7] == "gave-up")));
  }
}

TEST_CASE("an answer that says itself how far off it is has few digits in the table, and is not ok") {
  const Folder folder;
  const std::string file = tests::source_folder() + "docs/problems/delassus_drops_too_much.toml";
  const std::string told = run({"chart", "--quick", file}).out;
  const std::size_t at = told.find("drop-negative");
  REQUIRE(at != std::string::npos);
  const std::string line = told.substr(at, told.find('\n', at) - at);
  CHECK(line.find(" ok") == std::string::npos);
}
