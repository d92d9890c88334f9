/* light_visibility.glsl - the visibility of the sky and of the environment's lights, of which there are eight
 * (raster/geometry/occlusion.h) */
#include "shading/ambient/occlusion_cone.h"
#include "raster/glsl/horizon.glsl"

in highp vec3 vertex_occlusion; /* of the sky, from front and back; 1 if no rays were traced, else 0 */
in highp vec4 vertex_open_front;
in highp vec4 vertex_open_back;
in highp vec4 vertex_lights_0;
in highp vec4 vertex_lights_1;

/* Visible fraction of the sky by the occlusion texture. */
float texture_occlusion = 1.0;

/* Sets the fraction. A texture holds what its author's program found of the same creases that rays find, often with a
 * floor that is not there; the path tracer has no use for it either. So it counts until there are values of rays. */
void occlude_by_texture(float occlusion) { texture_occlusion = mix(1.0, occlusion, vertex_occlusion.z); }

vec4 fragment_open() { return gl_FrontFacing ? vertex_open_front : vertex_open_back; }

/* Returns the fraction of the light about d that lies above a plane: half of it where the cosine to the plane's normal
 * is 0. width: half the cosine that the light spans. */
float above_plane(float cosine, float width) { return clamp(0.5 + 0.5 * cosine / width, 0.0, 1.0); }

/* Returns the fraction of the light about d, of what the shading normal sees, that comes from one side of the smooth
 * surface, as the path tracer counts it: side 1 is above, -1 behind. Without a map the two are one plane. */
float beside_smooth(Frame f, Dir d, float width, float side) {
    float smooth_part = above_plane(side * dir_dot(d, smooth_normal), width);
    float part = above_plane(side * dir_dot(d, f.z), width);
    return smooth_part < part ? smooth_part / part : 1.0;
}

/* Returns the factor by which a ramp is steepened for a filter of concentration kappa. A vertex has its visibility as a
 * ramp over directions, near a least-squares fit, which for an edge that hides half of the sky has slope 3/4. A filter
 * of that kappa shows the edge with slope sqrt(kappa / (2 pi)). The factor is greater for steeper ramps, since a level
 * ramp has no edge, and limited to that of the narrowest look-ups, since the edge lies elsewhere at the next vertex.
 * The steepened ramp does not preserve the total light of the rays. */
float steepness(vec3 slope, float kappa) {
    float edge = min(length(slope) / 0.75, 1.0);
    return mix(1.0, clamp(0.532 * sqrt(kappa), 1.0, 1.88), edge);
}

float ambient_sky_visibility(Frame f, Dir w, float kappa, float cos_i, float occlusion) {
    vec4 c = fragment_open();
    Dir d = frame_from(f, w);
    float ramp = c.x + c.y * d.x + c.z * d.y + c.w * d.z;
    float seen = clamp(0.5 + steepness(c.yzw, kappa) * (ramp - 0.5), 0.0, 1.0);
    return min(seen * beside_smooth(f, d, clamp(inversesqrt(kappa), 0.02, 1.0), 1.0), occlusion_cone(texture_occlusion, cos_i));
}

/* Returns direction w deflected towards the visible sky. A Gaussian of variance 1 / kappa times V = open + c . x has
 * its mean at c / (kappa open); with V clamped to 0 and 1, at most one standard deviation away. In a moving picture it is
 * w. */
#ifdef COARSE
Dir ambient_bent_direction(Frame f, Dir w, float kappa, float open) { return w; }
#else
Dir ambient_bent_direction(Frame f, Dir w, float kappa, float open) {
    vec3 c = fragment_open().yzw;
    c *= steepness(c, kappa);
    Dir slope = frame_to(f, dir(c.x, c.y, c.z));
    float by = min(1.0 / (kappa * max(open, 0.01)), inversesqrt(kappa * max(dot(c, c), 1e-12)));
    return dir_normal_or(dir_add(w, dir_scale(slope, open < 1.0 ? by : 0.0)), w);
}
#endif

/* Returns the visible fraction of light k, below 0 without a value. Fragments beside their triangle are a little out of
 * range. */
#ifdef COARSE
float env_light_seen(int k) {
    vec4 a = environment_merged_of[2 * max(k, 0)], b = environment_merged_of[2 * max(k, 0) + 1];
    return k < 0 ? -1.0 : dot(a, min(vertex_lights_0, 1.0)) + dot(b, min(vertex_lights_1, 1.0));
}
#else
float env_light_seen(int k) { return k < 0 ? -1.0 : k < 4 ? vertex_lights_0[k] : vertex_lights_1[k - 4]; }
#endif

/* Returns the visible fraction of light k on a side. open: that of the sky there. creases: what a texture leaves. */
float env_light_beside(Frame f, int k, float open, float creases, float side) {
    float seen = env_light_seen(k);
    vec3 d = environment_world(ENVIRONMENT_LIGHTS[2 * k].xyz);
    float width = 1.732 * exp2(-0.5 * environment_terms[0].w); /* even light of the lights' mean spread */
    float beside = beside_smooth(f, dir(d.x, d.y, d.z), width, side);
    return seen < -0.5 ? open : clamp(seen, 0.0, 1.0) * creases * beside;
}

float ambient_light_visibility(Frame f, int k, float occlusion) {
    return env_light_beside(f, k, occlusion, texture_occlusion, 1.0);
}
float ambient_light_behind(Frame f, int k, float open) { return env_light_beside(f, k, open, 1.0, -1.0); }
