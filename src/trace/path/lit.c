/* lit.c - light that the vertices of paths emit, or receive and reflect */
#include "trace/path/slot_light.h"

#include "base/random.h"
#include "shading/dialect/loop.h"
#include "shading/dialect/rgb.h"

/* Returns how light of a group is sampled. Without shadows all of it has to arrive unoccluded: the rays that the lobe
 * draws then meet the environment whatever they hit (stream.c), but lights only if nothing is before them. */
static WeftSampling sampling_of(const PathContext *context, LightGroup group) {
    return context->shadows || group == LIGHTS_SKY ? context->sampling : WEFT_SAMPLING_LIGHT;
}

/* Returns the density, 1/sr, with which the triangle that path k hit is sampled as a light at the vertex before. */
static float light_pdf(const Chunk *chunk, const ChunkSource *source, int k, float cosine) {
    const Paths *paths = source->paths;
    int j = source->order[k];
    return lights_triangle_pdf(
        source->context->lights, chunk->mesh[k], chunk->triangle[k],
        vec3(paths->origin[0][j], paths->origin[1][j], paths->origin[2][j]),
        vec3(paths->horizon_normal[0][j], paths->horizon_normal[1][j], paths->horizon_normal[2][j]), chunk->t[k],
        cosine);
}

void chunk_add_emission(Chunk *chunk, const ChunkSource *source, PathRadiance *radiance) {
    const PathContext *context = source->context;
    const Material *material = &context->materials[source->material].material;
    SurfaceRows *surface = &chunk->vertices.surface;
    for (int k = 0; k < source->n; k++) {
        Row *emitted = material->unlit ? surface->base_color : surface->emission;
        float cosine = 0.0f, weight = 1.0f;
        for (int a = 0; a < 3; a++) cosine += chunk->wo[a][k] * chunk->geometric[a][k];
        if (!material->unlit) {
            float b = chunk->pdf[k] > 0.0f ? light_pdf(chunk, source, k, cosine) : 0.0f;
            weight =
                surface->emission_strength[k] * lobe_weight(sampling_of(context, LIGHTS_EMITTERS), chunk->pdf[k], b);
            if (chunk->side[k] < 0.0f && !material->double_sided) weight = 0.0f;
        }
        for (int a = 0; a < 3; a++)
            radiance->rgba[a][chunk->id[k]] += chunk->throughput[a][k] * (emitted[a][k] * weight);
    }
}

/* Computes the contribution of each light sample of a group if nothing occludes it. shadow_distance is below 0 if it
 * contributes nothing, as from between the horizon and the plane of the shading normal. mis: the lobe may find the same
 * light. */
LOOP(weigh_n, (Chunk *restrict chunk, LightGroup group, bool mis, int n), (chunk, group, mis, n)) {
    const LightRows *light = &chunk->light_samples[group];
    float(*f_cos)[ROW_CAPACITY] = chunk->vertices.f[group], *lobe_pdf = chunk->vertices.pdf[group],
    *z = chunk->vertices.i[group][2];
    Row *horizon = chunk->horizon_normal;
    float both = mis ? 1.0f : 0.0f;
    EACH(k, (size_t)n) {
        float light_pdf = light->pdf[k], lobe = lobe_pdf[k], safe_pdf = light_pdf > 0.0f ? light_pdf : 1.0f;
        float weight = 1.0f / (safe_pdf + both * lobe * (lobe / safe_pdf)); /* MIS weight / light_pdf */
        float up = light->wi[0][k] * horizon[0][k] + light->wi[1][k] * horizon[1][k] + light->wi[2][k] * horizon[2][k];
        float r = f_cos[0][k] * light->radiance[0][k], g = f_cos[1][k] * light->radiance[1][k],
              b = f_cos[2][k] * light->radiance[2][k];
        bool live = (light_pdf > 0.0f) & (up * z[k] > 0.0f) & (r + g + b > 0.0f);
        chunk->shadow_distance[k] = live ? light->distance[k] : -1.0f;
        chunk->contribution[0][k] = chunk->throughput[0][k] * r * weight;
        chunk->contribution[1][k] = chunk->throughput[1][k] * g * weight;
        chunk->contribution[2][k] = chunk->throughput[2][k] * b * weight;
    }
}

/* Selects the vertices of which the light sample contributes; returns how many they are. The first is repeated up to
 * row_whole of them. */
static int select_shadow_rays(Chunk *chunk, int n) {
    int count = 0;
    for (int k = 0; k < n; k++) {
        chunk->selected[count] = k;
        count += chunk->shadow_distance[k] >= 0.0f;
    }
    for (int k = count; k < row_whole(count); k++) chunk->selected[k] = chunk->selected[0];
    return count;
}

/* Makes the shadow rays of n selected vertices. They start at `origin`, aside of the lifted point that was lit, and end
 * just before the light. transmits: the light may be behind. */
FN void aim_each(Chunk *restrict chunk, LightGroup group, bool transmits, int n) {
    const LightRows *light = &chunk->light_samples[group];
    const int *selected = chunk->selected;
    EACH(k, (size_t)n) {
        int j = selected[k];
        float distance = chunk->shadow_distance[j], x = light->wi[0][j], y = light->wi[1][j], z = light->wi[2][j];
        float ox = chunk->origin[0][j], oy = chunk->origin[1][j], oz = chunk->origin[2][j];
        if (transmits) {
            bool below = chunk->vertices.i[group][2][j] < 0.0f;
            float bx = chunk->origin_behind[0][j], by = chunk->origin_behind[1][j], bz = chunk->origin_behind[2][j];
            ox = below ? bx : ox;
            oy = below ? by : oy;
            oz = below ? bz : oz;
        }
        bool near = distance < 0.5f * LIGHT_FAR;
        float d = near ? distance : 0.0f;
        float tx = chunk->lifted[0][j] + x * d - ox, ty = chunk->lifted[1][j] + y * d - oy,
              tz = chunk->lifted[2][j] + z * d - oz;
        float length2 = tx * tx + ty * ty + tz * tz;
        bool moved = near & (length2 > 1e-30f) & (length2 < 1e30f);
        float length = sqrt(length2), r = 1.0f / (moved ? length : 1.0f);
        chunk->shadow_rays.origin[0][k] = ox;
        chunk->shadow_rays.origin[1][k] = oy;
        chunk->shadow_rays.origin[2][k] = oz;
        chunk->shadow_rays.direction[0][k] = moved ? tx * r : x;
        chunk->shadow_rays.direction[1][k] = moved ? ty * r : y;
        chunk->shadow_rays.direction[2][k] = moved ? tz * r : z;
        chunk->shadow_rays.distance[k] = near ? length * (1.0f - 1e-4f) : LIGHT_FAR;
        chunk->shadow_rays.key[k] =
            hash32(chunk->key[j] ^ 0x5bd1e995u); /* a veil that let the eye through may hide light */
    }
}

LOOP(aim_n, (Chunk *restrict chunk, LightGroup group, bool transmits, int n), (chunk, group, transmits, n)) {
    if (transmits)
        aim_each(chunk, group, true, n);
    else
        aim_each(chunk, group, false, n);
}

/* Leaves a part of the light sample of vertex k. */
static void dim(Chunk *chunk, int k, Rgb left) {
    chunk->contribution[0][k] *= left.r;
    chunk->contribution[1][k] *= left.g;
    chunk->contribution[2][k] *= left.b;
}

/* Takes from the light sample of vertex k what solid glass absorbs on its way, if the light is inside too. */
static void absorb_light(Chunk *chunk, const ChunkSource *source, LightGroup group, int k) {
    const int inside = chunk_inside(chunk, source, k, chunk->vertices.i[group][2][k] < 0.0f);
    if (!inside || !(chunk->shadow_distance[k] < 0.5f * LIGHT_FAR)) return;
    dim(chunk, k, solid_left(source->context->materials[inside - 1].absorption, chunk->shadow_distance[k]));
}

int chunk_add_light(Chunk *chunk, const ChunkSource *source, LightGroup group, PathRadiance *radiance) {
    const PathContext *context = source->context;
    bool punctual = group == LIGHTS_PUNCTUAL;
    WeftSampling sampling = sampling_of(context, group);
    if (sampling == WEFT_SAMPLING_LOBE && !punctual) return 0;
    weigh_n(chunk, group, !punctual && sampling == WEFT_SAMPLING_MIS, row_whole(source->n));
    int count = select_shadow_rays(chunk, source->n);
    Rgb *through = context->panes ? chunk->through : NULL;
    if (context->shadows) {
        aim_n(chunk, group, context->materials[source->material].transmits, row_whole(count));
        const RayRows rays = {
            {chunk->shadow_rays.origin[0], chunk->shadow_rays.origin[1], chunk->shadow_rays.origin[2]},
            {chunk->shadow_rays.direction[0], chunk->shadow_rays.direction[1], chunk->shadow_rays.direction[2]},
            chunk->shadow_rays.distance,
            chunk->shadow_rays.key,
            false,
            false};
        stage_end(chunk->clock, STAGE_WEIGH);
        geometry_occlusions(context->geometry, &rays, count, chunk->occluded, through);
        stage_end(chunk->clock, STAGE_OCCLUSIONS);
    }
    for (int k = 0; k < count; k++) {
        int j = chunk->selected[k];
        if (context->shadows && chunk->occluded[k]) continue;
        if (through) dim(chunk, j, through[k]);
        if (context->solids) absorb_light(chunk, source, group, j);
        for (int a = 0; a < 3; a++) radiance->rgba[a][chunk->id[j]] += chunk->contribution[a][j];
        if (chunk->slots && source->depth == 0) slot_light_add(chunk->slots, chunk, group, j);
    }
    stage_end(chunk->clock, STAGE_WEIGH);
    return context->shadows ? count : 0;
}
