#include <stdlib.h>

#include "raster/material/families.h"

#include "base/equal.h"
#include "base/fail.h"

typedef struct Families {
    const WeftScene *scene;
    const GlTextures *textures;
    GlMaterial *all;
    int *head;   /* of each material: the first of its family, or -1 where it is not used */
    int *groups; /* of textures, for each slot and material; -1: nothing there */
} Families;

/* Returns the group of an input's texture, or for k from INPUT_COUNT on of the slopes of that of input k - INPUT_COUNT;
 * or -1. */
static int group_of(const Families *self, int m, int k) {
    const Material *material = &self->scene->materials[m];
    const int of = k % INPUT_COUNT;
    const Input *input = &material->inputs[of];
    const TextureUse use = k < INPUT_COUNT ? textures_use(material, of) : TEXTURE_SLOPES;
    return input->texture ? textures_place(self->textures, input, use).group : -1;
}

static bool same_texel(const Material *material, int j, int k) {
    const Input *a = &material->inputs[j], *b = &material->inputs[k];
    if (!a->texture || !b->texture) return !a->texture == !b->texture;
    bool same = a->texture == b->texture && a->texcoord == b->texcoord &&
                textures_use(material, j) == textures_use(material, k);
    for (int n = 0; n < 6; n++) same &= is_equal(a->transform[n], b->transform[n]);
    return same;
}

/* Returns true if in every material of a family inputs k and j read the same texel, or neither has a map. */
static bool all_like(const Families *self, int head, int j, int k) {
    bool like = shader_same_neutral(j, k);
    for (int m = 0; m < scene_shaded_materials(self->scene) && like; m++)
        if (self->head[m] == head) like = same_texel(&self->scene->materials[m], j, k);
    return like;
}

/* Returns true if a slot also serves input k: the materials that use both use the same place, and at least
 * one uses both. */
static bool slot_serves(const Families *self, int head, const int *slot, int k) {
    bool some = false;
    for (int m = 0; m < scene_shaded_materials(self->scene); m++) {
        int group = self->head[m] == head ? group_of(self, m, k) : -1;
        if (group < 0 || slot[m] < 0) continue;
        if (group != slot[m]) return false;
        some = true;
    }
    return some;
}

/* Returns the slot of texture k as group_of has it, which may be a new one; TEXTURE_SLOTS if there are too few. */
static int take_slot(Families *self, int head, int k, int *slots) {
    const int count = scene_shaded_materials(self->scene);
    int slot = 0;
    while (slot < *slots && !slot_serves(self, head, self->groups + slot * count, k)) slot++;
    if (slot == TEXTURE_SLOTS) return slot;
    if (slot == *slots) (*slots)++;
    for (int m = 0; m < count; m++)
        if (self->head[m] == head && group_of(self, m, k) >= 0) self->groups[slot * count + m] = group_of(self, m, k);
    return slot;
}

/* Returns true if some material of a family has the slopes of a normal map. */
static bool has_slopes(const Families *self, int head, int k) {
    bool some = false;
    for (int m = 0; m < scene_shaded_materials(self->scene); m++)
        some |= self->head[m] == head && input_infos[k].kind == WEFT_INPUT_NORMAL &&
                group_of(self, m, INPUT_COUNT + k) >= 0;
    return some;
}

/* Gives the slopes of normal maps the slots that are left. Without one, a map is drawn by its mean normals. */
static void find_slope_slots(Families *self, int head, ShaderKey *key, int *slots) {
    for (int k = 0; k < INPUT_COUNT; k++) {
        key->inputs[k].slopes = 0;
        if (!has_slopes(self, head, k)) continue;
        const int slot = take_slot(self, head, INPUT_COUNT + k, slots);
        if (slot < TEXTURE_SLOTS) key->inputs[k].slopes = (int16_t)(slot + 1);
    }
}

/* Gives each map of a family's key its slot. Returns the number of slots, or TEXTURE_SLOTS + 1 if there are too few. */
static int find_slots(Families *self, int head, ShaderKey *key) {
    int count = scene_shaded_materials(self->scene), slots = 0;
    for (int k = 0; k < TEXTURE_SLOTS * count; k++) self->groups[k] = -1;
    for (int k = 0; k < INPUT_COUNT; k++) {
        ShaderInput *input = &key->inputs[k];
        if (input->state != INPUT_MAP && input->state != INPUT_MAYBE) continue;
        input->like = -1;
        for (int j = k - 1; j >= 0; j--)
            if (key->inputs[j].like < 0 && all_like(self, head, j, k)) input->like = (int16_t)j;
        const int slot = take_slot(self, head, k, &slots);
        if (slot == TEXTURE_SLOTS) return TEXTURE_SLOTS + 1;
        input->slot = (int16_t)slot;
    }
    find_slope_slots(self, head, key, &slots);
    return slots;
}

/* Puts a material into the first family that it fits, or into one of its own. */
static void join(Families *self, int m) {
    for (int h = 0; h < m; h++) {
        ShaderKey key = self->all[h].key;
        if (self->head[h] != h || !shader_join(&key, &self->all[m].key)) continue;
        self->head[m] = h;
        if (find_slots(self, h, &key) <= TEXTURE_SLOTS) {
            self->all[h].key = key;
            return;
        }
    }
    self->head[m] = m;
}

/* Gives all materials of a family the finest detail of their tables, since one program serves narrow and broad
 * lobes. */
static void share_finest(Families *self, int head) {
    float finest[SLOT_COUNT] = {0.0f};
    for (int pass = 0; pass < 2; pass++)
        for (int m = 0; m < scene_shaded_materials(self->scene); m++)
            for (int k = 0; self->head[m] == head && k < SLOT_COUNT; k++) {
                float *own = &self->all[m].finest[k];
                if (pass)
                    *own = finest[k];
                else if (*own > finest[k])
                    finest[k] = *own;
            }
}

/* Gives the materials of a family its key and groups. Returns false if they need more than TEXTURE_SLOTS groups. */
static bool finish(Families *self, int head) {
    int count = scene_shaded_materials(self->scene), slots = find_slots(self, head, &self->all[head].key);
    if (slots > TEXTURE_SLOTS) return false;
    for (int m = 0; m < count; m++) {
        if (self->head[m] != head) continue;
        GlMaterial *material = &self->all[m];
        material->key = self->all[head].key;
        material->group_count = slots;
        for (int s = 0; s < slots; s++) {
            const int *slot = self->groups + s * count;
            int other = m;
            while (slot[other] < 0) other = (other + 1) % count;
            material->groups[s] = slot[other];
        }
    }
    share_finest(self, head);
    return true;
}

static bool make_all(Families *self) {
    int count = scene_shaded_materials(self->scene);
    bool fits = true;
    for (int m = 0; m < count; m++) self->head[m] = -1;
    for (int m = 0; m < count; m++)
        if (self->all[m].used) join(self, m);
    for (int m = 0; m < count; m++)
        if (self->head[m] == m) fits = fits && finish(self, m);
    return fits;
}

WeftResult families_make(const WeftScene *scene, const GlTextures *textures, GlMaterial *all, WeftError *error) {
    size_t count = (size_t)scene_shaded_materials(scene);
    Families self = {scene, textures, all, alloc_array(count, sizeof(int)),
                     alloc_array(count, TEXTURE_SLOTS * sizeof(int))};
    bool allocated = self.head && self.groups, fits = allocated && make_all(&self);
    free(self.head);
    free(self.groups);
    if (!allocated) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    return fits ? WEFT_OK
                : fail(error, WEFT_MESSAGE_GL_MEMORY, scene->name,
                       "a material whose textures are of more than %d kinds", TEXTURE_SLOTS);
}
