/* fit_files.h - a fitted material as a file: a material, an asset or engine text */
#pragma once

#include "cli/console/options.h"
#include "weft/weft.h"

/* Tests that every -o names a supported kind of file and a place that can be written. Returns 0, or an exit code
 * after one line on standard error. */
int fit_files_check(const Options *options);

/* Writes the material into every -o: .json, .glb or .gltf (a cloth of it), .glsl, .hlsl, .wgsl or .h. Returns
 * as fit_files_check. */
int fit_files_write(const Options *options, const WeftMaterial *material);
