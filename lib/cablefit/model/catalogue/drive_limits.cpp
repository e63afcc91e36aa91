#include <algorithm>

#include "cablefit/model/catalogue/rows.hpp"

// What the drive makes of a command, where the log holds the command.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kLimit[] = {{"limit", "T", "N m", "largest torque that acts", 0}};
constexpr ParameterInfo kBand[] = {{"band", "b", "N m", "largest command without effect", 0}};

// Nearer to the peak a limit shows in a few rows only, further down it is no limit any more: what
// clips most rows makes them a constant, which any model explains.
constexpr ShapeGrid kLimits[] = {{.low = 0.4,
                                  .high = 0.99,
                                  .n_values = 13,
                                  .is_geometric = false,
                                  .unit = GridUnit::peak,
                                  .is_rare = true}};
// A band near the peak leaves no torque to explain, which any model does.
constexpr ShapeGrid kBands[] = {
    {.low = 7e-4, .high = 0.05, .n_values = 10, .unit = GridUnit::peak}};

void clip(const double* parameters, Recording& recording) {
  recording.tau = recording.tau.min(parameters[0]).max(-parameters[0]);
}

void lose_band(const double* parameters, Recording& recording) {
  recording.tau -= recording.tau.min(parameters[0]).max(-parameters[0]);
}

}  // namespace

Effect saturation() {
  return {.name = "saturation",
          .site = Site::drive,
          .equation = "true tau = logged tau, clipped at +-T",
          .signature =
              "a residual in the motor equation above a certain torque, none below; a low "
              "limit is similar to a torque gain",
          .experiment = "the same motion with a lighter load, so that the command stays low",
          .source = "a limit of the drive, where the log holds the command",
          .parameters = kLimit,
          .shape = kLimits,
          .correct = clip};
}

Effect drive_dead_band() {
  return {.name = "drive_dead_band",
          .site = Site::drive,
          .equation = "true tau = logged tau less b towards 0, 0 below",
          .signature =
              "a constant that changes sign with the torque, in the motor equation only; dry "
              "friction changes sign with speed",
          .experiment = "loads of both signs, each in both directions",
          .source = "a dead band of the drive, where the log holds the command",
          .parameters = kBand,
          .shape = kBands,
          .correct = lose_band};
}

}  // namespace cablefit::rows
