#include "cli/drawing/gnuplot.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "cli/held_interrupt.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline drawings {
namespace {

using convex::InvalidInput;

constexpr int picture_width = 700;

/// What to do where gnuplot is not there.
constexpr const char* gnuplot_advice =
    "install it (Debian, Ubuntu: apt-get install gnuplot-nox) and run this again";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A file of its own for the script, gone when this is.
class ScriptFile {
 public:
  explicit ScriptFile(const std::string& script) {
    const int file = mkstemp(path_.data());
    if (file < 0) throw InvalidInput("cannot write to " + path_ + "; make room there");
    close(file);
    std::ofstream(path_) << script;
  }
  ~ScriptFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / "moreau-plot-XXXXXX").string();
};

/// A terminal by Cairo, with letters, lines and marks of the sizes that they have in an SVG: so the layout of
/// a picture, which is counted in pixels of the SVG, holds in all. `letters`, `lines`, `marks`: measured, of
/// gnuplot 5.4; a PNG has its points of letters at 96 to the inch.
struct CairoTerminal {
  const char* name;
  double unit, letters, lines, marks;  ///< unit: of the size, per pixel
};
constexpr CairoTerminal png_terminal{"pngcairo", 2, 1.5, 2, 3},
    pdf_terminal{"pdfcairo", 1.0 / 72, 0.75, 2, 1.5};
constexpr double cairo_key_spacing = 1.25;

/// `set terminal` and `set output` for a picture of that size. Throws InvalidInput for a name that is neither
/// .svg, .png nor .pdf.
std::string terminal_text(const std::string& file, int wide, int height) {
  std::string plain = "\"";
  for (const char c : file) {
    if (c == '"' || c == '\\') plain += '\\';
    plain += c;
  }
  plain += '"';
  const std::string output = "set output " + plain + "\n";
  const auto cairo = [&](const CairoTerminal& t) {
    return fmt::format(
        "set terminal {} enhanced size {},{} background \"#ffffff\" font \"Helvetica,11\" fontscale {} "
        "linewidth {} pointscale {}\nset key spacing {}\n",
        t.name, t.unit * wide, t.unit * height, t.letters, t.lines, t.marks, cairo_key_spacing);
  };
  if (ends_with(file, ".svg"))
    return fmt::format(
               "set terminal svg enhanced size {},{} dynamic background \"#ffffff\" font \"Helvetica,11\"\n",
               wide, height) +
           output;
  if (ends_with(file, ".png")) return cairo(png_terminal) + output;
  if (ends_with(file, ".pdf")) return cairo(pdf_terminal) + output;
  throw InvalidInput(file + ": a picture is named .svg, .png or .pdf; give such a name");
}

}  // namespace

bool has_gnuplot() {
  const char* folders = std::getenv("PATH");
  std::istringstream path(folders != nullptr ? folders : "");
  for (std::string folder; std::getline(path, folder, ':');)
    if (access((folder + "/gnuplot").c_str(), X_OK) == 0) return true;
  return false;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '_' || c == '^' || c == '{' || c == '}' || c == '@' || c == '&' || c == '~') result += "\\\\";
    if (c == '\n')
      result += "\\n";
    else
      result += c;
  }
  return result + "\"";
}

namespace {

/// gnuplot writes & as it is into SVG, so that entities may be told to it; a sign that begins none is no XML.
void write_ampersands_as_entities(const std::string& file) {
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  in.close();
  std::string mended;
  for (std::size_t k = 0; k < text.size(); ++k) {
    mended += text[k];
    if (text[k] != '&') continue;
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789#", k + 1);
    if (end == k + 1 || end == std::string::npos || text[end] != ';') mended += "amp;";
  }
  if (mended != text) std::ofstream(file) << mended;
}

}  // namespace

void require_drawable(const std::string& file) {
  terminal_text(file, picture_width, picture_width);
  if (!has_gnuplot())
    throw InvalidInput(file + ": pictures are drawn by gnuplot, which is not in PATH; " + gnuplot_advice);
  // Asked before the work, and without a trace of it where this ends without a picture.
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path folder = fs::path(file).has_parent_path() ? fs::path(file).parent_path() : fs::path(".");
  const bool is_writable = fs::is_directory(folder, none) && !fs::is_directory(file, none) &&
                           access(fs::exists(file, none) ? file.c_str() : folder.c_str(), W_OK) == 0;
  if (!is_writable) throw InvalidInput("cannot write " + file + "; check its folder and permissions");
}

void draw(const std::string& file, const Drawing& drawing) {
  const ScriptFile script(terminal_text(file, drawing.width, drawing.height) + drawing.script);
  const HeldInterrupt held;
  FILE* program = popen(("gnuplot " + script.path() + " 2>&1").c_str(), "r");
  if (program == nullptr) throw InvalidInput(std::string("gnuplot does not start; ") + gnuplot_advice);
  std::string said;
  std::array<char, 512> block{};
  while (std::fgets(block.data(), block.size(), program) != nullptr) said += block.data();
  if (pclose(program) != 0) {
    std::error_code ignored;  // half a picture is none
    if (std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);
    for (char& c : said)
      if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
    throw InvalidInput(
        file +
        ": gnuplot cannot draw it; version 5.2 or later is needed, and room on the disk. It says: " + said);
  }
  if (file.ends_with(".svg")) write_ampersands_as_entities(file);
}

}  // namespace cli::inline drawings
