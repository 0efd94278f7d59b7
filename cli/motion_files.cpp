#include "cli/motion_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "cli/json_writer.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::InvalidInput;

void append(std::string& line, double x) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x + 0.0).ptr;
  line.append(digits.data(), end);
}

}  // namespace

std::string column_heading(const std::string& name) {
  return name.find(',') == std::string::npos ? name : "\"" + name + "\"";
}

std::ofstream opened(const std::string& path) {
  if (path == "-")
    throw InvalidInput("- is standard output, which has the report; give the name of a file, or /dev/stderr");
  std::ofstream file(path, std::ios::binary);
  if (!file) throw InvalidInput("cannot write " + path + "; check the folder and its permissions");
  return file;
}

void require_written(std::ofstream& file, const std::string& path) {
  file.close();
  if (!file) throw InvalidInput("cannot write " + path + "; check that the disk has room");
}

std::vector<std::string> constraint_names(const mechanics::System& system) {
  std::vector<std::string> names;
  for (const mechanics::Constraint& constraint : system.constraints()) names.push_back(constraint.name);
  return names;
}

Instants Instants::strobe(double begin, double end, double period) {
  const double periods = std::floor((end - begin) / period * (1 + 4 * convex::unit_roundoff));
  constexpr double most = 1e9;
  if (!(periods < most)) throw InvalidInput("--strobe: more than a billion instants; give a longer period");
  return {begin, end, static_cast<long>(periods) + 1, period};
}

double Instants::operator[](long k) const {
  if (period_ > 0) return std::min(end_, begin_ + static_cast<double>(k) * period_);
  if (k == count_ - 1) return end_;
  return begin_ + (end_ - begin_) * (static_cast<double>(k) / static_cast<double>(count_ - 1));
}

convex::Vector wrapped(convex::Vector q, const convex::Vector& modulo) {
  for (Index i = 0; i < modulo.size(); ++i) {
    if (!(modulo[i] > 0)) continue;
    q[i] = std::fmod(q[i], modulo[i]);
    if (q[i] < 0) q[i] += modulo[i];
  }
  return q;
}

TrajectoryFile::TrajectoryFile(const std::string& path, const mechanics::LagrangianSystem& system,
                               Instants instants, convex::Vector modulo)
    : file_(opened(path)), path_(path), system_(system), instants_(instants), modulo_(std::move(modulo)) {
  std::string line = "t";
  for (const char* mark : {"", "'", "''"})
    for (const std::string& name : system.coordinates()) line += "," + column_heading(name + mark);
  for (const std::string& name : constraint_names(system))
    line += "," + column_heading("lambda[" + name + "]");
  file_ << line << ",energy\n";
}

void TrajectoryFile::write(const mechanics::State& state, const convex::Vector& q2,
                           const convex::Vector& lambda) {
  std::string line;
  append(line, state.t);
  const convex::Vector q = wrapped(state.q, modulo_);
  for (const convex::Vector* numbers : {&q, &state.v, &q2, &lambda})
    for (Index i = 0; i < numbers->size(); ++i) {
      line += ',';
      append(line, (*numbers)[i]);
    }
  line += ',';
  append(line, system_.energy(state));
  file_ << line << '\n';
  ++row_;
}

void TrajectoryFile::follow(const mechanics::Motion& motion) {
  const mechanics::Arc& arc = motion.arc();
  // An instant within rounding of the end of the arc has the state there.
  constexpr double same = 4 * std::numeric_limits<double>::epsilon();
  const double end = motion.state().t, ended = end - same * std::max(std::abs(end), std::abs(arc.t));
  while (row_ < instants_.count() && instants_[row_] < ended) {
    const double tau = std::min(std::max(0.0, instants_[row_] - arc.t), arc.length);
    mechanics::State state = arc.state(tau);
    state.t = instants_[row_];
    write(state, arc.acceleration(tau), arc.multipliers(tau));
  }
}

void TrajectoryFile::finish(const mechanics::Motion& motion) {
  if (motion.acceleration().size() == motion.state().q.size())
    while (row_ < instants_.count() && instants_[row_] <= motion.state().t)
      write(motion.state(), motion.acceleration(), motion.multipliers());
  require_written(file_, path_);
}

EventsFile::EventsFile(const std::string& path, const mechanics::LagrangianSystem& system)
    : file_(opened(path)),
      path_(path),
      coordinates_(system.coordinates()),
      constraints_(constraint_names(system)) {}

void EventsFile::write(const mechanics::MotionEvent& event) {
  JsonWriter json;
  json.begin_object().key("t").value(event.t).key("kind").value(mechanics::name(event.kind));
  json.key("constraints").begin_array();
  for (const Index a : event.constraints) json.value(constraints_[static_cast<std::size_t>(a)]);
  json.end_array();
  json.key("velocity_before").numbers(coordinates_, event.velocity_before);
  json.key("velocity_after").numbers(coordinates_, event.velocity_after);
  file_ << json.end_object().text() << '\n';
}

void EventsFile::finish() { require_written(file_, path_); }

}  // namespace cli
