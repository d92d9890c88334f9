/* dispatch.h - lobes in a text, by id: each alone, or all behind one signature */
#ifndef WEFT_TEXT_DISPATCH_H
#define WEFT_TEXT_DISPATCH_H

#include "text/text.h"

#include "shading/registry.h"

/* The lobe's file. One with TRAIT_TABLE reads weft_tables, so it needs TextDesc.tables (see tables.h). */
void text_lobe(Text *text, int id);

/* The lobes behind one signature, as registry.h has them for C, whose place this takes; call it once:
 *
 *   struct Lobe { int id; float params[8]; };
 *   const int LOBE_GGX = ...;                          as in C
 *   struct LobeValue { float f, s, pdf; Tint tint; };  lobe_value.h
 *   Lobe lobe_default(int id)                          as in C; likewise
 *   Lobe lobe_rough(int id, float roughness)
 *   Lobe lobe_fibres(Lobe m, float density, float tilt, float azimuth)
 *   LobeValue lobe_at(Lobe m, Angles a)
 *   float lobe_second(Lobe m, float f0, float f90)
 *   Dir lobe_sample(Lobe m, Dir o, float u, float v)
 *
 * and f, s and pdf of lobe_at alone as lobe_f, lobe_share and lobe_pdf. Of a lobe that is not among these,
 * lobe_at is 0, lobe_second is f0, and there is no sample. A surface (compose.h) asks for LOBE_LAMBERT and
 * LOBE_GGX even where its profile then takes others in their place; and for LOBE_LTC_FIBRE where it has dust,
 * of which nothing is seen without. */
void text_dispatch(Text *text, const int *lobes, int lobe_count);

/* The lobes that a slot of a stack may hold. */
enum { TEXT_SLOTS = 4 };
typedef struct TextSlot {
    int lobes[LOBE_COUNT];
    int count;
} TextSlot;

/* In place of shading/slots.h: functions for the diffuse, specular, sheen and coat slot that know only these
 * lobes, and no pdf. Call it once, behind text_dispatch, which has all of them. */
void text_slots(Text *text, const TextSlot slots[TEXT_SLOTS]);

#endif
