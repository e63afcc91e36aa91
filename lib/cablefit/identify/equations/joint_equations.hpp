// The equations of the one-step identification as columns: blocked link, moving link and motor of
// every joint of one preload, under many choices of the initial elongations in one pass over the
// logs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/elastic/rows/elongation_range.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// One torque balance, response = W_own x + sign * (P or S) Phi k, with the columns that do not
/// depend on l_o in front: (26), with the sign of (14a) for the link (-P Phi, missing in (27)).
struct JointEquation {
  struct Own {
    std::string name;         ///< "J_motor", as in results
    Eigen::Index column = 0;  ///< of `base`
  };
  /// An inertia that the rig file gives: its torque is known.
  struct Given {
    DynamicParameter parameter;
    Eigen::Index column = 0;  ///< of `base`
  };
  Equation base;
  std::vector<Own> own;
  std::vector<Given> given = {};
  std::vector<DynamicParameter> added = {};  ///< those of `own` beyond (31)
  Eigen::Index response = 0;                 ///< column of `base`: tau or tau_load
  bool motor_side = true;                    ///< S Phi with sign +1, else P Phi with sign -1
  bool blocked = false;                      ///< of logs in which the links are held
  int joint = 0;                             ///< whose torques balance, from 0
  SearchedRadii searched_radius = {};        ///< of the rig; where any, JointColumns::turn

  Eigen::Index n_base() const { return static_cast<Eigen::Index>(base.columns.size()); }
  double sign() const { return motor_side ? 1.0 : -1.0; }
};

/// Friction of a blocked sweep is one of its own: near standstill it is not that of fast motion,
/// and what a sweep this slow shows of speed (10 sd off on simulated rigs) only keeps out of f_sm.
inline constexpr const char* kBlockedFriction = "f_sm_blocked";  ///< beside the f_sm of moving logs
inline constexpr const char* kCreep = "f_vm_blocked";            ///< not reported

/// Place of the columns of one choice of l_o in its RowStatistics: those of `base`, the deflection,
/// a basis column per coefficient, its derivative with respect to l, and, where a motor radius r_m
/// is searched, with respect to ln r_m of its cable.
struct JointColumns {
  Eigen::Index deflection = 0, basis = 0, slope = 0, turn = 0, count = 0;
};
JointColumns joint_columns(const JointEquation& equation, Eigen::Index n_coefficients);

/// The equation with all those columns.
Equation equation_at(const JointEquation& equation, const Transmission& cables);

/// Logs of one preload and one kind (blocked or moving), read with the same settings.
struct JointRecord {
  PartFilter wanted;
  RowSettings settings;
  std::vector<JointEquation> equations;
};

/// One preload on its way through the fit.
struct PreloadJob {
  std::string name;
  Transmission transmission;           ///< l_o as known or as a first guess
  std::vector<bool> searched;          ///< per cable: l_o is not known
  SearchedRadii searched_radius = {};  ///< the transmission has r_m as found so far
  bool cable_space = false;            ///< coefficients are those of cables, not of the joint
  JointAxes axes;
  double load_inertia = 0;   ///< rides on the link, kg m^2; known, beside the J_link looked for
  const Arm* arm = nullptr;  ///< of several joints; nullptr: the links do not move each other
  std::vector<JointRecord> records;

  int n_joints() const { return transmission.n_joints; }
};

/// What the pass found for one equation, whatever l_o is.
struct EquationFacts {
  RowCounts counts;
  double deflection_low = kUnbounded, deflection_high = -kUnbounded;
  std::vector<ElongationRange> displacements;  ///< per cable, l - l_o

  EquationFacts& operator+=(const EquationFacts& other);
};

/// rows[trial][equation], equations of all records one after the other.
struct JointRows {
  std::vector<std::vector<RowStatistics>> rows;
  std::vector<EquationFacts> facts;  ///< per equation
};

/// One pass over the logs of the preload. `elongations`: per trial l_o of every cable.
JointRows collect(std::span<const LogSurvey> logs, const PreloadJob& job,
                  const std::vector<Eigen::VectorXd>& elongations, bool with_cells, int threads);

/// Some motor radius is not known.
bool searches_radius(const SearchedRadii& searched);
bool searches_radius(const PreloadJob& job);

/// The transmission with these initial elongations.
Transmission with_elongations(Transmission transmission, const Eigen::VectorXd& l_o);
Eigen::VectorXd elongations_of(const Transmission& transmission);

}  // namespace cablefit
