// Includes everything that a program needs to fit logs with this library. Headers that this file
// does not reach are not installed.
//
//   logs      read_logs() from files, survey_memory() from arrays; a Rig describes their bench
//   stages    stiffness() -> dynamics(); identify() for both in one step
//   answers   missing_effects(): where model and logs disagree, and which effect is missing
//   all       study(): every stage that the logs allow
//   model     read_model(), model_json(); add_effect() for an effect of your own
//   simulate  simulate()
//
// All quantities are SI on the joint side. Wrong input throws Error (base/error.hpp). A parameter
// that a fit cannot determine is a result with its reason. Results are the same to the last bit for
// any number of threads.
#pragma once

#include "cablefit/base/error.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/samples/check.hpp"
#include "cablefit/samples/survey/memory_log.hpp"
#include "cablefit/session/read_logs.hpp"
#include "cablefit/session/stages.hpp"
#include "cablefit/session/study.hpp"
#include "cablefit/simulate/simulator.hpp"
#include "cablefit/version.hpp"
