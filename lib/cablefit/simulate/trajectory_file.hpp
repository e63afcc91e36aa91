// Measured and simulated trajectories, row by row, as CSV. Internal to simulate/.
#pragma once

#include <string>

#include "cablefit/base/files/streamed_file.hpp"
#include "cablefit/simulate/part_replay.hpp"

namespace cablefit {

/// Columns, SI: log (number of the log, from 1), start (number of the start from a measured state
/// within it, from 1), t; q, theta, tau as measured; q_sim, theta_sim, tau_sim; of a
/// band its half widths q_band, theta_band, tau_band; tension[NAME] per
/// cable and closure: "closure" when all cables are taut, else "slack:" and the names of those that
/// are not. With several joints q1, q2, ... Cells of a channel that the log lacks are empty.
class TrajectoryFile {
 public:
  TrajectoryFile(const std::string& path, const Model& model, bool with_band = false);
  void add(std::size_t log, const ReplayedRows& rows);
  void finish() { file_.finish(); }

 private:
  void write_header();
  void add_row(std::size_t log, const ReplayedRows& rows, Eigen::Index row);
  void add_cells(const Eigen::ArrayXXd& table, Eigen::Index row);
  void add_tensions(const Eigen::ArrayXXd& tension, Eigen::Index row);

  StreamedFile file_;
  std::string line_;
  Eigen::Index n_joints_;
  bool with_band_;
  std::vector<std::string> cables_;
};

}  // namespace cablefit
