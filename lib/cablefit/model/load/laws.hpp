// The rows of the table of load laws, one per file. Internal to load.cpp; everybody else goes
// through load_laws().
#pragma once

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/load.hpp"

namespace cablefit::laws {

/// The tau_load column of the log.
LoadLaw column();
/// A torque that never changes.
LoadLaw constant();
/// A mass on a rope around a pulley of the link: direction m g r.
LoadLaw hanging_mass();
/// A mass on a lever: -m g L sin(q - zero).
LoadLaw pendulum();
/// Points of q and torque, linear between.
LoadLaw table();
/// No load at all.
LoadLaw none();

}  // namespace cablefit::laws
