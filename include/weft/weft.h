/* weft.h - all of the library
 *
 * libweft is a C library: a catalogue of cloth shading models with eval, sample, pdf and albedo of each,
 * tables of them, scenes and their materials, a path tracer and a rasteriser, and measurements of all of these.
 *
 *     WeftLobe lobe;
 *     float f[3];
 *     if (weft_lobe_init("charlie-neubelt", &lobe, &error) != WEFT_OK) return error.result;
 *     weft_lobe_eval(&lobe, wo, wi, f);
 *
 * Each header covers one subject and gives shapes, units, ranges, ownership and failures. These rules hold for all:
 *
 * - A call that can fail returns a WeftResult and fills a WeftError; result.h lists all reasons.
 * - Descriptors are structs where zero means default: name what differs, as in (WeftRenderDesc){.width = 640}.
 * - A call named _create, _load or _read fills a handle, which the _free beside it releases; _open has a _close.
 *   A call named _init fills a value that owns nothing.
 * - Only two calls change what others compute, for the whole process: weft_lobe_load adds a lobe, weft_isa_use picks
 *   the instructions. Tables that lobes and profiles read are global too, and made under a lock on first use.
 *   Different objects may be used from different threads at the same time.
 * - Directions, units and colours are those that lobe.h states; world space that of scene.h. */
#ifndef WEFT_H
#define WEFT_H

#include "weft/arrays.h"
#include "weft/bake.h"
#include "weft/chart.h"
#include "weft/deliver.h"
#include "weft/diff.h"
#include "weft/doctor.h"
#include "weft/export.h"
#include "weft/fit.h"
#include "weft/image.h"
#include "weft/isa.h"
#include "weft/judge.h"
#include "weft/lobe.h"
#include "weft/loss.h"
#include "weft/ltc.h"
#include "weft/match.h"
#include "weft/material.h"
#include "weft/measure.h"
#include "weft/part.h"
#include "weft/pick.h"
#include "weft/plot.h"
#include "weft/progress.h"
#include "weft/raster.h"
#include "weft/reflection.h"
#include "weft/render.h"
#include "weft/result.h"
#include "weft/root.h"
#include "weft/save.h"
#include "weft/scene.h"
#include "weft/sheet.h"
#include "weft/version.h"
#include "weft/weave.h"

#endif
