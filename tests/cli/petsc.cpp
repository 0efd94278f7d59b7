#include <sys/wait.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;

namespace {

/// A rotating liquid in a corner of walls under a free surface, with a cavity, on a domain that is no box.
constexpr const char* corner = R"toml([liquid]
coordinates = ["x", "y"]
domain = "polygon(vertices=[[0, 0], [1, 0], [1, 0.7], [0.5, 1], [0, 1]])"
density = 1
velocity = ["-w*(y - 0.4)", "w*(x - 0.5)"]
free = { roof = { where = "y + 0.6*x > 1.2999 or y > 0.9999", pressure = 0.3 } }
walls = { rest = { where = "true", acceleration = 0 } }
cells = 64
[liquid.parameters]
w = 1.5
)toml";

constexpr const char* ball = R"toml([liquid]
coordinates = ["x", "y", "z"]
domain = "ball(center=[0, 0, 0], radius=1)"
density = 1
force = ["x", "2*y", "3*z"]
free = { rim = { where = "true", pressure = "0.4 + 0.1*x" } }
cells = 16
)toml";

using PressureTable = std::map<std::vector<long>, double>;

/// p by coordinates, in millionths. Columns after p are passed over.
PressureTable pressures(const std::string& file, std::size_t dimension) {
  PressureTable table;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::vector<long> at;
    for (std::size_t i = 0; i < dimension && std::getline(cells, cell, ','); ++i)
      at.push_back(std::lround(std::stod(cell) * 1e6));
    if (std::getline(cells, cell, ',') && !cell.empty()) table[at] = std::stod(cell);
  }
  return table;
}

/// The exit code; -1 where the program was ended.
int run_petsc(int ranks, const std::string& arguments) {
  const std::string program = tests::program_file() + "_petsc";
  const int status = std::system(
      ("mpirun --oversubscribe -n " + std::to_string(ranks) + " " + program + " " + arguments).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Solved, to 1e-3 of the largest p or not.
bool is_answer(int code) { return code == 0 || code == 3; }

}  // namespace

TEST_SUITE("petsc") {
  TEST_CASE("the pressure on two processes is that on one and that of the embedded solver") {
    const Folder folder;
    for (const auto& [text, dimension] : {std::pair<std::string, std::size_t>{corner, 2}, {ball, 3}}) {
      CAPTURE(text);
      const std::string file = folder.write("liquid.toml", text);
      const std::string one = folder.path("one.csv"), two = folder.path("two.csv"),
                        own = folder.path("own.csv");
      REQUIRE(is_answer(run_petsc(1, "solve " + file + " --data " + one + " > /dev/null 2>&1")));
      const int code = run_petsc(
          2, "solve " + file + " --json --data " + two + " > " + folder.path("two.json") + " 2> /dev/null");
      const Outcome embedded = run({"solve", "--json", file, "--data", own});
      CHECK(code == embedded.code);
      const auto told = nlohmann::json::parse(std::ifstream(folder.path("two.json")));
      const auto ours = nlohmann::json::parse(embedded.out);
      CHECK(told["petsc"]["ranks"] == 2);
      CHECK(told["unknowns"] == ours["unknowns"]);
      const double largest = ours["pressure"]["max"];
      CHECK(told["pressure"]["max"].get<double>() == doctest::Approx(largest).epsilon(1e-3));
      CHECK(told["cavity"]["fraction"].get<double>() > 0);
      CHECK(told["status"] == ours["status"]);
      // The bound is that of the embedded solver but for the coarsest grids; the extent is by cells.
      const double bound = told["certificate"]["error_bound"], own_bound = ours["certificate"]["error_bound"];
      CHECK(bound >= 0.5 * own_bound);
      CHECK(bound <= 2 * own_bound);
      for (const auto& [name, ends] : ours["cavity"]["extent"].items())
        for (const std::size_t end : {0, 1})
          CHECK(std::abs(told["cavity"]["extent"][name][end].get<double>() - ends[end].get<double>()) <=
                0.15);
      CHECK(told["parted_walls"] == nlohmann::json(ours["parted_walls"]));
      const PressureTable first = pressures(one, dimension), second = pressures(two, dimension),
                          third = pressures(own, dimension);
      CHECK(first.size() > 1000);
      CHECK(first.size() == second.size());
      std::size_t shared = 0;
      for (const auto& [at, p] : first) {
        REQUIRE(second.contains(at));
        CHECK(std::abs(second.at(at) - p) <= 1e-9 * largest);
        if (const auto found = third.find(at); found != third.end()) {
          CHECK(std::abs(found->second - p) <= 1e-8 * largest);
          ++shared;
        }
      }
      CHECK(shared > 50);
    }
  }

  TEST_CASE("walls that part are named alike on one process, on two, and by the embedded solver") {
    const Folder folder;
    for (const std::string bed : {"14", "4"})
      for (const std::string domain :
           {"box(low=[0, 0], high=[1, 2])", "polygon(vertices=[[0, 0.1], [1, 0], [1, 2], [0, 2]])"}) {
        CAPTURE(domain);
        const std::string file = folder.write(
            "tank.toml",
            "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"" + domain +
                "\"\ndensity = 2\nforce = [\"0\", \"-10\"]\nfree = { top = { where = \"y >= 1.99999\", "
                "pressure = 1 } }\nwalls = { bed = { where = \"y <= 0.1\", acceleration = " +
                bed + " }, sides = { where = \"true\", acceleration = 0 } }\ncells = 32\n");
        const auto embedded = nlohmann::json::parse(run({"solve", "--json", file}).out);
        CHECK(embedded["parted_walls"].empty() == (bed == "4"));
        for (const int ranks : {1, 2}) {
          REQUIRE(is_answer(
              run_petsc(ranks, "solve " + file + " --json > " + folder.path("told.json") + " 2> /dev/null")));
          const auto told = nlohmann::json::parse(std::ifstream(folder.path("told.json")));
          CHECK(told["parted_walls"] == embedded["parted_walls"]);
        }
      }
  }

  TEST_CASE("a file without a liquid is refused on many processes with the reason") {
    const Folder folder;
    const std::string file = folder.write("p.toml", "[projection]\nA = [[1]]\nz = [1]\nU = [[1]]\ns = [0]\n"),
                      said = folder.path("said");
    CHECK(run_petsc(2, "solve " + file + " > /dev/null 2> " + said) != 0);
    std::ostringstream text;
    text << std::ifstream(said).rdbuf();
    CHECK(text.str().find("has no [liquid]") != std::string::npos);
  }

  TEST_CASE("what only the embedded solver does is refused with its name") {
    const Folder folder;
    const std::string file = folder.write("corner.toml", corner), said = folder.path("said");
    for (const std::string option : {"--onset w", "--probe=x=1", "--certify"}) {
      CHECK(run_petsc(1, "solve " + file + " " + option + " > /dev/null 2> " + said) != 0);
      std::ostringstream text;
      text << std::ifstream(said).rdbuf();
      CHECK(text.str().find("`moreau solve` takes it") != std::string::npos);
    }
  }
}
