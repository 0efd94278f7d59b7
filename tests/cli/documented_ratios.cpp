#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "tests/this_build.hpp"

namespace fs = std::filesystem;

namespace {

/// By problem and method the least time of an answer that is right to 1e-9, from the table that is kept.
std::map<std::string, std::map<std::string, double>> kept_times() {
  std::map<std::string, std::map<std::string, double>> times;
  std::ifstream file(tests::source_folder() + "docs/charts/speed_accuracy.csv");
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> reversed;  // the problem's name may have commas and quotation marks
    std::size_t end = line.size();
    while (reversed.size() < 7) {
      const std::size_t comma = line.rfind(',', end - 1);
      reversed.push_back(line.substr(comma + 1, end - comma - 1));
      end = comma;
    }
    std::string problem = std::regex_replace(line.substr(0, end), std::regex("\""), "");
    const std::string &status = reversed[0], &error = reversed[1], &seconds = reversed[2],
                      &method = reversed[4];
    if (status != "ok" || error.empty() || !(std::stod(error) <= 1e-9)) continue;
    double& least = times[problem].try_emplace(method, HUGE_VAL).first->second;
    least = std::min(least, std::stod(seconds));
  }
  return times;
}

}  // namespace

TEST_CASE("the ratios that a page prints are those of the numbers that are kept") {
  const auto times = kept_times();
  std::ifstream page(tests::source_folder() + "docs/speed-and-accuracy.md");
  const std::regex row(R"(^\| (.*) \(n \d+(?:, m \d+)?\) \| ([0-9.]+) us \| (.*) \|$)"),
      ratio(R"(([a-z-]+) ([0-9.]+))");
  int rows = 0;
  for (std::string line; std::getline(page, line);) {
    std::smatch found;
    if (!std::regex_match(line, found, row)) continue;
    ++rows;
    REQUIRE(times.count(found[1]) == 1);
    const auto& by_method = times.at(found[1]);
    const std::string list = found[3];
    constexpr double two_digits = 0.051;
    CHECK(std::stod(found[2]) == doctest::Approx(by_method.at("auto") * 1e6).epsilon(two_digits));
    std::size_t named = 0;
    for (std::sregex_iterator it(list.begin(), list.end(), ratio), end; it != end; ++it, ++named) {
      CAPTURE(line.substr(0, 40));
      CAPTURE((*it)[1].str());
      CHECK(std::stod((*it)[2]) ==
            doctest::Approx(by_method.at((*it)[1]) / by_method.at("auto")).epsilon(two_digits));
    }
    CHECK(named + 1 == by_method.size());
  }
  CHECK(rows == static_cast<int>(times.size()));
}
