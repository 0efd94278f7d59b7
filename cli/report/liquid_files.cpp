#include "cli/report/liquid_files.hpp"

#include <fmt/format.h>

#include <iterator>

#include "cli/problem_file/documents.hpp"

namespace cli::inline reports {
namespace {

using mechanics::liquid::LiquidSample;

template <class Value>
std::string data_array(const char* name, const LiquidSample& sample, Value value) {
  std::string text = fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", name);
  for (std::size_t k = 0; k < sample.inside.size(); ++k)
    text += fmt::format("{}{}", static_cast<double>(value(k)), k % 8 == 7 ? '\n' : ' ');
  return text + "\n</DataArray>\n";
}

}  // namespace

void write_liquid_table(const std::string& file, const std::vector<std::string>& coordinates,
                        const LiquidSample& sample) {
  std::string text;
  for (const std::string& name : coordinates) text += name + ",";
  text += "p,growth,cavity\n";
  for (std::size_t k = 0; k < sample.inside.size(); ++k) {
    if (!sample.inside[k]) continue;
    const mechanics::liquid::Point x = sample.at(k);
    for (std::size_t i = 0; i < coordinates.size(); ++i) text += fmt::format("{},", x[i]);
    text += fmt::format("{},{},{}\n", sample.p[k], sample.growth[k], sample.cavity[k] ? 1 : 0);
  }
  write_file(file, text);
}

void write_liquid_image(const std::string& file, const LiquidSample& sample) {
  const auto& n = sample.points;
  const auto spacing = [&](std::size_t i) { return sample.step[i] > 0 ? sample.step[i] : 1.0; };
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", n[0] - 1, n[1] - 1, n[2] - 1);
  write_file(
      file,
      fmt::format(
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\">\n<ImageData "
          "WholeExtent=\"{0}\" Origin=\"{1} {2} {3}\" Spacing=\"{4} {5} {6}\">\n<Piece Extent=\"{0}\">\n"
          "<PointData Scalars=\"p\">\n",
          extent, sample.low[0], sample.low[1], sample.low[2], spacing(0), spacing(1), spacing(2)) +
          data_array("p", sample, [&](std::size_t k) { return sample.p[k]; }) +
          data_array("growth", sample, [&](std::size_t k) { return sample.growth[k]; }) +
          data_array("cavity", sample, [&](std::size_t k) { return sample.cavity[k]; }) +
          data_array("inside", sample, [&](std::size_t k) { return sample.inside[k]; }) +
          "</PointData>\n<CellData/>\n</Piece>\n</ImageData>\n</VTKFile>\n");
}

}  // namespace cli::inline reports
