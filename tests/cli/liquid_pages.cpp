#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>
#include <tuple>

#include "cli/drawing/gnuplot.hpp"
#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using PageJson = nlohmann::json;

namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

PageJson liquid_of(const std::string& page) {
  const std::string begin = "id=\"liquid\">", end = "</script>";
  const std::size_t from = page.find(begin) + begin.size();
  return PageJson::parse(page.substr(from, page.find(end, from) - from));
}

/// Numbers of two bytes, the low one first, from RFC 4648's letters.
std::vector<int> decoded(const std::string& letters) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<int> bytes, numbers;
  unsigned word = 0, bits = 0;
  for (const char c : letters) {
    if (c == '=') break;
    word = word << 6U | static_cast<unsigned>(alphabet.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<int>(word >> bits & 255U));
  }
  for (std::size_t k = 0; k + 1 < bytes.size(); k += 2) numbers.push_back(bytes[k] + 256 * bytes[k + 1]);
  return numbers;
}

/// A square of 512 cells, solved with a table and an image; what it says goes to a file.
pid_t square_with(const std::string& said, const std::string& table, const std::string& image) {
  const pid_t child = fork();
  if (child != 0) return child;
  dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
  dup2(open(said.c_str(), O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
  const std::string square = tests::source_folder() + "docs/problems/liquid_square.toml";
  execl(tests::program_file().c_str(), "moreau", "solve", square.c_str(), "--set", "liquid.cells=512",
        "--data", table.c_str(), "--vtk", image.c_str(), nullptr);
  _exit(127);
}

/// Its signal, or -1 where it ended in another way; waited for.
int signal_that_ended(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : -1;
}

}  // namespace

TEST_CASE("Ctrl-C ends the solve of a liquid in words, before it writes a file") {
  const Folder folder;
  const std::string said = folder.path("said"), table = folder.path("p.csv");
  const pid_t child = square_with(said, table, folder.path("p.vti"));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(said) && std::chrono::steady_clock::now() < end) {
  }
  kill(child, SIGINT);
  CHECK(signal_that_ended(child) == SIGINT);
  CHECK(!std::filesystem::exists(table));
}

TEST_CASE("Ctrl-C within a table is held until all of it is written, and no other file is begun") {
  // A pipe holds a part of the table: the program is within it for as long as nobody reads.
  const Folder folder;
  const std::string said = folder.path("said"), table = folder.path("p.csv"), image = folder.path("p.vti");
  REQUIRE(mkfifo(table.c_str(), 0600) == 0);
  const int reader = open(table.c_str(), O_RDONLY | O_NONBLOCK);
  REQUIRE(reader >= 0);
  const pid_t child = square_with(said, table, image);
  pollfd begun{reader, POLLIN, 0};
  constexpr int patience = 60'000;
  REQUIRE(poll(&begun, 1, patience) == 1);
  kill(child, SIGINT);
  std::string text, block(65536, '\0');
  while (poll(&begun, 1, patience) == 1) {
    const ssize_t size = read(reader, block.data(), block.size());
    if (size <= 0) break;
    text.append(block, 0, static_cast<std::size_t>(size));
  }
  close(reader);
  CHECK(signal_that_ended(child) == SIGINT);
  CHECK(text_of(said) == "moreau: interrupted\n");
  CHECK(std::count(text.begin(), text.end(), '\n') == 1 + 513 * 513);
  CHECK(text.ends_with("\n"));
  CHECK(!std::filesystem::exists(image));
}

TEST_CASE(
    "a page plays the inception of a tube's cavity: its pressure, its cavity and its onset at each value") {
  const Folder folder;
  const std::string page_file = folder.path("tube.html");
  REQUIRE(run({"solve", tests::source_folder() + "docs/problems/liquid_tube.toml", "--animate", page_file,
               "--over", "omega=1:0.25:3"})
              .code == 0);
  const std::string page = text_of(page_file);
  CHECK(page.find("http") == std::string::npos);
  CHECK(page.find("src=") == std::string::npos);
  const PageJson data = liquid_of(page);
  REQUIRE(data["frames"].size() == 9);
  // Cavitation from omega^2 = 2 p0/(rho R^2) on, in |x| < s = R - sqrt(2 p0/rho)/omega; p = omega^2 (|x| -
  // s)^2 / 2.
  CHECK(data["onset"]["value"].get<double>() == doctest::Approx(std::sqrt(2)));
  for (const PageJson& frame : data["frames"]) {
    const double omega = frame["value"], s = 1 - std::sqrt(2) / omega;
    CAPTURE(omega);
    CHECK(frame["fraction"].get<double>() == doctest::Approx(std::max(0.0, s)));
    const std::vector<int> codes = decoded(frame["p"]);
    const int most = data["most_code"];
    REQUIRE(codes.size() == 501);
    for (std::size_t k = 0; k < codes.size(); ++k) {
      const double x = std::abs(-1 + 0.004 * static_cast<double>(k));
      const double p = s > 0 ? omega * omega / 2 * (x - s) * (x - s) : 1 - omega * omega / 2 * (1 - x * x);
      if (x < s - 0.004)
        CHECK(codes[k] == data["cavity_code"]);
      else if (x > s + 0.004)
        CHECK(std::abs(codes[k] - most * p / data["largest"].get<double>()) <= 1);
    }
  }
}

TEST_CASE(
    "a page of a plane has the levels of its boundary, the walls that part, and what fails at a value") {
  const Folder folder;
  const std::string page_file = folder.path("tank.html");
  REQUIRE(run({"solve", tests::source_folder() + "docs/problems/liquid_tank.toml", "--animate", page_file,
               "--over", "a=4,14"})
              .code == 0);
  const PageJson data = liquid_of(text_of(page_file));
  CHECK(data["frames"][0]["parted_walls"].empty());
  CHECK(data["frames"][0]["parted"].empty());
  CHECK(data["frames"][1]["parted_walls"] == PageJson::parse("[\"bed\"]"));
  REQUIRE(!data["frames"][1]["parted"].empty());
  for (const PageJson& at : data["frames"][1]["parted"]) CHECK(at[1] == 0);
  CHECK(data["frames"][1]["level"].is_null());  // the domain is the one before
  REQUIRE(run({"solve", tests::source_folder() + "docs/problems/liquid_tube.toml", "--animate", page_file,
               "--over", "p0=-1,1"})
              .code == 0);
  CHECK(liquid_of(text_of(page_file))["frames"][0]["failure"].get<std::string>().find("below 0") !=
        std::string::npos);
}

TEST_CASE("a wall that asks for nothing is not marked where walls of its name part beside it") {
  // The floor of an angle and the ceiling of its foot part; the wall x = 2 between them stands still, F along
  // it.
  const Folder folder;
  const std::string page_file = folder.path("angle.html");
  const std::string angle =
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = "
      "\"polygon(vertices=[[0,0],[2,0],[2,1],[1,1],[1,2],[0,2]])\"\ndensity = 1\nforce = [\"0\", \"-10\"]\n"
      "free = { top = { where = \"y >= 2\", pressure = 5 } }\nwalls = { floor = { where = \"y <= 0\", "
      "acceleration = \"a\" }, rest = { where = \"true\", acceleration = 0 } }\n[liquid.parameters]\na = "
      "30\n";
  run({"solve", folder.write("l.toml", angle), "--animate", page_file, "--over", "a=30,31"});
  const PageJson frame = liquid_of(text_of(page_file))["frames"][0];
  REQUIRE(frame["parted_walls"] == PageJson::parse("[\"floor\", \"rest\"]"));
  REQUIRE(frame["parted"].size() > 50);
  for (const PageJson& at : frame["parted"]) {
    const double x = at[0], y = at[1];
    CAPTURE(x);
    CAPTURE(y);
    CHECK((y == 0 || (y == 1 && x > 1)));
  }
}

TEST_CASE("what is wrong in --animate and --over of a liquid is told") {
  const Folder folder;
  const std::string tube = tests::source_folder() + "docs/problems/liquid_tube.toml",
                    page = folder.path("p.html");
  const auto refused = [&](std::vector<std::string> options, const std::string& word) {
    options.insert(options.begin(), {"solve", tube});
    const Outcome outcome = run(options);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find(word) != std::string::npos);
  };
  refused({"--animate", page}, "--over");
  refused({"--over", "omega=1:1:3"}, "--animate");
  refused({"--animate", page, "--over", "w=1:1:3"}, "\"w\"");
  refused({"--animate", page, "--over", "omega=1:1e-6:3"}, "larger step");
  refused({"--animate", folder.path("p.svg"), "--over", "omega=1:1:3"}, ".html");
  const Outcome other =
      run({"solve", folder.write("p.toml", two_rows()), "--animate", page, "--over", "omega=1:1:3"});
  CHECK(other.code == 2);
  CHECK(other.err.find("[liquid]") != std::string::npos);
}

TEST_SUITE("chromium") {
  TEST_CASE("a browser plays the page of a liquid") {
    const Folder folder;
    const std::string page_file = folder.path("p.html"), dump = folder.path("dump.html");
    for (const std::string name : {"disc", "tube"}) {
      REQUIRE(run({"solve", tests::source_folder() + "docs/problems/liquid_" + name + ".toml", "--animate",
                   page_file, "--over", "omega=1:0.5:4"})
                  .code == 0);
      const std::string command =
          "timeout 60 chromium --headless --no-sandbox --disable-gpu --dump-dom 'file://" + page_file +
          "#3' > " + dump + " 2> /dev/null";
      REQUIRE(std::system(command.c_str()) == 0);
      const std::string dom = text_of(dump);
      CHECK(dom.find("data-ready=\"yes\"") != std::string::npos);
      CHECK(dom.find("omega = 3") != std::string::npos);
      CHECK(dom.find("The cavity fills") != std::string::npos);
      CHECK(dom.find("id=\"onset\"") != std::string::npos);
    }
  }
}

TEST_CASE("the edge of a liquid's domain is drawn whole, on a page as high as the domain needs") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string picture = folder.path("p.svg");
  for (const auto& [problem, height, of_a_box] :
       {std::tuple{"liquid_disc", 630, std::numbers::pi / 4}, std::tuple{"liquid_tank", 900, 1.0}}) {
    CAPTURE(problem);
    const std::string file = tests::source_folder() + "docs/problems/" + problem + ".toml";
    REQUIRE(run({"solve", "--quiet", file, "--plot", picture}).code == 0);
    std::stringstream text;
    text << std::ifstream(picture).rdbuf();
    const std::string svg = text.str();
    CHECK(svg.find("viewBox=\"0 0 700 " + std::to_string(height)) != std::string::npos);
    CHECK(svg.find("contours every 0.") != std::string::npos);
    // The pieces in the edge's colour, and the box around them.
    double length = 0, left = 1e9, right = 0, top = 1e9, bottom = 0;
    const std::regex path("<path stroke='rgb\\( 32,  32,  32\\)' *d='([^']*)'"),
        piece("M([-0-9.]+),([-0-9.]+) L([-0-9.]+),([-0-9.]+)");
    for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it) {
      const std::string pieces = (*it)[1];
      for (std::sregex_iterator at(pieces.begin(), pieces.end(), piece); at != end; ++at) {
        std::array<double, 4> x{};
        for (std::size_t k = 0; k < 4; ++k) x[k] = std::stod((*at)[k + 1]);
        length += std::hypot(x[2] - x[0], x[3] - x[1]);
        left = std::min({left, x[0], x[2]});
        right = std::max({right, x[0], x[2]});
        top = std::min({top, x[1], x[3]});
        bottom = std::max({bottom, x[1], x[3]});
      }
    }
    CHECK(right - left >= 300);
    CHECK(std::abs(length / (2 * (right - left + bottom - top)) - of_a_box) <= 0.01);
  }
}
