#include <doctest/doctest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;

/// The pages that the program writes of itself say what its --help says.
namespace {

std::string slurped(const std::string& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The names that stand first in lines of the part of `help` that begins with `heading`.
std::vector<std::string> listed(const std::string& help, const std::string& heading) {
  std::vector<std::string> names;
  std::size_t at = help.find("\n" + heading + ":\n");
  if (at == std::string::npos) return names;
  for (at = help.find('\n', at + 1) + 1; help.compare(at, 2, "  ") == 0; at = help.find('\n', at) + 1) {
    const std::string line = help.substr(at, help.find('\n', at) - at);
    if (line[2] == ' ') continue;  // the rest of a long line
    std::string word = line.substr(2, line.find(' ', 2) - 2);
    for (std::size_t comma; (comma = word.find(',')) != std::string::npos; word = word.substr(comma + 1))
      names.push_back(word.substr(0, comma));
    names.push_back(word);
  }
  return names;
}

std::vector<std::string> program_commands() { return listed(run({"--help"}).out, "Subcommands"); }

/// What the shell's own completion offers behind these words, with the program's functions for it.
std::string offered_by_bash(const std::vector<std::string>& words) {
  const Folder folder;
  const std::string functions = folder.write("functions", run({"completions", "bash"}).out);
  std::string script = "source " + functions + "; COMP_WORDS=(";
  for (const std::string& word : words) script += "'" + word + "' ";
  script += "); COMP_CWORD=" + std::to_string(words.size() - 1) +
            "; _moreau 2>/dev/null; echo \" ${COMPREPLY[*]} \"";
  const std::string out = folder.path("out");
  if (std::system(
          ("bash -c \"" + std::regex_replace(script, std::regex(R"(["$`\\])"), R"(\$&)") + "\" > " + out)
              .c_str()) != 0)
    return "bash failed";
  return slurped(out);
}

}  // namespace

TEST_CASE("every command and option of --help is in the manual page and in the completions of each shell") {
  std::string man = std::regex_replace(run({"help", "--man"}).out, std::regex(R"(\\-)"), "-");
  const std::string bash = run({"completions", "bash"}).out, zsh = run({"completions", "zsh"}).out,
                    fish = run({"completions", "fish"}).out;
  int options = 0;
  for (const std::string& command : program_commands()) {
    CAPTURE(command);
    const std::size_t section = man.find(".SS moreau " + command);
    REQUIRE(section != std::string::npos);
    const std::string told = man.substr(section, man.find("\n.S", section + 1) - section);
    const std::size_t in_zsh = zsh.find("\n    " + command + ")\n");
    REQUIRE(in_zsh != std::string::npos);
    const std::string zsh_part = zsh.substr(in_zsh, zsh.find(";;", in_zsh) - in_zsh);
    const std::size_t in_bash = bash.find("\n    " + command + ") words=\"");
    REQUIRE(in_bash != std::string::npos);
    const std::string bash_part = bash.substr(in_bash, bash.find(";;", in_bash) - in_bash);
    for (const std::string& option : listed(run({command, "--help"}).out, "Options")) {
      CAPTURE(option);
      ++options;
      CHECK(told.find("\\fB" + option + "\\fR") != std::string::npos);
      CHECK(zsh_part.find(option + "[") != std::string::npos);
      CHECK(std::regex_search(bash_part, std::regex("[\" ]" + option + "[\" ]")));
      const bool is_long = option.rfind("--", 0) == 0;
      const std::string in_fish = (is_long ? "-l " : "-s ") + option.substr(is_long ? 2 : 1) + " ";
      CHECK(std::regex_search(fish, std::regex("from " + command + "'[^\n]* " + in_fish)));
    }
  }
  CHECK(options > 100);
}

/// The words of a comma-separated list.
std::set<std::string> words_of(std::string list) {
  std::set<std::string> words;
  for (auto& c : list) c = c == ',' ? ' ' : c;
  std::istringstream stream(list);
  for (std::string word; stream >> word;) words.insert(word);
  return words;
}

TEST_CASE("the table of options names the commands that have them, and of the shared ones all") {
  std::map<std::string, std::set<std::string>> has;  // option -> commands
  std::set<std::string> commands;
  for (const std::string& command : program_commands()) {
    commands.insert(command);
    for (const std::string& option : listed(run({command, "--help"}).out, "Options"))
      has[option].insert(command);
  }
  std::ifstream page(tests::source_folder() + "docs/commands.md");
  std::map<std::string, std::set<std::string>> told;
  static const std::regex row(R"(^\| (`--[^|]*) \| ([^|]*) \|.*)"), name("`(--[a-z-]+)");
  bool in_section = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) in_section = line == "## Options";
    std::smatch cells;
    if (!in_section || !std::regex_match(line, cells, row)) continue;
    std::string list = cells[2];
    std::set<std::string> named = words_of(list);
    if (list.starts_with("all")) {
      const std::set<std::string> without =
          list == "all" ? std::set<std::string>{} : words_of(list.substr(7));
      named.clear();
      for (const std::string& command : commands)
        if (!without.contains(command)) named.insert(command);
    }
    const std::string options = cells[1];
    for (std::sregex_iterator at(options.begin(), options.end(), name), end; at != end; ++at)
      told[(*at)[1]].insert(named.begin(), named.end());
  }
  CHECK(told.size() > 25);
  for (const auto& [option, named] : told) {
    CAPTURE(option);
    for (const std::string& command : named) {
      CAPTURE(command);
      CHECK(has[option].contains(command));
    }
  }
  for (const std::string shared : {"--json", "--set", "--quiet", "--method", "--tolerance", "--limit",
                                   "--metric", "--certify", "--at", "--help"}) {
    CAPTURE(shared);
    CHECK(told[shared] == has[shared]);
  }
}

TEST_CASE("bash completes commands, options, and the words that an option takes") {
  CHECK(offered_by_bash({"moreau", "so"}) == " solve \n");
  CHECK(offered_by_bash({"moreau", "solve", "--cert"}) == " --certify \n");
  CHECK(offered_by_bash({"moreau", "solve", "--method", "nn"}) == " nnls \n");
  CHECK(offered_by_bash({"moreau", "simulate", "--method", "time"}) == " time-stepping \n");
  CHECK(offered_by_bash({"moreau", "functions", "elastic"}) == " elastic_net \n");
  CHECK(offered_by_bash({"moreau", "new", "liq"}) == " liquid \n");
  CHECK(offered_by_bash({"moreau", "help", "expr"}) == " expressions \n");
}

TEST_CASE("every file to begin with solves, proved, and is not written over what is there") {
  const Folder folder;
  const std::string kinds = run({"new"}).out;
  int written = 0;
  for (std::size_t at = 0; at < kinds.size(); at = kinds.find('\n', at) + 1) {
    const std::string kind = kinds.substr(at, kinds.find(' ', at) - at), file = folder.path(kind + ".toml");
    CAPTURE(kind);
    CHECK(run({"new", kind, file}).code == 0);
    CHECK(run({"new", kind, "-"}).out == slurped(file));
    const Outcome solved = run({"solve", file});
    CHECK(solved.code == 0);
    CHECK(solved.err.empty());
    if (slurped(file).find("[simulate]") != std::string::npos) CHECK(run({"simulate", file}).code == 0);
    ++written;
  }
  CHECK(written >= 7);
  const std::string mine = folder.write("mine.toml", "title = \"mine\"\n");
  const Outcome refused = run({"new", "system", mine});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("mine.toml:1:1: it is there already; ") != std::string::npos);
  CHECK(slurped(mine) == "title = \"mine\"\n");
}

TEST_CASE("help tells of topics, commands, functions and methods, and finds a slip of any") {
  for (const std::string& command : program_commands()) {
    CAPTURE(command);
    const std::string own = run({command, "--help"}).out;
    CHECK(run({"help", command}).out == own);
  }
  CHECK(run({"help", "norm1"}).out == run({"functions", "norm1"}).out);
  CHECK(run({"help", "nnls"}).out.starts_with("nnls: nonnegative least squares"));
  CHECK(run({"help", "expresions"}).err.find("did you mean \"expressions\"?") != std::string::npos);
  CHECK(run({"help", "qqqqqq"}).err.find("`moreau help` lists them") != std::string::npos);
  const std::string all = run({"help"}).out;
  for (const char* topic : {"start", "state", "expressions", "exit-codes"}) {
    CHECK(all.find(std::string("\n  ") + topic + " ") != std::string::npos);
    CHECK(run({"help", topic}).code == 0);
  }
}

TEST_CASE("the topic on expressions has every function that expressions have") {
  const std::string topic = run({"help", "expressions"}).out;
  const std::string err = run_on("solve", point_on_floor({{9, "floor = \"y >= wibble(x)\""}})).err;
  const std::size_t at = err.find("the functions are ") + std::string("the functions are ").size();
  std::string list = err.substr(at, err.find(';', at) - at);
  int functions = 0;
  const std::regex word("[a-z0-9]+");
  for (std::sregex_iterator it(list.begin(), list.end(), word), end; it != end; ++it, ++functions) {
    CAPTURE(it->str());
    CHECK(std::regex_search(topic, std::regex("\\b" + it->str() + "\\b")));
  }
  CHECK(functions >= 20);
}

TEST_CASE("the first words of an engineer are topics of the help") {
  for (const auto& [topic, said] : {std::pair{"friction", "Contacts have no friction"},
                                    {"contact", "[system.constraints]"},
                                    {"units", "carry no units"}}) {
    CAPTURE(topic);
    const Outcome outcome = run({"help", topic});
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find(said) != std::string::npos);
  }
}
