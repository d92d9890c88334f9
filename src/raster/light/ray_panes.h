/* ray_panes.h - transmittances of the triangles of panes (scene/light/pane.h), for rays in shaders (glsl/rays.glsl)
 *
 *   T(cos) = facing (1 - s) + grazing s,  s = schlick_s(cos)
 *
 * exact without a coat, whose own F at the same cosine makes a product of two such terms. Departures: maps and colours of
 * vertices have their mean over the triangle, and the cosine is that to the flat triangle. */
#pragma once

#include "scene/record/scene.h"

/* Sets what a triangle of a mesh that is a pane lets through at normal and at grazing incidence. */
void ray_pane_triangle(const WeftScene *scene, const Mesh *mesh, uint32_t triangle, float facing[3], float grazing[3]);
