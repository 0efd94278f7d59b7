#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/source_files.hpp"

/// What a page of the documentation refers to is there.
namespace fs = std::filesystem;

namespace {

const fs::path root = tests::source_root();

std::vector<fs::path> pages() {
  std::vector<fs::path> found{root / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

/// The lines of a page with fenced blocks left blank.
std::vector<std::string> prose(const fs::path& page) {
  std::ifstream stream(page);
  std::vector<std::string> lines;
  bool fenced = false;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t start = line.find_first_not_of(' ');
    const bool is_fence = start != std::string::npos && line.compare(start, 3, "```") == 0;
    fenced = fenced != is_fence;
    lines.push_back(fenced || is_fence ? "" : line);
  }
  return lines;
}

/// The name that a heading has in links: lower case, hyphens for blanks, ASCII letters and digits only.
std::string anchor(const std::string& heading) {
  std::string name;
  for (const char c : heading.substr(heading.find_first_not_of("# "))) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ')
      name += '-';
  }
  return name;
}

std::set<std::string> anchors(const fs::path& page) {
  std::set<std::string> found;
  for (const std::string& line : prose(page))
    if (line.rfind('#', 0) == 0) found.insert(anchor(line));
  return found;
}

/// The first groups of all matches.
std::vector<std::string> matches(const std::string& line, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it)
    found.push_back((*it)[1].str());
  return found;
}

}  // namespace

TEST_CASE("every link between pages leads to a page and a section that are there") {
  const std::regex link(R"(\]\(([^)]+)\))");
  int followed = 0;
  for (const fs::path& page : pages())
    for (const std::string& line : prose(page))
      for (const std::string& target : matches(line, link)) {
        if (target.rfind("http", 0) == 0) continue;
        const std::size_t hash = std::min(target.find('#'), target.size());
        const fs::path to = hash == 0 ? page : page.parent_path() / target.substr(0, hash);
        CAPTURE(page.string());
        CAPTURE(target);
        CHECK(fs::exists(to));
        if (hash < target.size() && to.extension() == ".md")
          CHECK(anchors(to).count(target.substr(hash + 1)) == 1);
        ++followed;
      }
  CHECK(followed >= 100);
}

TEST_CASE("every source file that a page names is there, and every page that a source names") {
  const std::regex source(R"(`([A-Za-z0-9_./-]+\.[ch]pp)`)"), page_name(R"((docs/[a-z0-9_/-]+\.md))");
  std::vector<std::string> paths;
  for (const tests::SourceFile& file : tests::source_files()) {
    paths.push_back("/" + file.path);
    if (file.path.rfind("tests/convex/functions/peer_", 0) == 0) continue;  // they name another project's
    for (const std::string& line : file.lines)
      for (const std::string& name : matches(line, page_name)) {
        CAPTURE(file.path);
        CAPTURE(name);
        CHECK(fs::exists(root / name));
      }
  }
  for (const fs::path& page : pages())
    for (const std::string& line : prose(page))
      for (const std::string& name : matches(line, source)) {
        CAPTURE(page.string());
        CAPTURE(name);
        CHECK(std::any_of(paths.begin(), paths.end(),
                          [&](const std::string& path) { return path.ends_with("/" + name); }));
      }
}

TEST_CASE("pages of methods have paragraphs of at most six lines, and no line of 300 characters") {
  for (const fs::path& page : pages()) {
    if (page.parent_path().filename() != "methods" && page.filename() != "methods.md") continue;
    std::size_t paragraph = 0;
    for (const std::string& line : prose(page)) {
      const bool is_prose = !line.empty() && line.find_first_of("|#-") != 0 && line[0] != ' ' &&
                            !std::isdigit(static_cast<unsigned char>(line[0]));
      paragraph = is_prose ? paragraph + 1 : 0;
      CAPTURE(page.string());
      CAPTURE(line);
      CHECK(paragraph <= 6);
      CHECK(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }) < 300);
    }
  }
}
