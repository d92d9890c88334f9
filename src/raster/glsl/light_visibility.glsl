/* light_visibility.glsl - what a fragment sees of the sky and of the environment's lights, of which there are eight:
 * raster/geometry/occlusion.h */
#include "shading/ambient/occlusion_cone.h"

in highp vec2 vertex_occlusion;
in highp vec4 vertex_open_front;
in highp vec4 vertex_open_back;
in highp vec4 vertex_lights_0;
in highp vec4 vertex_lights_1;

/* Visible fraction of the sky by the occlusion texture, which has the material's own bumps. */
float texture_occlusion = 1.0;

/* The normal that a material's map leaves as it is, on the viewer's side. */
Dir smooth_normal;

vec4 fragment_open() { return gl_FrontFacing ? vertex_open_front : vertex_open_back; }

/* The part of light about d that comes from above the smooth surface, and not only from above a shading normal that is bent
 * away from it: as at a silhouette, whose smooth normal the eye does not see. blur: how far about d it comes from. */
float above_smooth(Frame f, Dir d, float blur) {
    return clamp((dir_dot(d, smooth_normal) + blur) / (max(dir_dot(d, f.z), 0.0) + blur), 0.0, 1.0);
}

/* A vertex knows what it sees as a ramp over directions, near a least-squares fit: of a sky that is half hidden by an edge
 * that has a slope of 3/4. A filter of that kappa shows such an edge with a slope of sqrt(kappa / (2 pi)). So the ramp is
 * steepened for narrow ones, the more the steeper it is: a level ramp has no edge. Not beyond the narrowest of the look-ups,
 * since the edge is somewhere else at the next vertex. What passes in all is then no longer that of the rays. */
float steepness(vec3 slope, float kappa) {
    float edge = min(length(slope) / 0.75, 1.0);
    return mix(1.0, clamp(0.532 * sqrt(kappa), 1.0, 1.88), edge);
}

float ambient_sky_visibility(Frame f, Dir w, float kappa, float cos_i, float occlusion) {
    vec4 c = fragment_open();
    Dir d = frame_from(f, w);
    float ramp = c.x + c.y * d.x + c.z * d.y + c.w * d.z;
    float seen = clamp(0.5 + steepness(c.yzw, kappa) * (ramp - 0.5), 0.0, 1.0);
    return min(seen * above_smooth(f, d, 0.02), occlusion_cone(texture_occlusion, cos_i));
}

/* A Gaussian of variance 1 / kappa times V = open + c . x has its mean at c / (kappa open); cut off where V
 * is, it is not beyond a deviation. */
Dir ambient_bent_direction(Frame f, Dir w, float kappa, float open) {
    vec3 c = fragment_open().yzw;
    c *= steepness(c, kappa);
    Dir slope = frame_to(f, dir(c.x, c.y, c.z));
    float by = min(1.0 / (kappa * max(open, 0.01)), inversesqrt(kappa * max(dot(c, c), 1e-12)));
    return dir_normal_or(dir_add(w, dir_scale(slope, open < 1.0 ? by : 0.0)), w);
}

/* -1 is unknown; beside their triangle fragments are a little out of range. */
float env_light_seen(int k) { return k < 0 ? -1.0 : k < 4 ? vertex_lights_0[k] : vertex_lights_1[k - 4]; }

float ambient_light_visibility(Frame f, int k, float occlusion) {
    float seen = env_light_seen(k);
    vec3 d = environment_world(environment_lights[2 * k].xyz);
    float above = above_smooth(f, dir(d.x, d.y, d.z), 0.045);
    return seen < -0.5 ? occlusion : clamp(seen, 0.0, 1.0) * texture_occlusion * above;
}
