#include "cablefit/simulate/trajectory_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace cablefit {
namespace {

template <typename... Values>
void append(std::string* line, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(*line), format, std::forward<Values>(values)...);
}

/// A name as a CSV cell or part of one.
std::string without_commas(std::string name) {
  for (char& c : name) {
    if (c == ',' || c == '"' || c == '\n' || c == '\r') c = '_';
  }
  return name;
}

}  // namespace

TrajectoryFile::TrajectoryFile(const std::string& path, const Model& model, bool with_band)
    : file_(path), n_joints_(model.rig.n_joints()), with_band_(with_band) {
  for (const Cable& cable : model.transmission.cables) {
    if (!model.rigid) cables_.push_back(without_commas(cable.name));
  }
  write_header();
}

void TrajectoryFile::write_header() {
  line_ = "log,start,t";
  for (const char* suffix : {"", "_sim", "_band"}) {
    if (!with_band_ && suffix == std::string_view("_band")) continue;
    for (const char* signal : {"q", "theta", "tau"}) {
      for (Eigen::Index k = 1; k <= n_joints_; ++k) {
        append(&line_, ",{}{}{}", signal, n_joints_ > 1 ? std::to_string(k) : "", suffix);
      }
    }
  }
  for (const std::string& cable : cables_) append(&line_, ",tension[{}]", cable);
  if (!cables_.empty()) line_ += ",closure";
  file_.append(line_ + "\n");
}

void TrajectoryFile::add(std::size_t log, const ReplayedRows& rows) {
  for (Eigen::Index row = 0; row < rows.simulated.theta.rows(); ++row) add_row(log, rows, row);
}

void TrajectoryFile::add_row(std::size_t log, const ReplayedRows& rows, Eigen::Index row) {
  line_.clear();
  append(&line_, "{},{},{:.15g}", log, rows.start,
         rows.t0 + static_cast<double>(row) * rows.period);
  const SimulationResult& s = rows.simulated;
  for (const Eigen::ArrayXXd* table : {&rows.q, &rows.theta, &rows.tau, &s.q, &s.theta, &s.tau}) {
    add_cells(*table, row);
  }
  if (with_band_)
    for (const Eigen::ArrayXXd* table : {&rows.band.q, &rows.band.theta, &rows.band.tau})
      add_cells(*table, row);
  if (!cables_.empty()) add_tensions(s.tension, row);
  line_ += '\n';
  file_.append(line_);
}

void TrajectoryFile::add_cells(const Eigen::ArrayXXd& table, Eigen::Index row) {
  for (Eigen::Index k = 0; k < n_joints_; ++k) {
    line_ += ',';
    if (k < table.cols()) append(&line_, "{:.9g}", table(row, k));
  }
}

void TrajectoryFile::add_tensions(const Eigen::ArrayXXd& tension, Eigen::Index row) {
  std::string slack;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    const double force = tension(row, static_cast<Eigen::Index>(i));
    append(&line_, ",{:.9g}", force);
    if (!(force > 0)) slack += (slack.empty() ? "" : "+") + cables_[i];
  }
  line_ += slack.empty() ? ",closure" : ",slack:" + slack;
}

}  // namespace cablefit
