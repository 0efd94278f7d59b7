#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/source_files.hpp"

using tests::SourceFile;

namespace {

/// The text without comments, literals and directives, so that every brace left is one of the program.
std::string bare(const SourceFile& file) {
  std::string text, kept;
  for (const std::string& line : file.lines)
    if (line.find_first_not_of(" \t") == std::string::npos || line[line.find_first_not_of(" \t")] != '#')
      text += line + "\n";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto starts = [&](const char* with) {
      return text.compare(i, std::string(with).size(), with) == 0;
    };
    if (starts("//")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (starts("/*")) {
      i = std::min(text.find("*/", i), text.size() - 1) + 1;
    } else if (starts("R\"")) {
      const std::string closing = ")" + text.substr(i + 2, text.find('(', i) - i - 2) + "\"";
      i = text.find(closing, i) + closing.size() - 1;
    } else if (text[i] == '"' || (text[i] == '\'' && (i == 0 || std::isalnum(text[i - 1]) == 0))) {
      const char quote = text[i];
      for (++i; i < text.size() && text[i] != quote; ++i)
        if (text[i] == '\\') ++i;
    } else {
      kept += text[i];
    }
  }
  return kept;
}

/// The qualified names of the types that a file defines where the linker can see them: in named namespaces
/// and in such types, not in functions nor in a namespace without a name.
std::set<std::string> visible_types(const SourceFile& file) {
  static const std::regex namespace_head(R"((?:^|\s)namespace(?:\s+([\w: ]*\w))?\s*$)");
  static const std::regex type_head(
      R"((?:^|\s|>)(?:class|struct|union|enum(?:\s+class|\s+struct)?)\s+([\w:]+)(\s*<[^{]*>)?\s*(?:final\s*)?(?::[^{]*)?$)");
  std::set<std::string> found;
  std::vector<std::string> within;  // "" is a scope that hides what is inside
  std::string head;
  for (const char c : bare(file)) {
    if (c == '{') {
      std::smatch match;
      std::string scope;
      if (std::regex_search(head, match, namespace_head)) {
        scope = std::regex_replace(match[1].str(), std::regex("inline\\s+"), "");
      } else if (std::regex_search(head, match, type_head)) {
        scope = match[1].str() + match[2].str();
        std::string name;
        for (const std::string& outer : within) name += outer + "::";
        if (std::find(within.begin(), within.end(), "") == within.end()) found.insert(name + scope);
      }
      within.push_back(scope);
      head.clear();
    } else if (c == '}') {
      REQUIRE_FALSE(within.empty());
      within.pop_back();
      head.clear();
    } else if (c == ';') {
      head.clear();
    } else {
      head += c;
    }
  }
  CAPTURE(file.path);
  CHECK(within.empty());
  return found;
}

/// Those defined in more than one file, each with the files.
std::vector<std::string> defined_twice(const std::vector<SourceFile>& files) {
  std::map<std::string, std::vector<std::string>> places;
  for (const SourceFile& file : files)
    for (const std::string& name : visible_types(file)) places[name].push_back(file.path);
  std::vector<std::string> twice;
  for (const auto& [name, paths] : places) {
    if (paths.size() < 2) continue;
    std::string line = name + ":";
    for (const std::string& path : paths) line += " " + path;
    twice.push_back(line);
  }
  return twice;
}

}  // namespace

TEST_CASE("no two files define a type of one name: the linker would take either for both") {
  std::vector<SourceFile> files = tests::source_files();
  // The example of an installed library is a program of its own.
  std::erase_if(files, [](const SourceFile& file) { return file.path.starts_with("tests/consumer/"); });
  std::size_t types = 0;
  for (const SourceFile& file : files) types += visible_types(file).size();
  CHECK(types > 300);  // the reader of sources finds them
  const std::vector<std::string> twice = defined_twice(files);
  for (const std::string& line : twice) FAIL_CHECK(line);
}

TEST_CASE(
    "a second type of one name is seen, whether class, struct or enumeration, in a header or a source") {
  const SourceFile first{"convex/a.hpp",
                         "convex",
                         {"namespace convex {", "class Pool final : public Base<int> {",
                          "  struct Part { int k; };", "};", "}"}};
  const auto against = [&](std::vector<std::string> lines) {
    return defined_twice({first, {"convex/b.cpp", "convex", std::move(lines)}}).size();
  };
  CHECK(against({"namespace convex {", "struct Pool {", "  double x = f({1, 2});", "};", "}"}) == 1);
  CHECK(against({"namespace convex { enum class Pool { one }; }"}) == 1);
  CHECK(against({"namespace convex::inline pivoting { struct Pool {}; }"}) == 0);
  CHECK(against({"namespace convex {", "struct Pool {", "  struct Part {};", "};", "}"}) == 2);
  CHECK(against({"namespace convex {", "template <class T>", "struct Pool", "{", "};", "}"}) == 1);
  // Hidden, local, only announced, elsewhere, or in words.
  CHECK(against({"namespace convex {", "namespace {", "struct Pool {};", "}", "}"}) == 0);
  CHECK(against({"namespace convex {", "void f() {", "  struct Pool {};", "}", "}"}) == 0);
  CHECK(against({"namespace convex {", "struct Pool;", "void f(struct Pool&) {}", "}"}) == 0);
  CHECK(against({"namespace mechanics {", "struct Pool {};", "}"}) == 0);
  CHECK(against({"namespace convex {", "// struct Pool {", "const char* t = \"struct Pool {\";", "}"}) == 0);
}
