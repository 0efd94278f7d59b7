#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tests/this_build.hpp"

namespace {

const std::filesystem::path root = tests::source_folder();

std::string contents(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("the code on the page of the library is the code that runs, all of it") {
  const std::string page = contents(root / "docs/library.md");
  const std::string doctest_line = "#include <doctest/doctest.h>\n\n";
  std::size_t examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(root / "tests/library")) {
    const std::string name = "tests/library/" + entry.path().filename().string();
    if (name == "tests/library/page.cpp") continue;
    CAPTURE(name);
    const std::string code = contents(entry.path());
    REQUIRE(code.starts_with(doctest_line));
    const std::string shown = "```cpp\n// " + name + "\n" + code.substr(doctest_line.size()) + "```\n";
    // When it fails: put the file's text into the page again, without the line that includes doctest.
    CHECK(page.find(shown) != std::string::npos);
    ++examples;
  }
  std::size_t blocks = 0;
  for (std::size_t at = 0; (at = page.find("```cpp\n// tests/library/", at)) != std::string::npos; ++at)
    ++blocks;
  CHECK(blocks == examples);
  CHECK(examples >= 10);
}
