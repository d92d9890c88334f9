/* dispatch.h - lobes in a text, by id: each alone, or all behind one signature */
#pragma once

#include "text/assemble/text.h"

#include "shading/catalogue/outside.h"
#include "shading/catalogue/registry.h"
#include "shading/material/material_stack.h"

/* Includes a lobe's file. A lobe with TRAIT_TABLE reads weft_tables, so it needs TextDesc.tables (see tables.h). */
void text_lobe(Text *text, int id);

/* Returns true if the lobe's Fresnel weight may be a cosine (shading/lobe/fresnel_weight.h). */
bool text_weight_is_cosine(int id);

/* Writes lobes behind one signature, in place of registry.h, which has them for C; call it once:
 *
 *   const int LOBE_GGX = ..., GGX_ANISOTROPY = ...;
 *   Lobe, LobeValue                                    lobe.h
 *   LobePrepared, LobeView, lobe_prepare, lobe_view, lobe_value_at, lobe_sample_at
 *   lobe_default, lobe_rough, lobe_fibres, lobe_value, lobe_sample, lobe_second
 *
 * and f, s and pdf of lobe_value alone as lobe_f, lobe_fresnel_weight and lobe_pdf. For another lobe lobe_value is 0,
 * lobe_second is f0, and there is no sample. A surface (compose.h) names LOBE_LAMBERT and LOBE_GGX even if its profile
 * replaces them, DUST_LOBE if it has dust, which is not drawn without that lobe, and a highlight whose terms it
 * replaces. */
void text_dispatch(Text *text, const int *lobes, int lobe_count);

/* The lobes that a slot of a stack may have. */
typedef struct TextSlot {
    int lobes[LOBE_MOST];
    int count;
} TextSlot;

/* Writes the records and functions of shading/stack/slots.h for each slot, in the order of SLOTS, with only these
 * lobes, and if `sampled` those of stack_sample.h too. Call it once, after text_dispatch, which has all of them. */
void text_slots(Text *text, const TextSlot slots[SLOT_COUNT], bool sampled);
