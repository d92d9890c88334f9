/* panes.c - paths that go straight on through panes (scene/light/pane.h)
 *
 * A path either passes a pane, with the chance p, or is reflected or scattered by what the pane has beside its glass:
 *
 *   throughput T / p where it passes,  throughput / (1 - p) where not,  p = the largest channel of T, at most MOST
 *
 * Where it passes, no vertex is made: depth, origin, direction and pdf of the ray stay, so that a light that it then
 * finds has the same MIS weight as one that a shadow ray reaches through the pane. Rays of the camera do not pass: what
 * is first seen is the pane, with the narrow lobe of its glass. */
#include "trace/path/stream.h"

#include "base/random.h"

/* Leaves some paths to what else a pane does, however clear it is. */
static const float MOST = 0.95f;

static void scale(Paths *paths, int k, Rgb by, bool sky) {
    const float factor[3] = {by.r, by.g, by.b};
    for (int c = 0; c < 3; c++) {
        paths->throughput[c][k] *= factor[c];
        if (sky) paths->sky_throughput[c][k] *= factor[c];
    }
}

/* Decides if path k passes the pane that it hits, and weighs it. */
static bool passes(const Stream *stream, Paths *paths, int k, const Hit *hit, Vec3 direction) {
    const PathContext *context = stream->context;
    const Rgb through = geometry_pane(context->geometry, hit, direction);
    const float p = min(rgb_max3(through), MOST);
    const bool passed = geometry_chance(hit, hash32(paths->key[k] ^ 0x2c1b3c6du)) < p;
    scale(paths, k, passed ? rgb_scale(through, 1.0f / p) : rgb_grey(1.0f / (1.0f - p)), context->sky_in_parts);
    return passed;
}

/* Goes on to the next hit. A packet of rays and one ray alone may find the same triangle at distances that differ by more
 * than geometry_past. */
static void next(Stream *stream, Ray *ray, Hit *hit) {
    const uint32_t mesh = hit->mesh, triangle = hit->triangle;
    while (hit->mesh == mesh && hit->triangle == triangle) {
        ray->near = geometry_past(hit->t);
        stream->rays++;
        if (!geometry_hit(stream->context->geometry, *ray, hit)) hit->mesh = GEOMETRY_NOTHING;
    }
}

/* Sends path k on through panes to its next vertex. */
static void pass(Stream *stream, Paths *paths, int k) {
    enum { STEPS = 256 };
    const PathContext *context = stream->context;
    Ray ray = {.origin = {paths->origin[0][k], paths->origin[1][k], paths->origin[2][k]},
               .direction = {paths->direction[0][k], paths->direction[1][k], paths->direction[2][k]},
               .far = INFINITY,
               .key = paths->key[k]};
    Hit hit = {.t = stream->t[k],
               .mesh = stream->mesh[k],
               .triangle = stream->triangle[k],
               .u = stream->u[k],
               .v = stream->v[k],
               .facing = geometry_winding(&context->scene->meshes[stream->mesh[k]], stream->triangle[k])};
    for (int step = 0; step < STEPS && hit.mesh != GEOMETRY_NOTHING && geometry_is_pane(context->geometry, hit.mesh) &&
                       passes(stream, paths, k, &hit, ray.direction);
         step++) {
        next(stream, &ray, &hit);
    }
    stream->t[k] = hit.t, stream->u[k] = hit.u, stream->v[k] = hit.v;
    stream->mesh[k] = hit.mesh, stream->triangle[k] = hit.triangle;
}

void stream_pass_panes(Stream *stream, Paths *paths, int n) {
    if (!stream->context->panes) return;
    for (int k = 0; k < n; k++)
        if (stream->mesh[k] != GEOMETRY_NOTHING && geometry_is_pane(stream->context->geometry, stream->mesh[k]))
            pass(stream, paths, k);
}
