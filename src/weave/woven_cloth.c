/* woven_cloth.c - makes a cloth from a draft: its runs, the albedo of its fibres, and its appearance from afar */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "image/srgb.h"
#include "shading/media/yarn_medium.h"
#include "weave/weave_draft.h"
#include "weave/weft_cloth.h"

/* Returns 1 if thread k of a system is on top at its crossing with thread c of the other. */
static int on_top(const WeftDraft *draft, WeftThreads threads, int k, int c) {
    return threads == WEFT_WARP ? weft_draft_warp_up(draft, k, c) : !weft_draft_warp_up(draft, c, k);
}

/* Writes the runs of one thread: at each crossing the number of crossings before it in its run, and the run's length,
 * below 0 where the thread is below. Both are 0 if the thread never changes sides. */
static void put_runs(WeftCloth *cloth, const WeftDraft *draft, WeftThreads threads, int k) {
    const int count = draft->count[!threads], warps = draft->count[WEFT_WARP];
    int start = 0;
    while (start < count && on_top(draft, threads, k, start) == on_top(draft, threads, k, start + count - 1)) start++;
    const bool endless = start == count;
    for (int at = 0; at < count;) {
        const int top = on_top(draft, threads, k, start + at);
        int length = 1;
        while (at + length < count && on_top(draft, threads, k, start + at + length) == top) length++;
        for (int c = 0; c < length; c++) {
            const int cross = (start + at + c) % count;
            const size_t cell = threads == WEFT_WARP ? (size_t)cross * (size_t)warps + (size_t)k
                                                     : (size_t)k * (size_t)warps + (size_t)cross;
            float *run = cloth->runs + 4 * cell + 2 * threads;
            run[0] = endless ? 0.0f : (float)c;
            run[1] = endless ? 0.0f : top ? (float)length : -(float)length;
        }
        at += length;
    }
}

/* Returns the albedo A of fibres that make a cloth of that reflectance, A E + rho(A) (1 - E), by bisection. E is the
 * part of light that leaves white fibres after it met one of them. */
static float albedo_of(float reflectance, float alpha) {
    const float single = 0.328f - 0.111f * alpha;
    float low = 0.0f, high = 1.0f;
    for (int step = 0; step < 24; step++) {
        const float a = 0.5f * (low + high);
        if (a * single + yarn_reflectance(a) * (1.0f - single) < reflectance)
            low = a;
        else
            high = a;
    }
    return 0.5f * (low + high);
}

static void put_albedos(WeftCloth *cloth, const WeftDraft *draft) {
    float *albedo = cloth->albedos;
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < draft->count[t]; k++)
            for (int c = 0; c < 3; c++)
                *albedo++ = albedo_of(srgb_decode(draft->threads[t][k].color[c]), cloth->yarns[t].alpha);
}

/* Returns the yarn of a system in the cloth. Pitches are in units of `unit` millimetres, the mean pitch; width: of the
 * draft, in pitches. */
static WeaveYarn yarn_in_cloth(const WeftYarn *yarn, float pitch, float cross_pitch, float width, float unit) {
    const float own = yarn->width * width;
    return (WeaveYarn){.alpha = yarn->alpha,
                       .crimp = tanf(yarn->crimp),
                       .roundness = yarn->roundness,
                       .twist = yarn->twist,
                       .white = yarn->white,
                       .pitch = pitch,
                       .cross_pitch = cross_pitch,
                       .width = own,
                       .bulge = yarn->bulge,
                       .floats = yarn->floats,
                       .streaks = yarn->streaks,
                       .dye = yarn->dye,
                       .slub = yarn->slub,
                       .wander = yarn->wander,
                       .hairiness = yarn->hairiness,
                       .slub_nodes = cross_pitch * unit / yarn->slub_length,
                       .barre = yarn->barre,
                       .barre_nodes = pitch * unit / yarn->barre_width,
                       .uneven = yarn->uneven,
                       .uneven_nodes = pitch * unit / yarn->uneven_size,
                       .core = albedo_of(yarn->core, yarn->alpha),
                       .per_width = 1.0f / own,
                       .cos_twist = cosf(yarn->twist),
                       .sin_twist = sinf(yarn->twist),
                       .crossing = cross_pitch / pitch};
}

static WeftResult yarn_check(const WeftYarn *yarn, WeftError *error) {
    for (int k = 0; weft_yarn_number(k); k++) {
        const WeftYarnNumber *n = weft_yarn_number(k);
        const float value = *(const float *)((const char *)yarn + n->offset);
        if (!(value >= n->low && value <= n->high))
            return fail(error, WEFT_MESSAGE_DESC, "yarn", "%s is %g; %g to %g is possible", n->name, (double)value,
                        (double)n->low, (double)n->high);
    }
    return WEFT_OK;
}

WeftResult weft_cloth_create(const WeftDraft *draft, const WeftYarn yarns[2], unsigned seed, WeftCloth **out,
                             WeftError *error) {
    const int warps = draft->count[WEFT_WARP], picks = draft->count[WEFT_WEFT];
    double pitch[2] = {0.0, 0.0}, width[2] = {0.0, 0.0};
    *out = NULL;
    for (int t = 0; t < 2; t++)
        if (yarn_check(&yarns[t], error) != WEFT_OK) return WEFT_USAGE;
    WeftCloth *cloth = alloc_array(1, sizeof *cloth);
    if (cloth) cloth->runs = alloc_array((size_t)warps * (size_t)picks, 4 * sizeof(float));
    if (cloth) cloth->albedos = alloc_array((size_t)warps + (size_t)picks, 3 * sizeof(float));
    if (!cloth || !cloth->runs || !cloth->albedos) {
        weft_cloth_free(cloth);
        return fail(error, WEFT_MESSAGE_MEMORY, draft->title, NULL);
    }
    for (int t = 0; t < 2; t++) {
        cloth->yarns[t] = yarns[t];
        for (int k = 0; k < draft->count[t]; k++) {
            const WeftThread *thread = &draft->threads[t][k];
            pitch[t] += (double)thread->spacing;
            width[t] += fmin(fmax((double)thread->thickness, 0.3 * (double)thread->spacing), (double)thread->spacing);
            put_runs(cloth, draft, (WeftThreads)t, k);
        }
        cloth->size[t] = pitch[t];
        width[t] /= pitch[t];
        pitch[t] /= (double)draft->count[t];
    }
    put_albedos(cloth, draft);
    const double unit = 0.5 * (pitch[0] + pitch[1]);
    const float warp = (float)(pitch[0] / unit), weft = (float)(pitch[1] / unit), millimetres = (float)(1e3 * unit);
    cloth->weave = (Weave){.warps = warps,
                           .picks = picks,
                           .warp = yarn_in_cloth(&yarns[WEFT_WARP], warp, weft, (float)width[0], millimetres),
                           .weft = yarn_in_cloth(&yarns[WEFT_WEFT], weft, warp, (float)width[1], millimetres),
                           .seed = (float)(seed % 289u),
                           .runs = cloth->runs,
                           .albedos = cloth->albedos};
    if (!cloth_far_make(cloth)) {
        weft_cloth_free(cloth);
        return fail(error, WEFT_MESSAGE_MEMORY, draft->title, NULL);
    }
    cloth_spread(cloth, 1.0);
    cloth_rotate(cloth, 0.0);
    *out = cloth;
    return WEFT_OK;
}

void cloth_spread(WeftCloth *cloth, double metres) {
    cloth->metres = metres;
    if (cloth->other) cloth_spread(cloth->other, metres);
    const double along = cloth->other_face ? -metres : metres;
    cloth->per_uv[WEFT_WARP] = (float)(along * (double)cloth->weave.warps / cloth->size[WEFT_WARP]);
    cloth->per_uv[WEFT_WEFT] = (float)(along * (double)cloth->weave.picks / cloth->size[WEFT_WEFT]);
}

void cloth_rotate(WeftCloth *cloth, double degrees) {
    /* multiples of a right angle are exact: cos 90 degrees is not 6e-17 */
    const double quarters = degrees / 90.0, angle = degrees * RADIANS;
    const bool exact = !(quarters < (floor)(quarters) || quarters > (floor)(quarters));
    cloth->rotation = degrees;
    if (cloth->other) cloth_rotate(cloth->other, degrees);
    cloth->rotation_parts[0] = (float)(exact ? (round)((cos)(angle)) : (cos)(angle));
    cloth->rotation_parts[1] = (float)(exact ? (round)((sin)(angle)) : (sin)(angle));
}

void weft_cloth_free(WeftCloth *cloth) {
    if (!cloth) return;
    free(cloth->runs);
    free(cloth->albedos);
    free(cloth->far.texels);
    free(cloth->text);
    free(cloth->path);
    weft_cloth_free(cloth->other);
    weft_draft_free(cloth->draft);
    free(cloth);
}

/* Returns count numbers copied, or NULL if memory is short. */
static float *copy_numbers(const float *numbers, size_t count) {
    float *copy = alloc_array(count, sizeof *copy);
    return copy ? memcpy(copy, numbers, count * sizeof *copy) : NULL;
}

static size_t far_size(const ClothFar *far) {
    int width, height;
    const float *last = cloth_far_level(far, far->levels - 1, &width, &height);
    return (size_t)(last - far->texels) + (size_t)width * (size_t)height * FAR_LAYERS * 4;
}

WeftCloth *cloth_copy(const WeftCloth *cloth) {
    WeftCloth *copy = alloc_array(1, sizeof *copy);
    if (!copy) return NULL;
    const size_t warps = (size_t)cloth->weave.warps, picks = (size_t)cloth->weave.picks;
    *copy = *cloth;
    copy->runs = copy_numbers(cloth->runs, 4 * warps * picks);
    copy->albedos = copy_numbers(cloth->albedos, 3 * (warps + picks));
    copy->far.texels = copy_numbers(cloth->far.texels, far_size(&cloth->far));
    copy->text = cloth->text ? strdup(cloth->text) : NULL;
    copy->path = cloth->path ? strdup(cloth->path) : NULL;
    copy->draft = NULL;
    copy->other = NULL;
    const bool whole = copy->runs && copy->albedos && copy->far.texels && !copy->text == !cloth->text &&
                       !copy->path == !cloth->path &&
                       (!cloth->draft || weft_draft_copy(cloth->draft, &copy->draft, NULL) == WEFT_OK);
    copy->weave.runs = copy->runs;
    copy->weave.albedos = copy->albedos;
    if (whole) return copy;
    weft_cloth_free(copy);
    return NULL;
}

static bool same_text(const char *a, const char *b) { return a && b ? strcmp(a, b) == 0 : a == b; }

bool cloth_same(const WeftCloth *a, const WeftCloth *b) {
    if (!a->text || !same_text(a->text, b->text) || !same_text(a->path, b->path)) return false;
    if (a->metres < b->metres || a->metres > b->metres) return false;
    return a->draft && b->draft ? draft_same(a->draft, b->draft) : a->draft == b->draft;
}

/* Writes the runs of both threads at each crossing, seen from behind: the crossings in reverse, what was over under. */
static void reverse_runs(const WeftCloth *from, WeftCloth *to) {
    const size_t cells = (size_t)from->weave.warps * (size_t)from->weave.picks;
    for (size_t cell = 0; cell < cells; cell++)
        for (int t = 0; t < 2; t++) {
            const float *run = from->runs + 4 * cell + 2 * (size_t)t, length = fabsf(run[1]);
            float *reverse = to->runs + 4 * (cells - 1 - cell) + 2 * (size_t)t;
            reverse[0] = length > 0.0f ? length - 1.0f - run[0] : 0.0f;
            reverse[1] = 0.0f - run[1];
        }
}

/* Writes the albedos of the threads of each system in reverse. */
static void reverse_albedos(const WeftCloth *from, WeftCloth *to) {
    const int counts[2] = {from->weave.warps, from->weave.picks};
    size_t first = 0;
    for (int t = 0; t < 2; first += (size_t)counts[t++])
        for (size_t k = 0; k < (size_t)counts[t]; k++)
            memcpy(to->albedos + 3 * (first + k), from->albedos + 3 * (first + (size_t)counts[t] - 1 - k),
                   3 * sizeof(float));
}

static void mirror_twist(WeaveYarn *yarn) {
    yarn->twist = 0.0f - yarn->twist;
    yarn->sin_twist = 0.0f - yarn->sin_twist;
}

WeftCloth *cloth_other_face(const WeftCloth *cloth) {
    WeftCloth *other = cloth_copy(cloth);
    if (!other) return NULL;
    other->other_face = !cloth->other_face;
    reverse_runs(cloth, other);
    reverse_albedos(cloth, other);
    for (int t = 0; t < 2; t++) other->yarns[t].twist = 0.0f - cloth->yarns[t].twist;
    mirror_twist(&other->weave.warp);
    mirror_twist(&other->weave.weft);
    free(other->far.texels);
    other->far = (ClothFar){0};
    cloth_spread(other, cloth->metres);
    if (cloth_far_make(other)) return other;
    weft_cloth_free(other);
    return NULL;
}

WeftClothInfo weft_cloth_info(const WeftCloth *cloth) {
    return (WeftClothInfo){.share = {cloth->weave.warp_far.share, cloth->weave.weft_far.share},
                           .size = {(float)cloth->size[0], (float)cloth->size[1]},
                           .sett = {(float)(0.01 * (double)cloth->weave.warps / cloth->size[WEFT_WARP]),
                                    (float)(0.01 * (double)cloth->weave.picks / cloth->size[WEFT_WEFT])},
                           .metres = (float)cloth->metres,
                           .automatic = cloth->automatic,
                           .rotation = (float)cloth->rotation,
                           .relief = cloth->relief,
                           .seed = (int)cloth->weave.seed};
}
