#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Numbers in the prose of a page, with who prints them. A comment after a paragraph or a table says it:
///
///     <!-- printed: moreau solve --json docs/problems/scene.toml
///     /acceleration/y = 9/5
///     /status = solved -->
///
/// a command of the shell, run in the project's folder, that prints one JSON object, and places in it (JSON
/// pointers) with what the prose says there: a word, a fraction, or a decimal, which is right to its last
/// digit.
namespace {

struct ToldNumber {
  std::string pointer, words;
};

struct ToldPassage {
  fs::path page;
  std::string prose, command;
  std::vector<ToldNumber> numbers;
};

const fs::path project = tests::source_folder();

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<ToldPassage> passages(const fs::path& page, std::istream& text) {
  const std::string opening = "<!-- printed: ", closing = "-->";
  std::vector<ToldPassage> found;
  std::string block, before;
  for (std::string line; std::getline(text, line);) {
    if (line.compare(0, opening.size(), opening) != 0) {
      if (!trimmed(line).empty()) {
        if (!before.empty() && block.empty()) before.clear();
        block += line + "\n";
      } else if (!block.empty()) {
        before = std::exchange(block, "");
      }
      continue;
    }
    ToldPassage passage{page, block.empty() ? before : block, trimmed(line.substr(opening.size())), {}};
    for (bool open = true; open && std::getline(text, line);) {
      if (const std::size_t end = line.find(closing); end != std::string::npos) {
        line.resize(end);
        open = false;
      }
      const std::size_t sign = line.find(" = ");
      if (sign != std::string::npos)
        passage.numbers.push_back({trimmed(line.substr(0, sign)), trimmed(line.substr(sign + 3))});
    }
    found.push_back(std::move(passage));
  }
  return found;
}

std::vector<ToldPassage> all_passages() {
  std::vector<ToldPassage> all;
  const auto add = [&](const fs::path& page) {
    std::ifstream stream(page);
    for (ToldPassage& passage : passages(page, stream)) all.push_back(std::move(passage));
  };
  add(project / "README.md");
  for (const auto& entry : fs::recursive_directory_iterator(project / "docs"))
    if (entry.path().extension() == ".md") add(entry.path());
  return all;
}

/// "-18.469", "5/3", "1e-17", "2"; none for a word. `unit`: that of the last digit, 0 for a fraction.
std::optional<double> number(const std::string& words, double& unit) {
  char* end = nullptr;
  const double value = std::strtod(words.c_str(), &end);
  if (end == words.c_str()) return std::nullopt;
  unit = 0;
  if (*end == '/') return value / std::strtod(end + 1, nullptr);
  if (*end != '\0') return std::nullopt;
  const std::size_t exponent = std::min(words.find_first_of("eE"), words.size());
  const std::size_t point = words.find('.');
  const double places = point < exponent ? static_cast<double>(exponent - point - 1) : 0;
  const double power = exponent < words.size() ? std::atof(words.c_str() + exponent + 1) : 0;
  unit = std::pow(10, power - places);
  return value;
}

bool says(const Json& printed, const std::string& words) {
  double unit = 0;
  const std::optional<double> told = number(words, unit);
  if (printed.is_number() && told) {
    const double is = printed.get<double>();
    return std::abs(is - *told) <= 0.5 * unit + 1e-12 * std::abs(*told) + 1e-300;
  }
  return printed.is_string() ? printed.get<std::string>() == words : printed.dump() == words;
}

Json printed_by(const Folder& folder, const std::string& command) {
  const fs::path program = tests::program_file();
  const std::string out = folder.path("printed");
  const std::string line = "cd '" + project.string() + "' && PATH='" + program.parent_path().string() +
                           ":'$PATH && { " + command + "\n} > '" + out + "' 2> /dev/null";
  (void)std::system(line.c_str());
  std::ifstream stream(out);
  return Json::parse(stream, nullptr, false);
}

}  // namespace

TEST_CASE("every number in prose that names who prints it is printed so") {
  const Folder folder;
  std::size_t numbers = 0;
  for (const ToldPassage& passage : all_passages()) {
    CAPTURE(passage.page.string());
    CAPTURE(passage.command);
    CHECK(!passage.numbers.empty());
    const Json printed = printed_by(folder, passage.command);
    REQUIRE(!printed.is_discarded());
    for (const ToldNumber& told : passage.numbers) {
      CAPTURE(told.pointer);
      CAPTURE(told.words);
      CHECK(passage.prose.find(told.words) != std::string::npos);
      const Json::json_pointer place(told.pointer);
      REQUIRE(printed.contains(place));
      CAPTURE(printed.at(place).dump());
      CHECK(says(printed.at(place), told.words));
      ++numbers;
    }
  }
  CHECK(numbers >= 20);
}

TEST_CASE("a told number is read from the paragraph before, and another last digit is seen") {
  std::istringstream page(
      "It is -1.25 here,\nor 5/3.\n<!-- printed: moreau x --json\n/a = -1.25\n/b/c = 5/3 -->\n\n| table | 2 "
      "|\n\n<!-- printed: y\n/d = 2 -->\n");
  const std::vector<ToldPassage> read = passages("page", page);
  REQUIRE(read.size() == 2);
  CHECK(read[0].command == "moreau x --json");
  CHECK(read[0].prose == "It is -1.25 here,\nor 5/3.\n");
  REQUIRE(read[0].numbers.size() == 2);
  CHECK(read[0].numbers[1].pointer == "/b/c");
  CHECK(read[1].prose == "| table | 2 |\n");
  CHECK(says(Json(-1.2473), "-1.25"));
  CHECK_FALSE(says(Json(-1.244), "-1.25"));
  CHECK(says(Json(5.0 / 3), "5/3"));
  CHECK_FALSE(says(Json(1.67), "5/3"));
  CHECK(says(Json("9/5"), "9/5"));
  CHECK_FALSE(says(Json("9/4"), "9/5"));
  CHECK(says(Json(true), "true"));
  CHECK(says(Json(1.4e-17), "1e-17"));
  CHECK_FALSE(says(Json(1.6e-17), "1e-17"));
}

TEST_CASE("a derivative that cancels to rounding is told as 0") {
  const tests::Folder folder;
  // Five legs under a table: nothing moves but what is lifted, about a side that symmetry holds.
  const std::string file = folder.write("a.toml", R"toml(
[system]
coordinates = ["z", "p", "r"]
kinetic = "z'^2/2 + p'^2/2 + r'^2/2"
potential = "9.81*z"
[system.constraints]
"leg[k in 1..5]" = "z + sin(2*pi*k/5)*r + cos(2*pi*k/5)*p >= 0"
[state]
position = { z = 0, p = 0, r = 0 }
)toml");
  const std::string text = tests::run({"solve", "--sensitivity", file}).out;
  CHECK(text.find("a unit more of the bound of leg[5]") != std::string::npos);
  CHECK(text.substr(text.find("What changes")).find("e-1") == std::string::npos);
}

TEST_CASE("what stands still at the end of a motion has the velocity and the acceleration 0 in words") {
  const tests::Folder folder;
  // A toggle pressed against its stop: a hundred newtons cancel.
  const std::string file = folder.write("a.toml", R"toml(
[system]
coordinates = ["a", "b", "x"]
kinetic = "J/2*(a'^2+b'^2) + m/2*x'^2"
parameters = { J = 0.01, m = 1, r = 0.1, l = 0.2, k = 5000, x0 = 0.28, M = -3 }
potential = "k/2*max(x - x0, 0)^2"
[system.forces]
a = "M"
[system.constraints]
horiz = "r*cos(a) + l*cos(b) = x"
vert = "r*sin(a) + l*sin(b) = 0"
stop = "a >= -0.02"
[state]
position = { a = 0.5, b = -0.2, x = 0.28 }
in_contact = []
)toml");
  const std::string text = tests::run({"simulate", file, "--until", "0.5"}).out,
                    table = text.substr(text.find("q''"), text.find("Steps:") - text.find("q''"));
  for (const char* row : {"a       -0.02    0     0", "x     0.29997    0     0"})
    CHECK(table.find(row) != std::string::npos);
}

TEST_CASE("a position that a rounding of the first one hides is told as 0, and in full under --json") {
  const tests::Folder folder;
  // A block rocks from one edge to the other, by an angle that comes to nothing.
  const std::string file = folder.write("a.toml", R"toml(
[system]
coordinates = ["y", "a"]
kinetic = "m/2*y'^2 + m*(b^2 + h^2)/6*a'^2"
potential = "m*g*y"
parameters = { m = 10, b = 0.2, h = 0.5, g = 9.81 }
[system.constraints]
left = "y - h*cos(a) - b*sin(a) >= 0"
right = "y - h*cos(a) + b*sin(a) >= 0"
[state]
position = { y = "h*cos(0.1) + b*sin(0.1)", a = 0.1 }
[simulate]
until = 2
)toml");
  const std::string text = tests::run({"simulate", file}).out;
  CHECK(text.find("\n  a     0    0     0\n") != std::string::npos);
  const std::string json = tests::run({"simulate", file, "--json"}).out;
  CHECK(json.find("\"a\":0}") > json.find("\"position\""));
  CHECK(json.substr(json.find("\"position\""), 60).find("e-") != std::string::npos);
}

TEST_CASE("how far one force alone may change is where the contacts of an answer are others") {
  const Folder folder;
  const auto text = [](double first, double second) {
    return "[projection]\nA = [[2, 1], [1, 3]]\nz = [" + std::to_string(first) + ", " +
           std::to_string(second) + "]\nU = [[1, 0], [1, 1], [-1, 2]]\ns = [0, -1, -3]\n";
  };
  const double z[2] = {-2, 1};
  const auto active = [&](int i, double by) {
    const Outcome outcome = run_json_on("solve", text(z[0] + (i == 0 ? by : 0), z[1] + (i == 1 ? by : 0)));
    return Json::parse(outcome.out).at("active");
  };
  const std::string file = folder.write("a.toml", text(z[0], z[1]));
  const Json reach =
      Json::parse(run({"solve", "--json", "--sensitivity", file}).out).at("sensitivity").at("reach");
  int found = 0;
  for (int i = 0; i < 2; ++i)
    for (const char* way : {"more", "less"}) {
      const Json& first = reach.at("q[" + std::to_string(i) + "]").at(way);
      if (first.is_null()) continue;
      ++found;
      const double by = first.at("by").get<double>() * (std::string(way) == "more" ? 1 : -1);
      CHECK(active(i, 0.999 * by) == active(i, 0));
      CHECK(active(i, 1.001 * by) != active(i, 0));
    }
  CHECK(found >= 2);
  CHECK(run({"solve", "--sensitivity", file}).out.find("How much one force alone may change") !=
        std::string::npos);
}
