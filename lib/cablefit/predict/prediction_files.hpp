// What is predicted, row by row, as CSV. Internal to predict/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/files/streamed_file.hpp"
#include "cablefit/predict/elastic_prediction.hpp"
#include "cablefit/predict/equation_residuals.hpp"

namespace cablefit {

/// Columns, SI: log (number, from 1), t, every elastic signal, and with a band its half widths
/// NAME_band.
class ElasticFile {
 public:
  ElasticFile(const std::string& path, const ElasticPrediction& prediction);
  void add(std::size_t log, double t0, double period, const ElasticPrediction::Rows& rows);
  void finish() { file_.finish(); }

 private:
  StreamedFile file_;
  std::string text_;
};

/// Columns, SI: log (number, from 1), t, equation ("link", "motor", of several joints "link[2]"),
/// torque (as logged), model (the torque that the model predicts).
class SensedFile {
 public:
  explicit SensedFile(const std::string& path);
  void add(std::size_t log, const std::string& equation, const ResidualRows& rows);
  void finish() { file_.finish(); }

 private:
  StreamedFile file_;
  std::string text_;
};

}  // namespace cablefit
