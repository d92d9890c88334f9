/* lattice.h - a mesh of points that a function places over the unit square */
#pragma once

#include "scene/record/scene.h"

/* A sheet of (across + 1) (down + 1) points, which `point` places for u and v from 0 to 1, moved by `at`. */
typedef struct Lattice {
    uint32_t across, down;
    Vec3 (*point)(float u, float v);
    bool smooth; /* has normals, by differences */
    Vec3 at;
    float span[2]; /* of its texture coordinates; 0: 1 */
} Lattice;

/* Fills the mesh, whose front is seen where u runs to the right and v down. Returns false if memory is short. */
bool lattice_make(Arena *arena, Mesh *mesh, const Lattice *lattice);
