#include "measure/fit/material_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "measure/bsdf/reflection.h"
#include "measure/fit/blend.h"
#include "measure/fit/search.h"
#include "shading/material/choice.h"
#include "shading/stack/input_ids.h"
#include "weft/raster.h"

/* The inputs that may change, in this order. */
static const InputId inputs[] = {INPUT_sheen_roughness, INPUT_roughness,  INPUT_specular,    INPUT_sheen,
                                 INPUT_sheen_tint,      INPUT_base_color, INPUT_sheen_color, INPUT_specular_color};
/* A narrower highlight falls between the directions. */
static const double roughness_least = 0.25;
enum { INPUTS = sizeof inputs / sizeof *inputs, PARTS = 2 };

/* An axis: a channel of an input, or all three of a colour that stays grey. */
typedef struct Axis {
    InputId input;
    int channel; /* -1: all */
} Axis;

typedef struct MaterialWalker {
    const Samples *samples;
    WeftMaterial material;
    WeftReflection *reflection;
    AlbedoTable *table;
    Axis axis[SEARCH_MOST];
    int axes;
    float *x[3], *part[PARTS][3], *rest[3], *work, *block;
} MaterialWalker;

static bool uses(const WeftMaterial *material, InputId input) { return weft_material_reads(material, (int)input) != 0; }

int weft_match_is_free(const WeftMaterial *material, int input) {
    bool one = false;
    for (int k = 0; k < INPUTS; k++) one |= (int)inputs[k] == input;
    if (!one || !uses(material, (InputId)input)) return 0;
    switch ((InputId)input) {
    case INPUT_sheen:
    case INPUT_sheen_tint: return !uses(material, INPUT_sheen_color);
    case INPUT_specular_color:
        return material->choices[CHOICE_profile] <= 0 &&
               material->choices[CHOICE_workflow] == choice_find(CHOICE_workflow, "specular");
    default: return 1;
    }
}

static bool is_color(InputId input) {
    WeftInputInfo info;
    weft_material_input_info((int)input, &info);
    return info.kind == WEFT_INPUT_COLOR;
}

static bool is_grey(const float *v) { return !(v[0] < v[1] || v[0] > v[1] || v[1] < v[2] || v[1] > v[2]); }

static void material_at(const MaterialWalker *self, const double *x, WeftMaterial *material) {
    *material = self->material;
    for (int k = 0; k < self->axes; k++) {
        float *value = material->inputs[self->axis[k].input].value;
        int c = self->axis[k].channel;
        for (int j = 0; j < 3; j++)
            if (c == j || c < 0) value[j] = (float)x[k];
        material->inputs[self->axis[k].input].given = 1;
    }
}

static double distance_at(MaterialWalker *self, const double *x, int count) {
    WeftMaterial material;
    material_at(self, x, &material);
    reflection_change(self->reflection, &material, self->table);
    Samples some = *self->samples;
    some.count = count;
    samples_eval(&some, self->reflection, WEFT_PART_ALL, self->x);
    return samples_distance(self->samples, count, (const float *const *)self->x);
}

/* Scales the colours of base and sheen as if their reflection were in proportion to them. This is nearly
 * right, and exact if the sheen takes nothing from the base. */
static void scale_colors(MaterialWalker *self, double *x) {
    static const int parts[PARTS] = {WEFT_PART_DIFFUSE, WEFT_PART_SHEEN};
    static const InputId colors[PARTS] = {INPUT_base_color, INPUT_sheen_color};
    const Samples *s = self->samples;
    Samples few = *s;
    few.count = few.first;
    for (int p = 0; p < PARTS; p++) samples_eval(&few, self->reflection, parts[p], self->part[p]);
    for (int c = 0; c < s->channels; c++) {
        for (int k = 0; k < few.count; k++)
            self->rest[c][k] = self->x[c][k] - self->part[0][c][k] - self->part[1][c][k];
        double weights[BLEND_MOST];
        Blend blend = {.columns = PARTS, .work = self->work};
        for (int p = 0; p < PARTS; p++) blend.column[p][c] = self->part[p][c];
        blend.fixed[c] = self->rest[c];
        blend_solve(s, few.count, c, &blend, weights);
        for (int k = 0; k < self->axes; k++)
            for (int p = 0; p < PARTS; p++)
                if (self->axis[k].input == colors[p] && (self->axis[k].channel < 0 || self->axis[k].channel == c))
                    x[k] = fmin(x[k] * weights[p], 1.0);
    }
}

static double error_at(void *user, double *x, SearchCare care) {
    enum { ROUNDS = 2 };
    MaterialWalker *self = user;
    const Samples *s = self->samples;
    double error = distance_at(self, x, care == SEARCH_FULL ? s->count : s->first);
    for (int round = 0; care == SEARCH_GLANCE && round < ROUNDS; round++) {
        double before[SEARCH_MOST];
        memcpy(before, x, sizeof before);
        scale_colors(self, x);
        double now = distance_at(self, x, s->first);
        if (now < error) {
            error = now;
            continue;
        }
        memcpy(x, before, sizeof before);
        break;
    }
    return error;
}

static Search make_search(MaterialWalker *self, const int *locked, double *x) {
    static const int grids[] = {0, 8, 16, 32, 48, 64};
    Search search = {.error = error_at, .user = self, .descents = 1, .most = 600};
    bool grey = self->samples->channels == 1;
    for (int k = 0; k < INPUTS; k++)
        if (is_color(inputs[k])) grey = grey && is_grey(self->material.inputs[inputs[k]].value);
    for (int k = 0; k < INPUTS; k++) {
        WeftInputInfo info;
        InputId input = inputs[k];
        if ((locked && locked[input]) || !weft_match_is_free(&self->material, (int)input)) continue;
        weft_material_input_info((int)input, &info);
        int channels = is_color(input) && !grey ? 3 : 1;
        for (int c = 0; c < channels && search.axes < SEARCH_MOST; c++) {
            double start = (double)self->material.inputs[input].value[c];
            double low = input == INPUT_roughness ? roughness_least : (double)info.low;
            self->axis[search.axes] = (Axis){input, channels == 3 ? c : -1};
            if (!is_color(input)) self->axis[search.axes].channel = 0;
            x[search.axes] = start;
            search.axis[search.axes++] = (SearchAxis){fmin(low, start), fmax((double)info.high, start)};
        }
    }
    self->axes = search.axes;
    search.grid = grids[search.axes < 5 ? search.axes : 5];
    return search;
}

static WeftResult walker_make(MaterialWalker *self, const Samples *samples, const WeftMaterial *material,
                              WeftError *error) {
    size_t n = (size_t)samples->count;
    *self = (MaterialWalker){.samples = samples, .material = *material};
    self->block = alloc_array(15 * n, sizeof(float));
    self->table = alloc_array(1, sizeof *self->table);
    if (!self->block || !self->table) return fail(error, WEFT_MESSAGE_MEMORY, "a match", NULL);
    float *at = self->block;
    for (int c = 0; c < 3; c++, at += 4 * n)
        self->x[c] = at, self->rest[c] = at + n, self->part[0][c] = at + 2 * n, self->part[1][c] = at + 3 * n;
    self->work = at;
    return weft_reflection_create(material, &self->reflection, error);
}

/* Computes the error of a material with its exact E, not the table. */
static WeftResult exact_distance(MaterialWalker *self, const WeftMaterial *material, double *distance,
                                 WeftError *error) {
    const Samples *s = self->samples;
    WeftReflection *exact;
    WeftResult result = weft_reflection_create(material, &exact, error);
    if (result != WEFT_OK) return result;
    samples_eval(s, exact, WEFT_PART_ALL, self->x);
    *distance = samples_distance(s, s->count, (const float *const *)self->x);
    weft_reflection_free(exact);
    return WEFT_OK;
}

WeftResult material_search_run(const Samples *samples, const int *locked, ItemProgress *item_progress,
                               WeftMaterial *material, WeftMatch *found, WeftError *error) {
    MaterialWalker self;
    double x[SEARCH_MOST] = {0.0};
    WeftResult result = walker_make(&self, samples, material, error);
    if (result == WEFT_OK) {
        Search search = make_search(&self, locked, x);
        search.item_progress = item_progress;
        search_run(&search, x, &found->evaluations);
        if (!progress_report(item_progress, 0.0)) result = WEFT_INTERRUPTED;
    }
    if (result == WEFT_OK) {
        material_at(&self, x, material);
        result = exact_distance(&self, material, &found->matched, error);
    }
    weft_reflection_free(self.reflection);
    free(self.table);
    free(self.block);
    return result;
}
