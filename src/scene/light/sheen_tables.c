#include <stdlib.h>

#include "scene/light/sheen_tables.h"

#include "base/fail.h"
#include "scene/record/material_at.h"
#include "shading/material/material_stack.h"

enum { NARROW_TABLES = 8 }; /* made for one material's range of roughness; then one for all */

struct SheenTables {
    AlbedoTable **tables; /* one a distinct sheen */
    int *index;           /* one a material, into tables, or -1 */
    int table_count;
};

/* Returns the stack of a surface without a table. */
static Stack stack_of(const Surface *surface, const Choices *choices) {
    Stack stack;
    stack_make(&stack, surface, choices, (TableRef){.kind = TABLE_NONE});
    return stack;
}

/* The inputs that set the parameter by which workflows and profiles look up E, with their least value under a texture.
 * A beta of 0 would stand for the roughness. */
static const struct {
    InputId input;
    size_t member; /* of Surface */
    float least;
} shapes[] = {{INPUT_sheen_roughness, offsetof(Surface, sheen_roughness), 0.0f},
              {INPUT_fuzz_roughness, offsetof(Surface, fuzz_roughness), 0.0f},
              {INPUT_roughness, offsetof(Surface, roughness), 0.0f},
              {INPUT_anisotropy, offsetof(Surface, anisotropy), 0.0f},
              {INPUT_sheen_beta, offsetof(Surface, sheen_beta), 1e-6f}};
enum { SHAPES = sizeof shapes / sizeof shapes[0] };

/* Finds the range of that parameter for textures from 0 to 1, or with `all` over the range of all inputs. */
static void table_range(const Material *material, bool all, float *low, float *high) {
    const Surface untextured = material_plain(material);
    const Choices choices = material_choices(material);
    *low = *high = stack_of(&untextured, &choices).albedo_coord;
    for (int ends = 0; ends < 1 << SHAPES; ends++) {
        Surface surface = untextured;
        for (int k = 0; k < SHAPES; k++) {
            float *value = (float *)((char *)&surface + shapes[k].member);
            bool upper = ends >> k & 1;
            if (all && shapes[k].input != INPUT_sheen_beta)
                *value = upper ? 1.0f : 0.0f;
            else if (material->inputs[shapes[k].input].texture && !upper)
                *value = shapes[k].least;
        }
        float at = stack_of(&surface, &choices).albedo_coord;
        *low = min(*low, at);
        *high = max(*high, at);
    }
}

/* Returns the index of a table that serves a sheen, or -1. */
static int table_that_serves(const SheenTables *self, const Lobe *lobe, float low, float high, bool scaled) {
    for (int k = 0; self && k < self->table_count; k++)
        if (albedo_table_serves(self->tables[k], lobe, low, high, scaled)) return k;
    return -1;
}

/* Sets the index of the table of a material's sheen, or -1. The table is that of an earlier material with the same
 * sheen over the same range, or one of `before`, which may be NULL, or is made. */
static WeftResult find_table(SheenTables *self, const SheenTables *before, const Material *material, int threads,
                             int *index, WeftError *error) {
    const Surface untextured = material_plain(material);
    const Choices choices = material_choices(material);
    *index = -1;
    Stack most = stack_of(&untextured, &choices);
    if (!HAS_SHEEN(&most) && most.layer != LAYER_MULTIPLICATIVE) return WEFT_OK;
    if (!albedo_is_own(most.albedo)) {
        stack_albedo(&most, dir(0.0f, 0.0f, 1.0f)); /* an engine's own, made before any threads start */
        return WEFT_OK;
    }
    Lobe lobe = most.sheen.lobe;
    bool scaled = material->inputs[INPUT_nap].texture != 0;
    float low, high;
    table_range(material, self->table_count >= NARROW_TABLES, &low, &high);
    *index = table_that_serves(self, &lobe, low, high, scaled);
    if (*index >= 0) return WEFT_OK;
    int kept = before ? table_that_serves(before, &lobe, low, high, scaled) : -1;
    AlbedoTable *table = kept >= 0 ? before->tables[kept] : alloc_array(1, sizeof(AlbedoTable));
    if (!table) return fail(error, WEFT_MESSAGE_MEMORY, "a sheen's table", NULL);
    if (kept < 0) (scaled ? albedo_table_fill_tilts : albedo_table_fill)(table, &lobe, low, high, threads);
    *index = self->table_count;
    self->tables[self->table_count++] = table;
    return WEFT_OK;
}

/* Finds the tables of all used materials. used: zero flags, set for materials of meshes. */
static WeftResult find_all(SheenTables *self, const SheenTables *before, const WeftScene *scene, bool *used,
                           int threads, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int m = 0; m < scene->mesh_count; m++) {
        const int back = scene_back(scene, scene->meshes[m].material);
        used[scene->meshes[m].material] = true;
        if (back >= 0) used[back] = true;
    }
    for (int k = 0; k < scene_shaded_materials(scene) && result == WEFT_OK; k++) {
        self->index[k] = -1;
        if (used[k]) result = find_table(self, before, &scene->materials[k], threads, &self->index[k], error);
    }
    return result;
}

void sheen_tables_free_but(SheenTables *self, const SheenTables *kept) {
    if (!self) return;
    for (int k = 0; k < self->table_count; k++) {
        bool shared = false;
        for (int j = 0; kept && j < kept->table_count; j++) shared |= kept->tables[j] == self->tables[k];
        if (!shared) free(self->tables[k]);
    }
    free(self->tables);
    free(self->index);
    free(self);
}

WeftResult sheen_tables_renew(const SheenTables *before, const WeftScene *scene, int threads, SheenTables **out,
                              WeftError *error) {
    size_t count = (size_t)scene_shaded_materials(scene);
    SheenTables *self = alloc_array(1, sizeof *self);
    bool *used = alloc_array(count, sizeof(bool));
    if (self) {
        self->tables = alloc_array(count, sizeof(AlbedoTable *));
        self->index = alloc_array(count, sizeof(int));
    }
    bool allocated = used && self && self->tables && self->index;
    WeftResult result = allocated ? find_all(self, before, scene, used, threads, error)
                                  : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    free(used);
    if (result != WEFT_OK) {
        sheen_tables_free_but(self, before);
        self = NULL;
    }
    *out = self;
    return result;
}

WeftResult sheen_tables_create(const WeftScene *scene, int threads, SheenTables **out, WeftError *error) {
    return sheen_tables_renew(NULL, scene, threads, out, error);
}

bool sheen_tables_differ(const SheenTables *self, const SheenTables *other) {
    bool differ = self->table_count != other->table_count;
    for (int k = 0; k < self->table_count && !differ; k++) differ = self->tables[k] != other->tables[k];
    return differ;
}

void sheen_tables_free(SheenTables *self) { sheen_tables_free_but(self, NULL); }

int sheen_tables_count(const SheenTables *self) { return self->table_count; }
const AlbedoTable *sheen_tables_at(const SheenTables *self, int index) { return self->tables[index]; }
int sheen_tables_index(const SheenTables *self, int material) { return self->index[material]; }

TableRef sheen_tables_of(const SheenTables *self, int material) {
    int k = self->index[material];
    return k < 0 ? (TableRef){.kind = TABLE_NONE} : albedo_table_ref(self->tables[k]);
}
