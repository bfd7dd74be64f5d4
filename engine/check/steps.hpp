// SPDX-License-Identifier: Apache-2.0
// The steps, one function each; their names and order are in steps.cpp.
#pragma once

#include "check/subject.hpp"

namespace restage::check {

// steps_plugin.cpp
Result<StepResult> check_manifest(Subject&);
Result<StepResult> check_load(Subject&);
Result<StepResult> check_reload(Subject&);
// steps_importer.cpp
Result<StepResult> check_probe(Subject&);
Result<StepResult> check_read(Subject&);
Result<StepResult> check_read_options(Subject&);
Result<StepResult> check_read_cut(Subject&);
Result<StepResult> check_read_stop(Subject&);
Result<StepResult> check_read_leaks(Subject&);
// steps_exporter.cpp
Result<StepResult> check_write(Subject&);
// steps_sky.cpp
Result<StepResult> check_sky(Subject&);
Result<StepResult> check_sky_params(Subject&);
Result<StepResult> check_sky_stop(Subject&);
Result<StepResult> check_sky_runs(Subject&);
// steps_exporter_stop.cpp
Result<StepResult> check_write_stop(Subject&);
Result<StepResult> check_write_place(Subject&);
Result<StepResult> check_write_leaks(Subject&);
// steps_roundtrip.cpp
Result<StepResult> check_roundtrip(Subject&);
// steps_denoiser.cpp
Result<StepResult> check_denoise(Subject&);
Result<StepResult> check_denoise_sizes(Subject&);
Result<StepResult> check_denoise_robust(Subject&);
Result<StepResult> check_denoise_leaks(Subject&);
// steps_inspector.cpp
Result<StepResult> check_inspector(Subject&);
Result<StepResult> check_tables(Subject&);
// steps_action.cpp
Result<StepResult> check_act(Subject&);
Result<StepResult> check_act_stop(Subject&);
Result<StepResult> check_act_leaks(Subject&);
Result<StepResult> check_panel(Subject&);
// steps_glsl.cpp
Result<StepResult> check_glsl(Subject&);
Result<StepResult> check_names(Subject&);
Result<StepResult> check_cost(Subject&);
// Whether all names in the plugin's compiled files begin with its prefix.
Result<StepResult> check_names_in(const Subject&, const gpu::Spirv&, const std::string& prefix,
                                  const std::string& glsl_file);
// steps_texture.cpp
Result<StepResult> check_texture_glsl(Subject&);
Result<StepResult> check_texture_names(Subject&);
Result<StepResult> check_texture_values(Subject&);
Result<StepResult> check_texture_params(Subject&);
Result<StepResult> check_texture_native(Subject&);
// steps_params.cpp
Result<StepResult> check_params(Subject&);
// steps_sound.cpp
Result<StepResult> check_sound(Subject&);
// steps_density.cpp
Result<StepResult> check_chi_square(Subject&);
Result<StepResult> check_integral(Subject&);
Result<StepResult> check_reach(Subject&);
Result<StepResult> check_weight(Subject&);
// steps_expectation.cpp
Result<StepResult> check_expectation(Subject&);
Result<StepResult> check_mean_reciprocity(Subject&); // check_reciprocity for stochastic materials
// steps_energy.cpp
Result<StepResult> check_energy(Subject&);
Result<StepResult> check_furnace(Subject&);
Result<StepResult> check_albedo(Subject&);
// steps_symmetry.cpp
Result<StepResult> check_reciprocity(Subject&);
Result<StepResult> check_isotropy(Subject&);
Result<StepResult> check_limit(Subject&);

} // namespace restage::check
