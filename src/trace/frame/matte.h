/* matte.h - which objects and materials a pixel shows, as Cryptomatte stores them
 *
 * Jonah Friedman, Andrew C. Jones, "Fully Automatic ID Mattes with Support for Motion Blur and Transparency", SIGGRAPH
 * 2015 posters; Psyop, "Cryptomatte Specification", version 1.2.0, 2018. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "scene/record/scene.h"

enum { MATTE_IDS = 8, MATTE_RANKS = 6 };

/* The ids of a pixel, and how many samples met each. Samples beyond MATTE_IDS ids are left out. */
typedef struct Matte {
    uint32_t id[MATTE_IDS];
    uint32_t samples[MATTE_IDS]; /* 0: the entry is free, as are those behind it */
} Matte;

/* Returns the name by which an object is known: its mesh's, or "unnamed". */
static inline const char *matte_object(const WeftScene *scene, int mesh) {
    return *scene->meshes[mesh].name ? scene->meshes[mesh].name : "unnamed";
}

/* Returns that of a material; polygon lights have materials without names, hair that of its cloth. */
static inline const char *matte_material(const WeftScene *scene, int material) {
    material = scene_grown_from(scene, material);
    if (material >= scene_light_materials(scene)) return "light";
    return *scene->material_names[material] ? scene->material_names[material] : "unnamed";
}

/* Returns the id of a name: MurmurHash3_x86_32 with seed 0 (Austin Appleby, 2011), with a bit inverted where a float of
 * these bits would be 0, denormal, infinite or NaN. */
uint32_t matte_id(const char *name);

/* Returns the plain hash, of which a layer's key is made. */
uint32_t matte_hash(const char *name);

void matte_add(Matte *matte, uint32_t id);

/* Fills `ranks` with id, as a float, and coverage of MATTE_RANKS entries, the largest coverage first; of equal ones the
 * smaller id. */
void matte_rank(const Matte *matte, int samples, float ranks[2 * MATTE_RANKS]);

/* Returns a JSON object of names and their ids in hexadecimal, to be released with free; NULL where memory is short. */
char *matte_manifest(const char *const *names, int count);
