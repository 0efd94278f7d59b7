#pragma once

#include <string>
#include <vector>

#include "mechanics/liquid/liquid_solution.hpp"
#include "mechanics/liquid/onset.hpp"

namespace cli::inline drawings {

/// Inception as a parameter grows, as one page that plays it: the pressure with contours, the cavity hatched,
/// walls that part in red; of one coordinate p over it, of three the section through the middle of the
/// domain. The page needs no network.
class LiquidAnimation {
 public:
  explicit LiquidAnimation(std::string parameter) : parameter_(std::move(parameter)) {}
  /// The scene with this value of the parameter, solved.
  void add(double value, const mechanics::liquid::LiquidScene&, const mechanics::liquid::LiquidSolution&);
  /// A value at which the scene is none, and why.
  void add_failure(double value, std::string why);
  void mark_onset(const mechanics::liquid::LiquidOnset& onset) { onset_ = onset; }
  std::string page(const std::string& title) const;

 private:
  /// What is seen at one value, at the points of a grid over the box of the domain.
  struct Frame {
    double value = 0;
    std::string failure;
    std::vector<std::string> coordinates;
    std::array<double, 4> box{};  ///< low and high of the first coordinate, low and high of the second
    std::array<int, 2> points{1, 1};
    double height = 0;  ///< of the section, in three dimensions
    double largest = 0, fraction = 0;
    std::vector<std::string> parted_walls;
    std::vector<double> level, p, cavity;  ///< cavity: the part of the square around the point that is in it
    std::vector<std::array<double, 2>> parted;
  };
  std::string data(const std::string& title) const;
  std::string parameter_;
  std::vector<Frame> frames_;
  std::optional<mechanics::liquid::LiquidOnset> onset_;
};

/// The page that plays the data of a liquid's animation, a JSON object.
std::string liquid_page(const std::string& title, const std::string& data);

}  // namespace cli::inline drawings
