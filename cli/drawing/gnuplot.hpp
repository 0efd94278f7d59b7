#pragma once

#include <string>

namespace cli::inline drawings {

/// Whether the plotting program is there.
bool has_gnuplot();

/// Throws InvalidInput where the file is named neither .svg, .png nor .pdf, or gnuplot is not there: asked
/// before the work whose picture it is.
void require_drawable(const std::string& file);

/// A string in gnuplot's double quotes, its markup switched off.
std::string quoted(const std::string& text);

/// A picture: the script without its terminal, and its height in pixels when it is so wide.
struct Drawing {
  std::string script;
  int height = 0, width = 700;
};

/// Draws the picture into the file. Throws InvalidInput with gnuplot's words when it does not end well; no
/// part of a picture stays then.
void draw(const std::string& file, const Drawing&);

}  // namespace cli::inline drawings
