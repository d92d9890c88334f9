/* lit.c - light that vertices of paths send out or receive */
#include "trace/chunk.h"

#include "shading/dialect/loop.h"
#include "shading/dialect/rgb.h"

/* Returns the way in which a group of lights is found. Without shadows all of it must be found by what nothing stands
 * in the way of: the rays that the lobe draws meet the environment behind everything then (stream.c), but other lights
 * only where they are seen. */
static WeftSampling sampling_of(const PathContext *context, LightGroup group) {
    return context->shadows || group == LIGHTS_SKY ? context->sampling : WEFT_SAMPLING_LIGHT;
}

/* The density with which the light that a path hit is drawn where the path comes from. */
static float light_pdf(const Chunk *c, const ChunkSource *from, int k, float cosine) {
    const Paths *p = from->paths;
    int j = from->order[k];
    return lights_triangle_pdf(from->context->lights, c->mesh[k], c->triangle[k],
                               vec3(p->o[0][j], p->o[1][j], p->o[2][j]),
                               vec3(p->normal[0][j], p->normal[1][j], p->normal[2][j]), c->t[k], cosine);
}

void chunk_add_emission(Chunk *c, const ChunkSource *from, Light4 *light) {
    const PathContext *context = from->context;
    const Material *material = &context->materials[from->material].material;
    SurfaceRows *s = &c->vertices.surface;
    for (int k = 0; k < from->n; k++) {
        Row *sent = material->unlit ? s->base_color : s->emission;
        float cosine = 0.0f, worth = 1.0f;
        for (int a = 0; a < 3; a++) cosine += c->wo[a][k] * c->geometric[a][k];
        if (!material->unlit) {
            float b = c->pdf[k] > 0.0f ? light_pdf(c, from, k, cosine) : 0.0f;
            worth =
                s->emission_strength[k] * lobe_weight(sampling_of(context, LIGHTS_EMITTERS), c->pdf[k], b);
            if (c->side[k] < 0.0f && !material->double_sided) worth = 0.0f;
        }
        for (int a = 0; a < 3; a++) light->c[a][c->id[k]] += c->throughput[a][k] * (sent[a][k] * worth);
    }
}

/* Weighs each light sample of a group, as if nothing were in its way; far is below 0 if it brings nothing, as it
 * does from between the smooth surface and the plane of the shading normal. mis: the lobe may find the same light. */
LOOP(weigh_n, (Chunk *restrict c, LightGroup group, bool mis, int n), (c, group, mis, n)) {
    const LightRows *light = &c->light[group];
    float(*f)[ROW_ROOM] = c->vertices.f[group], *pdf = c->vertices.pdf[group], *z = c->vertices.i[group][2];
    Row *facing = c->facing;
    float both = mis ? 1.0f : 0.0f;
    EACH(k, (size_t)n) {
        float own = light->pdf[k], lobe = pdf[k], safe = own > 0.0f ? own : 1.0f;
        float worth = 1.0f / (safe + both * lobe * (lobe / safe)); /* weight / own */
        float up =
            light->wi[0][k] * facing[0][k] + light->wi[1][k] * facing[1][k] + light->wi[2][k] * facing[2][k];
        float r = f[0][k] * light->radiance[0][k], g = f[1][k] * light->radiance[1][k],
              b = f[2][k] * light->radiance[2][k];
        bool live = (own > 0.0f) & (up * z[k] > 0.0f) & (r + g + b > 0.0f);
        c->far[k] = live ? light->distance[k] : -1.0f;
        c->added[0][k] = c->throughput[0][k] * r * worth;
        c->added[1][k] = c->throughput[1][k] * g * worth;
        c->added[2][k] = c->throughput[2][k] * b * worth;
    }
}

/* Lists those with a shadow ray. */
static int list_rays(Chunk *c, int n) {
    int count = 0;
    for (int k = 0; k < n; k++) {
        c->list[count] = k;
        count += c->far[k] >= 0.0f;
    }
    for (int k = count; k < row_whole(count); k++) c->list[k] = c->list[0];
    return count;
}

/* From the moved start to just before the light. transmits: the light may be behind. */
FN void aim_each(Chunk *restrict c, LightGroup group, bool transmits, int n) {
    const LightRows *light = &c->light[group];
    const int *list = c->list;
    EACH(k, (size_t)n) {
        int j = list[k];
        float distance = c->far[j], x = light->wi[0][j], y = light->wi[1][j], z = light->wi[2][j];
        float ox = c->origin[0][j], oy = c->origin[1][j], oz = c->origin[2][j];
        if (transmits) {
            bool below = c->vertices.i[group][2][j] < 0.0f;
            float bx = c->behind[0][j], by = c->behind[1][j], bz = c->behind[2][j];
            ox = below ? bx : ox;
            oy = below ? by : oy;
            oz = below ? bz : oz;
        }
        bool near = distance < 0.5f * LIGHT_FAR;
        float d = near ? distance : 0.0f;
        float tx = c->lifted[0][j] + x * d - ox, ty = c->lifted[1][j] + y * d - oy,
              tz = c->lifted[2][j] + z * d - oz;
        float length2 = tx * tx + ty * ty + tz * tz;
        bool moved = near & (length2 > 1e-30f) & (length2 < 1e30f);
        float length = sqrt(length2), r = 1.0f / (moved ? length : 1.0f);
        c->shadow.o[0][k] = ox;
        c->shadow.o[1][k] = oy;
        c->shadow.o[2][k] = oz;
        c->shadow.d[0][k] = moved ? tx * r : x;
        c->shadow.d[1][k] = moved ? ty * r : y;
        c->shadow.d[2][k] = moved ? tz * r : z;
        c->shadow.far[k] = near ? length * (1.0f - 1e-4f) : LIGHT_FAR;
        c->shadow.key[k] = c->key[j];
    }
}

LOOP(aim_n, (Chunk *restrict c, LightGroup group, bool transmits, int n), (c, group, transmits, n)) {
    if (transmits)
        aim_each(c, group, true, n);
    else
        aim_each(c, group, false, n);
}

int chunk_add_light(Chunk *c, const ChunkSource *from, LightGroup group, Light4 *light) {
    const PathContext *context = from->context;
    bool punctual = group == LIGHTS_PUNCTUAL;
    WeftSampling sampling = sampling_of(context, group);
    if (sampling == WEFT_SAMPLING_LOBE && !punctual) return 0;
    weigh_n(c, group, !punctual && sampling == WEFT_SAMPLING_MIS, row_whole(from->n));
    int count = list_rays(c, from->n);
    if (context->shadows) {
        aim_n(c, group, context->materials[from->material].transmits, row_whole(count));
        const RayRows rays = {{c->shadow.o[0], c->shadow.o[1], c->shadow.o[2]},
                              {c->shadow.d[0], c->shadow.d[1], c->shadow.d[2]},
                              c->shadow.far,
                              c->shadow.key,
                              false,
                              false};
        stage_end(c->clock, STAGE_WEIGH);
        geometry_occlusions(context->geometry, &rays, count, c->hidden);
        stage_end(c->clock, STAGE_OCCLUSIONS);
    }
    for (int k = 0; k < count; k++) {
        int j = c->list[k];
        if (context->shadows && c->hidden[k]) continue;
        for (int a = 0; a < 3; a++) light->c[a][c->id[j]] += c->added[a][j];
    }
    stage_end(c->clock, STAGE_WEIGH);
    return context->shadows ? count : 0;
}
