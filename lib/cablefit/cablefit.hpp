// The front door: everything that a program needs to fit logs with this library. What these headers
// do not reach is not installed.
//
//   logs      read_logs() from files, survey_memory() from arrays; a Rig says what they are of
//   stages    stiffness() -> dynamics(); identify() for both in one step
//   answers   missing_effects(): where model and logs disagree, and which effect is missing
//   all       study(): every stage that the logs allow
//   model     read_model(), model_json(); add_effect() for an effect of your own
//   simulate  simulate()
//
// All quantities are SI on the joint side. What is wrong with the input is thrown as Error
// (base/error.hpp); what a fit cannot determine is a result with its reason, not an exception.
// Results are the same to the last bit for any number of threads.
#pragma once

#include "cablefit/base/error.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/check.hpp"
#include "cablefit/samples/survey/memory_log.hpp"
#include "cablefit/session/read_logs.hpp"
#include "cablefit/session/stages.hpp"
#include "cablefit/session/study.hpp"
#include "cablefit/simulate/simulator.hpp"
#include "cablefit/version.hpp"
