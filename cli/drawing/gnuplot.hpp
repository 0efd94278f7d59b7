#pragma once

#include <string>

namespace cli {

/// Whether the plotting program is there.
bool has_gnuplot();

/// What to say when it is not.
inline constexpr const char* gnuplot_advice =
    "for the picture install gnuplot (Debian, Ubuntu: apt-get install gnuplot-nox) and run this again";

/// `set terminal` and `set output` for a picture of that size in a file named .svg or .png. Throws
/// InvalidInput for another name.
std::string terminal_text(const std::string& file, int wide, int height);

/// A string in gnuplot's double quotes, its markup switched off.
std::string quoted(const std::string& text);

/// A picture: the script without its terminal, and its height in pixels when it is 700 wide.
struct Drawing {
  std::string script;
  int height = 0;
};

/// Draws the picture into the file. Without gnuplot, its script goes to FILE.gnuplot and standard error tells
/// how to go on. Throws InvalidInput with gnuplot's words when it does not end well.
void draw(const std::string& file, const Drawing&);

}  // namespace cli
