// Members of the results of a cell, for RecordWriter and RecordReader. A member that is missing
// here is lost in the cell's file: tests/campaign/cell_file_test.cpp compares every output made
// from a result with the one made from its file. Internal to campaign/.
#pragma once

#include "cablefit/campaign/batch.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

template <class Archive>
void fields(Archive& a, InputFile& v) {
  a("path", v.path), a("sha256", v.sha256), a("rows", v.rows);
}

template <class Archive>
void fields(Archive& a, Estimate& v) {
  a("name", v.name), a("symbol", v.symbol), a("unit", v.unit);
  a("value", v.value), a("sd", v.sd), a("sd_white", v.sd_white);
  a("ci_low", v.ci_low), a("ci_high", v.ci_high), a("cad", v.cad);
  a("not_identifiable", v.not_identifiable), a("active_bound", v.active_bound);
  a("profiled", v.profiled);
}

template <class Archive>
void fields(Archive& a, Decision& v) {
  a("name", v.name), a("value", v.value), a("reason", v.reason);
}

template <class Archive>
void fields(Archive& a, RowCounts& v) {
  a("used", v.rows_used), a("at_rest", v.rows_at_rest), a("not_used", v.rows_not_used);
  a("at_edges", v.rows_at_edges);
}

template <class Archive>
void fields(Archive& a, WindowCounts& v) {
  a("read", v.rows_read), a("resampled", v.rows_resampled), a("too_short", v.rows_too_short);
  a("segments", v.segments), a("out", v.rows_out);
}

// Figures

template <class Archive>
void fields(Archive& a, FigureAxis& v) {
  a("title", v.title), a("unit", v.unit), a("logarithmic", v.logarithmic);
}

template <class Archive>
void fields(Archive& a, Trace& v) {
  a("name", v.name), a("style", v.style), a("series", v.series), a("labels", v.labels);
  a.packed("x", v.x), a.packed("y", v.y), a.packed("low", v.low), a.packed("high", v.high);
}

template <class Archive>
void fields(Archive& a, Mark& v) {
  a("x", v.x), a("text", v.text);
}

template <class Archive>
void fields(Archive& a, Note& v) {
  a("x", v.x), a("y", v.y), a("text", v.text);
}

template <class Archive>
void fields(Archive& a, Figure& v) {
  a("section", v.section), a("group", v.group), a("title", v.title), a("caption", v.caption);
  a("x", v.x), a("y", v.y), a("traces", v.traces), a("marks", v.marks), a("notes", v.notes);
  a("wide", v.wide), a("rank", v.rank);
}

// Stage 1

template <class Archive>
void fields(Archive& a, MapParameters& v) {
  a("coefficients", v.coefficients), a("angle", v.angle), a("displacement", v.displacement);
  a("curvature", v.curvature);
}

template <class Archive>
void fields(Archive& a, DisplacementMap& v) {
  a.row("kind", map_kinds(), v.kind);
  a("parameters", v.parameters);
}

template <class Archive>
void fields(Archive& a, PairMap& v) {
  a.row("kind", pair_map_kinds(), v.kind);
  PairParameters& p = v.parameters;
  a("joint_1", v.joints[0]), a("joint_2", v.joints[1]);
  a("angle_1", p.angle[0]), a("angle_2", p.angle[1]), a("values", p.values);
  a("curvature_1", p.curvature[0]), a("curvature_2", p.curvature[1]);
  a("curvature_12", p.curvature[2]), a("from_x", p.from.x()), a("from_y", p.from.y());
  a("to_x", p.to.x()), a("to_y", p.to.y()), a("length", p.length), a("sign", p.sign);
}

template <class Archive>
void fields(Archive& a, Cable& v) {
  a("name", v.name);
  a.row("law", cable_laws(), v.law);
  a("order", v.order), a("toe", v.toe), a("coefficients", v.coefficients);
  a("initial_elongation", v.initial_elongation), a("motor_map", v.motor_map);
  a("link_map", v.link_map), a("motor_pairs", v.motor_pairs), a("link_pairs", v.link_pairs);
  a("reference_displacement", v.reference_displacement);
}

template <class Archive>
void fields(Archive& a, ReferencePose& v) {
  a("q", v.q), a("theta", v.theta);
}

template <class Archive>
void fields(Archive& a, Transmission& v) {
  a("n_joints", v.n_joints), a("cables", v.cables), a("linear_stiffness", v.linear_stiffness);
  a("theta_0", v.theta_0), a("reference", v.reference), a("reduction", v.linear_reduction);
}

template <class Archive>
void fields(Archive& a, ElasticJointErrors& v) {
  a("rms", v.rms_error), a("max", v.max_abs_error);
  a("held_out_rms", v.held_out_rms), a("held_out_max", v.held_out_max);
}

/// Without a proof, which campaigns do not make.
template <class Archive>
void fields(Archive& a, MisfitPoint& v) {
  a("deflection", v.deflection), a("torque", v.torque), a("half_width", v.half_width);
}

template <class Archive>
void fields(Archive& a, ElasticMisfit& v) {
  a("points", v.points);
}

template <class Archive>
void fields(Archive& a, ElasticFit& v) {
  a("model", v.model), a("order", v.order), a("parameters", v.parameters);
  a("transmission", v.transmission), a("offset", v.offset), a("covariance", v.covariance);
  a("rms", v.rms_error), a("max", v.max_abs_error);
  a("held_out_rms", v.held_out_rms), a("held_out_max", v.held_out_max), a("joints", v.joints);
  a("passive", v.passive), a("active_bounds", v.active_bounds), a("condition", v.condition);
  a("effective_rows", v.effective_rows), a("warnings", v.warnings), a("derived", v.derived);
  a("misfit", v.misfit);
}

template <class Archive>
void fields(Archive& a, ModeCounts::Slack& v) {
  a("cable", v.cable), a("rows", v.rows);
}

template <class Archive>
void fields(Archive& a, ModeCounts& v) {
  a("closure", v.closure), a("slack", v.slack);
}

template <class Archive>
void fields(Archive& a, ElasticJoint& v) {
  a("name", v.name), a("low", v.deflection_low), a("high", v.deflection_high);
  a("peak_torque", v.peak_torque), a("loop_half_width", v.loop_half_width);
  a("both_branches", v.both_branches), a("weight", v.weight), a("counts", v.counts);
}

template <class Archive>
void fields(Archive& a, RigFact& v) {
  a("name", v.name), a("value", v.value);
}

/// Without scores and bases, which campaigns do not make.
template <class Archive>
void fields(Archive& a, ElasticPreload& v) {
  a("name", v.name), a("unit", v.unit), a("low", v.deflection_low), a("high", v.deflection_high);
  a("peak_torque", v.peak_torque), a("loop_half_width", v.loop_half_width);
  a("both_branches", v.both_branches), a("joints", v.joints), a("counts", v.counts);
  a("modes", v.modes), a("windows", v.windows), a("fits", v.fits), a("selected", v.selected);
  a("selection", v.selection), a("decisions", v.decisions), a("warnings", v.warnings);
  a("axes", v.axes), a("rig_path", v.rig_path), a("rig_facts", v.rig_facts);
  a("shape_doubt", v.shape_doubt), a("figures", v.figures);
}

template <class Archive>
void fields(Archive& a, ElasticResult& v) {
  a("inputs", v.inputs), a("preloads", v.preloads), a("warnings", v.warnings);
}

// Stage 2

template <class Archive>
void fields(Archive& a, TorqueError& v) {
  a("rms", v.rms), a("max_abs", v.max_abs), a("relative", v.relative);
}

template <class Archive>
void fields(Archive& a, SuspectSpan& v) {
  a("equation", v.equation), a("log", v.log), a("run", v.run), a("from", v.from), a("to", v.to);
  a("largest", v.largest), a("rows", v.n_rows);
}

template <class Archive>
void fields(Archive& a, TracePoint& v) {
  a("rows", v.n_rows), a("record", v.record), a("value", v.value), a("sd", v.sd);
  a("t", v.t);
}

template <class Archive>
void fields(Archive& a, OnlineRule& v) {
  a("method", v.method), a("forgetting", v.forgetting), a("memory", v.memory);
  a("step", v.step), a("slowest", v.slowest);
}

template <class Archive>
void fields(Archive& a, RecursiveTrace& v) {
  a("names", v.names), a("preloads", v.preloads), a("units", v.units), a("points", v.points);
  a("rule", v.rule);
}

template <class Archive>
void fields(Archive& a, ParameterCovariance& v) {
  a("parameters", v.parameters), a("matrix", v.matrix);
}

/// Without a proof and a sweep, which campaigns do not make.
template <class Archive>
void fields(Archive& a, DynamicFit& v) {
  a("model", v.model), a("estimator", v.estimator), a("parameters", v.parameters);
  a("torque_error", v.torque_error), a("weight", v.weight), a("condition", v.condition);
  a("effective_rows", v.effective_rows), a("elastic", v.elastic), a("verdicts", v.verdicts);
  a("warnings", v.warnings), a("sd_reason", v.sd_reason), a("suspects", v.suspects);
  a("traces", v.traces), a("derived", v.derived), a("method_floor", v.method_floor);
  a("covariance", v.covariance);
  a("estimator_difference", v.estimator_difference), a("stage1_misfit", v.stage1_misfit);
}

template <class Archive>
void fields(Archive& a, TorqueDelay& v) {
  a("seconds", v.seconds), a("sd", v.sd), a("estimated", v.estimated), a("held", v.held);
  a("reason", v.reason), a("warning", v.warning);
}

template <class Archive>
void fields(Archive& a, ConditionError& v) {
  a("condition", v.condition), a("value", v.value), a("rows", v.n_rows);
  a("rms", v.rms), a("mean", v.mean), a("max_abs", v.max_abs), a("relative", v.relative);
  a("zero", v.zero), a("linear", v.linear), a("fitted", v.fitted), a("fails", v.fails);
  a("floor", v.floor), a("verdict", v.verdict);
}

template <class Archive>
void fields(Archive& a, ResidualTest& v) {
  a("name", v.name), a("statistic", v.statistic), a("value", v.value), a("p_value", v.p_value);
  a("structure", v.structure), a("finding", v.finding), a("verdict", v.verdict);
}

template <class Archive>
void fields(Archive& a, WindowMean& v) {
  a("seconds", v.seconds), a("sd", v.sd);
}

template <class Archive>
void fields(Archive& a, JudgedEquation& v) {
  a("model", v.model), a("equation", v.equation), a("noise_floor", v.noise_floor);
  a("floor_source", v.floor_source), a("conditions", v.conditions), a("tests", v.tests);
  a("means", v.means);
}

template <class Archive>
void fields(Archive& a, Validation& v) {
  a("logs", v.logs), a("linear_name", v.linear_name), a("equations", v.equations);
}

template <class Archive>
void fields(Archive& a, DynamicPreload& v) {
  a("name", v.name), a("axes", v.axes), a("resonance", v.resonance);
  a("load_inertia", v.load_inertia), a("delay", v.delay), a("counts", v.counts);
  a("windows", v.windows), a("decisions", v.decisions), a("fits", v.fits);
  a("warnings", v.warnings), a("rig_path", v.rig_path), a("figures", v.figures);
  a("residual_tests", v.residual_tests), a("validation", v.validation);
}

template <class Archive>
void fields(Archive& a, DynamicResult& v) {
  a("inputs", v.inputs), a("preloads", v.preloads), a("warnings", v.warnings);
}

// Refine

template <class Archive>
void fields(Archive& a, GapStory& v) {
  a("train_before", v.train_before), a("train_after", v.train_after);
  a("test_before", v.test_before), a("test_after", v.test_after), a("noise_floor", v.noise_floor);
  a("before_low", v.test_before_ci[0]), a("before_high", v.test_before_ci[1]);
  a("after_low", v.test_after_ci[0]), a("after_high", v.test_after_ci[1]), a("known", v.known);
}

template <class Archive>
void fields(Archive& a, CellEffect& v) {
  a("name", v.name), a("side", v.side), a("gain", v.gain), a("p_value", v.p_value);
  a("torque_rms", v.torque_rms), a("rivals", v.rivals);
}

template <class Archive>
void fields(Archive& a, CellRefine& v) {
  a("verdict", v.verdict), a("reason", v.reason), a("effects", v.effects), a("torque", v.torque);
  a("simulation", v.simulation), a("next_experiment", v.next_experiment), a("error", v.error);
}

template <class Archive>
void fields(Archive& a, CellResults& v) {
  a("elastic", v.elastic), a("dynamic", v.dynamic), a("refine", v.refine);
}

}  // namespace cablefit
