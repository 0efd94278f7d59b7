#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// What the pages print of the program is what the program prints.
namespace {

const fs::path root = tests::source_folder();

std::string contents(const fs::path& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found{root / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

/// The fenced blocks of a page that are marked so.
std::vector<std::string> blocks(const std::string& page, const std::string& mark) {
  std::vector<std::string> found;
  bool inside = false, wanted = false;
  std::istringstream stream(page);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t start = line.find_first_not_of(' ');
    if (start != std::string::npos && line.compare(start, 3, "```") == 0) {
      inside = !inside;
      wanted = inside && line.substr(start + 3) == mark;
      if (wanted) found.emplace_back();
    } else if (wanted) {
      found.back() += line + "\n";
    }
  }
  return found;
}

/// "$ command" with the lines that it is said to print; "..." stands for any.
struct Session {
  std::string command;
  std::vector<std::string> printed;
};

std::vector<Session> sessions(const std::string& page) {
  std::vector<Session> found;
  for (const char* mark : {"text", ""})
    for (const std::string& block : blocks(page, mark)) {
      bool open = false;
      for (const std::string& line : lines_of(block)) {
        const std::size_t start = line.find_first_not_of(' ');
        if (start != std::string::npos && line.compare(start, 2, "$ ") == 0) {
          open = true;
          found.push_back({line.substr(start + 2), {}});
        } else if (open) {
          found.back().printed.push_back(line);
        }
      }
    }
  for (Session& session : found)
    while (!session.printed.empty() && session.printed.back().empty()) session.printed.pop_back();
  return found;
}

/// Standard output and standard error of a command of the shell, with this build's program as `moreau`. It
/// runs where `docs` is the project's, and what it writes is not.
std::vector<std::string> run_shell(const Folder& folder, const std::string& command) {
  const std::string out = folder.path("out"), err = folder.path("err");
  const fs::path program = tests::program_file();
  const fs::path place = folder.path("session");
  if (fs::create_directory(place)) fs::create_directory_symlink(root / "docs", place / "docs");
  const std::string line = "cd '" + place.string() + "' && PATH='" + program.parent_path().string() +
                           ":'$PATH && { " +
                           std::regex_replace(command, std::regex("^cli/moreau "), "moreau ") + "\n} > '" +
                           out + "' 2> '" + err + "' < /dev/null";
  (void)std::system(line.c_str());  // examples of errors end with other codes
  std::vector<std::string> lines = lines_of(contents(out));
  for (std::string& error : lines_of(contents(err))) lines.push_back(std::move(error));
  return lines;
}

/// Below this size a number on a page is rounding, which may differ by machine.
constexpr double rounding = 1e-9;

/// The pieces of a line between "…", which stands for any text, one after the other in the program's.
bool holds_pieces(const std::string& page, const std::string& program) {
  const std::string any = "…";
  std::size_t at = 0;
  for (std::size_t start = 0; start <= page.size();) {
    const std::size_t end = std::min(page.find(any, start), page.size());
    const std::string piece = page.substr(start, end - start);
    const std::size_t found = end == page.size() && program.size() >= piece.size()
                                  ? std::max(at, program.size() - piece.size())
                                  : program.find(piece, at);
    if (found == std::string::npos || program.compare(found, piece.size(), piece) != 0) return false;
    if (start == 0 && found != 0) return false;
    at = found + piece.size();
    start = end + any.size();
  }
  return true;
}

/// One line printed like the other, but for seconds and for numbers that are rounding in both.
bool alike(const std::string& page, const std::string& program) {
  static const std::regex seconds("\"seconds\":[^,}]*"), number(R"(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)");
  const std::string a = std::regex_replace(page, seconds, ""), b = std::regex_replace(program, seconds, "");
  if (a.find("…") != std::string::npos) return holds_pieces(a, b);
  std::sregex_iterator x(a.begin(), a.end(), number), y(b.begin(), b.end(), number);
  const std::sregex_iterator end;
  const auto words = [](const std::string& text) {  // columns may be as wide as the rounding in them
    return std::regex_replace(std::regex_replace(text, number, "#"), std::regex(" +"), " ");
  };
  if (words(a) != words(b)) return false;
  for (; x != end && y != end; ++x, ++y) {
    if (x->str() == y->str()) continue;
    if (std::abs(std::stod(x->str())) > rounding || std::abs(std::stod(y->str())) > rounding) return false;
  }
  return x == end && y == end;
}

/// Whether the program's lines are those of the page; the first that is not is told.
bool as_printed(const std::vector<std::string>& page, const std::vector<std::string>& program,
                std::string& where) {
  std::size_t at = 0;
  bool any = false;
  for (const std::string& line : page) {
    if (line == "...") {
      any = true;
      continue;
    }
    std::size_t here = at;
    while (any && here < program.size() && !alike(line, program[here])) ++here;
    if (here >= program.size() || !alike(line, program[here])) {
      where = "page:    " + line + "\nprogram: " + (at < program.size() ? program[at] : "(no more)");
      return false;
    }
    at = here + 1;
    any = false;
  }
  if (any || at == program.size()) return true;
  where = "page:    (no more)\nprogram: " + program[at];
  return false;
}

/// Equal but for the rounding of numbers.
bool alike(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number())
    return std::abs(a.get<double>() - b.get<double>()) <= rounding * std::abs(a.get<double>());
  if (a.type() != b.type() || a.size() != b.size()) return false;
  if (!a.is_structured()) return a == b;
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y)
    if ((a.is_object() && x.key() != y.key()) || !alike(*x, *y)) return false;
  return true;
}

Json exact_solution(const Folder& folder, const std::string& toml) {
  return Json::parse(run({"solve", "--method", "exact", "--json", folder.write("page.toml", toml)}).out);
}

}  // namespace

TEST_CASE("every command on a page prints what the page says") {
  const Folder folder;
  int tried = 0;
  for (const fs::path& page : pages())
    for (const Session& session : sessions(contents(page))) {
      if (session.command.find("moreau ") == std::string::npos) continue;
      ++tried;
      std::string where;
      const bool same = as_printed(session.printed, run_shell(folder, session.command), where);
      CAPTURE(page.string());
      CAPTURE(session.command);
      INFO(where);
      CHECK((same || session.printed.empty()));
    }
  CHECK(tried >= 12);
}

TEST_CASE("the comparison of pages sees another digit, another word, a line more and a line less") {
  std::string where;
  const std::vector<std::string> page{"x  1.8  2e-16", "...", "end"};
  CHECK(as_printed(page, {"x  1.8   3.1e-17", "anything", "end"}, where));
  CHECK(as_printed(page, {"x  1.8  0", "end"}, where));
  CHECK(as_printed({"{\"a\":1,…,\"z\":2}"}, {"{\"a\":1,\"b\":3,\"z\":2}"}, where));
  CHECK_FALSE(as_printed({"{\"a\":1,…,\"z\":2}"}, {"{\"a\":1,\"b\":3,\"z\":4}"}, where));
  CHECK_FALSE(as_printed({"{\"a\":1,…,\"z\":2}"}, {"{\"a\":7,\"b\":3,\"z\":2}"}, where));
  CHECK_FALSE(as_printed(page, {"x  1.81  2e-16", "end"}, where));
  CHECK_FALSE(as_printed(page, {"x  1.8  2e-6", "end"}, where));
  CHECK_FALSE(as_printed(page, {"y  1.8  2e-16", "end"}, where));
  CHECK_FALSE(as_printed(page, {"x  1.8  2e-16", "end", "more"}, where));
  CHECK_FALSE(as_printed(page, {"x  1.8  2e-16"}, where));
}

TEST_CASE("every whole problem file on a page is solved") {
  const Folder folder;
  int tried = 0;
  for (const fs::path& page : pages())
    for (const std::string& block : blocks(contents(page), "toml")) {
      const auto has = [&](const char* table) { return block.find(table) != std::string::npos; };
      const bool whole = (has("[system]") && has("[state]")) || has("[projection]") ||
                         has("[decomposition]") || has("[cone]");
      if (!whole) continue;
      ++tried;
      CAPTURE(page.string());
      CAPTURE(block);
      const Outcome solved = run({"solve", "--json", folder.write("page.toml", block)});
      CAPTURE(solved.err);
      CHECK(solved.code == 0);
    }
  CHECK(tried >= 10);
}

TEST_CASE("the example by hand of the page on proofs has the numbers told there") {
  const Folder folder;
  const std::string page = contents(root / "docs/proof.md"), toml = blocks(page, "toml").at(0);
  for (const char* told : {"q = (2/3, 1/3) with multipliers (2/3, 0, 4/3)", "`farkas` is (0, 0, 1, 1)"})
    CHECK(page.find(told) != std::string::npos);
  const Json exact = exact_solution(folder, toml)["exact"];
  CHECK(exact["acceleration"] == Json{{"q[0]", "2/3"}, {"q[1]", "1/3"}});
  CHECK(exact["multipliers"] == Json{{"c[0]", "2/3"}, {"c[1]", "0"}, {"c[2]", "4/3"}});
  const std::string more =
      std::regex_replace(std::regex_replace(toml, std::regex("\\[1, 2\\]\\]"), "[1, 2], [-1, -2]]"),
                         std::regex("\"4/3\"\\]"), "\"4/3\", -1]");
  const Json none = exact_solution(folder, more);
  CHECK(none["status"] == "infeasible");
  CHECK(none["farkas"] == Json{{"c[0]", 0}, {"c[1]", 0}, {"c[2]", 1}, {"c[3]", 1}});
}

TEST_CASE("numbers that a page tells of a scene are those of the program") {
  struct Told {
    const char* page;
    const char* words;
    std::vector<std::string> command;
    const char* key;
    Json value;
  };
  const auto scene = [](const std::string& name) { return (root / "docs/problems" / name).string(); };
  const Told table[] = {
      {"docs/proof.md",
       "`delassus_drops_too_much.toml` has q'' = (9/5, -6)",
       {"solve", "--certify", "--json", scene("delassus_drops_too_much.toml")},
       "/from_text/acceleration",
       {{"y", "9/5"}, {"a", "-6"}}},
      {"docs/problems/README.md",
       "infeasible, Farkas weights 1 and 3",
       {"solve", "--json", scene("jammed_seesaw.toml")},
       "/farkas",
       {{"right_jack", 1}, {"left_jack", 3}}},
      {"docs/problems/README.md",
       "fifteen generators, three of them to spare",
       {"solve", "--json", scene("cone_friction_pyramid.toml")},
       "/generators/11",
       {4, -3, 10}},
      {"docs/problems/README.md",
       "a negative multiplier that is right",
       {"solve", "--json", scene("projection_two_sided.toml")},
       "/multipliers/c[1]",
       -0.2434640522875817},
      {"docs/problems/README.md",
       "both two-sided multipliers are negative, only one contact opens",
       {"solve", "--json", scene("delassus_drops_too_much.toml")},
       "/two_sided/multipliers",
       {{"left", -5}, {"right", -0.5}}},
      {"docs/problems/README.md",
       "one two-sided multiplier is negative, both contacts open",
       {"solve", "--json", scene("delassus_drops_too_little.toml")},
       "/active",
       Json::array()},
  };
  for (const Told& told : table) {
    const std::string words = told.words;
    CAPTURE(words);
    CHECK(contents(root / told.page).find(told.words) != std::string::npos);
    const Json found = Json::parse(run(told.command).out);
    CHECK(alike(told.value, found.at(Json::json_pointer(told.key))));
  }
}

TEST_CASE("the gallery names every problem of the library, and its pictures are there") {
  const std::string page = contents(root / "docs/gallery.md");
  for (const auto& entry : fs::directory_iterator(root / "docs/problems")) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path().filename().string());
    CHECK(page.find("(problems/" + entry.path().filename().string() + ")") != std::string::npos);
  }
  const std::regex picture(R"(!\[[^\]]*\]\(([^)]+)\))");
  for (std::sregex_iterator it(page.begin(), page.end(), picture), end; it != end; ++it)
    CHECK(fs::exists(root / "docs" / (*it)[1].str()));
}
