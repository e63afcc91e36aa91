// Where the motor torque comes from: the log's column, or the rig's position controller. Internal
// to the simulator.
#pragma once

#include <vector>

#include "cablefit/simulate/acting_torque.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

/// Steps per row of the input, and the time one takes.
struct Clock {
  Eigen::Index steps_per_row;
  double h;  ///< s
};

/// The steps for `options.step`. In closed loop there are a few more when only then the
/// controller's period is a whole number of steps.
Clock make_clock(const Model& model, const SimulationInput& input,
                 const SimulationOptions& options);

/// Row `row` of a table, `fraction` (0 .. 1) of the way to the next; the last row is held.
double between_rows(const Eigen::ArrayXXd& table, Eigen::Index row, double fraction,
                    Eigen::Index joint);

class Drive {
 public:
  virtual ~Drive() = default;
  /// The rows that follow are those of `block`, which must live until end().
  virtual void begin(const SimulationInput& block) = 0;
  /// The next block begins `n_rows` rows after this one.
  virtual void end(Eigen::Index n_rows) = 0;
  /// Torque per joint (N m) over the step `step` of row `row`, given the motor positions before it.
  virtual const std::vector<double>& torque(Eigen::Index row, Eigen::Index step,
                                            const std::vector<double>& theta) = 0;
  /// Torque per joint (N m) at the very beginning of row `row`, for the record.
  virtual const std::vector<double>& torque_at(Eigen::Index row,
                                               const std::vector<double>& theta) = 0;
};

/// The torque of the log, held over a row or linear between rows.
class ReplayDrive final : public Drive {
 public:
  ReplayDrive(const Model& model, const SimulationOptions& options, const Clock& clock);
  void begin(const SimulationInput& block) override { block_ = &block; }
  void end(Eigen::Index /*n_rows*/) override { block_ = nullptr; }
  const std::vector<double>& torque(Eigen::Index row, Eigen::Index step,
                                    const std::vector<double>& theta) override;
  const std::vector<double>& torque_at(Eigen::Index row, const std::vector<double>& theta) override;

 private:
  const std::vector<double>& interpolate(Eigen::Index row, double fraction);

  const SimulationInput* block_ = nullptr;
  bool hold_;
  double steps_per_row_;
  std::vector<double> tau_;
};

/// The rig's controller on the quantised motor position, see Controller. The torque is held over
/// its period. Its first difference is that of a start at the initial velocity.
class ControllerDrive final : public Drive {
 public:
  ControllerDrive(const Model& model, const SimulationInput& start, const Clock& clock);
  void begin(const SimulationInput& block) override { block_ = &block; }
  void end(Eigen::Index n_rows) override;
  const std::vector<double>& torque(Eigen::Index row, Eigen::Index step,
                                    const std::vector<double>& theta) override;
  /// The command, which a drive may not follow.
  const std::vector<double>& torque_at(Eigen::Index row,
                                       const std::vector<double>& theta) override {
    (void)torque(row, 0, theta);
    return tau_;
  }

 private:
  void command(Eigen::Index row, Eigen::Index step, const std::vector<double>& theta);
  double measured(double theta, std::size_t joint) const;

  const SimulationInput* block_ = nullptr;
  Controller controller_;
  double period_, steps_per_row_, steps_per_command_;
  double n_commands_ = 0;
  double next_command_ = 0;      ///< step of the next, counted from the first row
  double rows_before_ = 0;       ///< of the present block
  std::vector<double> quantum_;  ///< rad; 0: none
  struct Memory {
    double error = 0, reference = 0, reference_rate = 0;  ///< at the last command
    double integral = 0;                                  ///< of the error, rad s
    double first_reference = 0;
  };
  std::vector<Memory> memory_;  ///< per joint
  std::vector<double> tau_;
  ActingTorque drive_;
};

}  // namespace cablefit
