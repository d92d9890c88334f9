#include <stddef.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/material/materials.h"

#include <epoxy/gl.h>

#include "base/equal.h"
#include "base/fail.h"
#include "raster/gl/gl_check.h"
#include "raster/material/cloth_sky.h"
#include "raster/material/families.h"
#include "raster/material/programs.h"
#include "scene/light/pane.h"
#include "scene/light/polygons.h"
#include "scene/material/hair.h"
#include "scene/record/material_at.h"

/* The block "Material" of the shaders. */
typedef struct Uniforms {
    MaterialVector inputs[INPUT_COUNT];
#define MEMBER(type, name, count) type name[count];
    MATERIAL_BLOCK(MEMBER)
#undef MEMBER
} Uniforms;

_Static_assert((int)CLOTH_SKY <= (int)AMBIENT_BAKED, "in the place of a table");

/* OpenGL ES 3.0 guarantees no more. */
_Static_assert(sizeof(Uniforms) <= 16384, "the block of a material is too large");

static bool is_all(const Input *input, int count, float x) {
    bool all = true;
    for (int c = 0; c < count; c++) all &= is_equal(input->value[c], x);
    return all;
}

static InputState state_of(const Input *input, WeftInputKind kind) {
    int count = kind == WEFT_INPUT_COLOR ? 3 : 1;
    if (input->texture) return INPUT_MAP;
    if (is_all(input, count, 0.0f)) return INPUT_ZERO;
    return kind != WEFT_INPUT_ANGLE && kind != WEFT_INPUT_DIRECTION && is_all(input, count, 1.0f) ? INPUT_ONE
                                                                                                  : INPUT_VALUE;
}

static void add_map(GlMaterial *self, const GlTextures *textures, const Material *material, int k, Uniforms *uniforms) {
    const Input *input = &material->inputs[k];
    TexturePlace at = textures_place(textures, input, textures_use(material, k));
    TexturePlace slopes = textures_place(textures, input, TEXTURE_SLOPES);
    self->key.inputs[k].channel = (int16_t)input->channel;
    self->key.inputs[k].texcoord = (int16_t)input->texcoord;
    for (int row = 0; row < 2; row++)
        for (int c = 0; c < 3; c++) uniforms->places[2 * k + row][c] = input->transform[3 * row + c];
    uniforms->places[2 * k][3] = (float)at.layer;
    if (input_infos[k].kind == WEFT_INPUT_NORMAL) {
        uniforms->places[2 * k + 1][3] = (float)(slopes.group < 0 ? -1 : slopes.layer);
        uniforms->inputs[k][1] = textures_slopes_level(textures, input);
    }
    uniforms->inputs[k][3] = 1.0f;
}

/* Returns an input as it is drawn: threads are no glass. */
static Input input_drawn(const Material *material, int k) {
    Input input = material->inputs[k];
    if (k == INPUT_transmission && material->cloth) input = (Input){.channel = input.channel};
    return input;
}

static void add_input(GlMaterial *self, const GlTextures *textures, const Material *material, int k,
                      Uniforms *uniforms) {
    const Input drawn = input_drawn(material, k), *input = &drawn;
    WeftInputKind kind = input_infos[k].kind;
    self->key.inputs[k].state = (int16_t)state_of(input, kind);
    self->key.inputs[k].like = -1;
    for (int c = 0; c < 3; c++) uniforms->inputs[k][c] = input->value[c];
    if (kind == WEFT_INPUT_DIRECTION) {
        uniforms->inputs[k][0] = cos(input->value[0]);
        uniforms->inputs[k][1] = sin(input->value[0]);
    }
    if (input->texture) add_map(self, textures, material, k, uniforms);
}

static void add_table(GlMaterial *self, TableRef e, int layer, Uniforms *uniforms) {
    self->key.table_kind = e.kind;
    self->key.table_rows = e.rows;
    self->key.table_columns = e.columns;
    self->key.table_tilts = e.tilts;
    const float place[4] = {(float)layer, e.low, e.high, e.tilt};
    memcpy(uniforms->e[0], place, sizeof place);
}

/* Returns the surface of a material with half of each textured number, the middle of what its textures may give. */
static Surface middle_surface(const Material *material) {
    Material middle = *material;
    for (int k = 0; k < INPUT_COUNT; k++)
        for (int c = 0; c < 3 && input_infos[k].kind != WEFT_INPUT_DIRECTION; c++)
            if (middle.inputs[k].texture) middle.inputs[k].value[c] *= 0.5f;
    return material_plain(&middle);
}

/* Bakes the table of a slot, unless its lobe or its cloth is as before. cloth: NULL for a lobe. Returns false if memory
 * is short. */
static bool bake_slot(GlMaterial *self, int slot, const Lobe *lobe, const WeftCloth *cloth, int threads,
                      AmbientFit *fit, Uniforms *uniforms) {
    MaterialFit *baked = &self->fits[slot];
    const int number = cloth ? self->cloth : 0;
    bool made = true;
    if (baked->made && baked->cloth == number && (cloth || ambient_alike(&baked->lobe, lobe))) return true;
    if (cloth)
        made = cloth_sky_fit(cloth, threads, fit, uniforms->fits + SHADER_CLOTH_SKY);
    else
        ambient_fit(fit, lobe, lobe->params[0], lobe->params[0], threads);
    if (!made) return false;
    ambient_bake(fit, uniforms->fits + slot * AMBIENT_BAKED);
    *baked = (MaterialFit){true, fit->by_azimuth, fit->denser > AMBIENT_DENSER, fit->finest, *lobe, number};
    return true;
}

/* Bakes the tables of the slots whose first parameter is constant. The sky of a cloth lies where a specular lobe has its
 * table, so that each makes the other be baked again. Returns false if memory is short. */
static bool add_fits(GlMaterial *self, const Material *material, const WeftCloth *cloth, int threads,
                     Uniforms *uniforms) {
    AmbientFit *fit = alloc_array(1, sizeof *fit);
    Surface surface = middle_surface(material);
    bool made = true;
    Stack m;
    if (!fit) return false;
    stack_make(&m, &surface, &self->key.choices, (TableRef){.kind = TABLE_NONE});
    if (cloth) self->fits[PLACE_SPECULAR].made = false;
    if (!cloth && self->fits[PLACE_DIFFUSE].cloth) self->fits[PLACE_DIFFUSE].made = false;
    for (int k = 0; k < SLOT_COUNT && made; k++) {
        const WeftCloth *own = k == PLACE_DIFFUSE ? cloth : NULL;
        if (!(own || stack_slot(&m, k)->normal > 0.0f) || !shader_bakes(&self->key, k)) continue;
        made = bake_slot(self, k, &stack_slot(&m, k)->lobe, own, threads, fit, uniforms);
        self->finest[k] = self->fits[k].finest;
        self->key.by_azimuth |= self->fits[k].by_azimuth << k;
        self->key.dense |= self->fits[k].dense << k;
    }
    free(fit);
    return made;
}

/* Fitting tables for a lobe's own numbers takes tens of ms. With more materials than these, all share tables over the
 * range of the parameter; these have no nap and anisotropy, so materials with either are baked all the same. */
enum { MATERIALS_BAKED = 100 };

static bool is_isotropic(const ShaderKey *key) {
    return key->inputs[INPUT_anisotropy].state == INPUT_ZERO && key->inputs[INPUT_nap].state == INPUT_ZERO;
}

static void make_material(GlMaterial *self, const Material *material, const GlTextures *textures, Uniforms *uniforms) {
    self->key.choices = material_choices(material);
    self->key.alpha_mode = (int)material->alpha_mode;
    self->key.unlit = material->unlit;
    self->key.double_sided = material->double_sided;
    self->key.woven = material->cloth != 0;
    for (int k = 0; k < INPUT_COUNT; k++) add_input(self, textures, material, k, uniforms);
    uniforms->more[0][0] = material->alpha_cutoff;
    uniforms->more[0][1] = hair_lets_through(material);
    self->key.haired = uniforms->more[0][1] < 1.0f;
}

static void use(GlMaterial *material, const Mesh *mesh) {
    material->used = true;
    material->key.colored |= mesh->color != NULL;
}

/* Returns true if a pane lets through more than half of the light straight onto it. One with a map, as a window with its
 * frame, may not everywhere. */
static bool is_clear(const WeftScene *scene, int k) {
    static const InputId mapped[] = {INPUT_transmission, INPUT_base_color, INPUT_metallic};
    for (size_t m = 0; m < sizeof mapped / sizeof *mapped; m++)
        if (scene->materials[k].inputs[mapped[m]].texture) return false;
    return rgb_mean(pane_transmittance(scene, k, NULL, NULL, 1.0f)) > 0.5f;
}

/* Makes keys and uniforms of all materials, with the fits of the old ones. Returns false if memory is short. */
static bool take(GlMaterials *self, const GlMaterials *old, const WeftScene *scene, const GlTextures *textures,
                 int threads) {
    bool whole = true;
    for (int m = 0; m < scene->mesh_count; m++) {
        const int k = self->of_mesh[m] = scene->meshes[m].material, back = scene_back(scene, k);
        use(&self->all[k], &scene->meshes[m]);
        if (back >= 0) use(&self->all[back], &scene->meshes[m]);
    }
    for (int k = 0; k < self->count; k++) {
        Uniforms uniforms = {0};
        GlMaterial *material = &self->all[k];
        size_t at = (size_t)k * (size_t)self->stride;
        if (k < old->count) {
            memcpy(material->fits, old->all[k].fits, sizeof material->fits);
            memcpy(uniforms.fits, old->blocks + at + offsetof(Uniforms, fits), sizeof uniforms.fits);
        }
        if (material->used) {
            material->emits = material_emits(&scene->materials[k]);
            material->pane = scene_is_pane(scene, k);
            material->clear = material->pane && is_clear(scene, k);
            self->panes |= material->pane;
            make_material(material, &scene->materials[k], textures, &uniforms);
            material->key.hairy = hair_is_material(scene, k);
            material->key.ranged = self->count > MATERIALS_BAKED && is_isotropic(&material->key);
            add_table(material, sheen_tables_of(self->sheens, k), sheen_tables_index(self->sheens, k), &uniforms);
            material->cloth = scene->materials[k].cloth;
            const WeftCloth *cloth = scene_cloth_of(scene, &scene->materials[k]);
            if (cloth) cloth_numbers(cloth, (float *)uniforms.weave);
            whole &= add_fits(material, &scene->materials[k], cloth, threads, &uniforms);
        }
        memcpy(self->blocks + at, &uniforms, sizeof uniforms);
    }
    return whole;
}

static bool is_same(const GlMaterial *a, const GlMaterial *b) {
    return memcmp((const char *)&a->key, (const char *)&b->key, sizeof a->key) == 0 &&
           a->group_count == b->group_count && memcmp(a->groups, b->groups, sizeof a->groups) == 0 &&
           a->used == b->used && a->emits == b->emits && a->cloth == b->cloth;
}

static void add_change(const GlMaterial *old, const GlMaterial *fresh, MaterialsChange *change) {
    change->coverage |= old->key.alpha_mode != WEFT_ALPHA_OPAQUE || fresh->key.alpha_mode != WEFT_ALPHA_OPAQUE ||
                        old->key.double_sided != fresh->key.double_sided || old->pane || fresh->pane;
    change->emission |= old->emits || fresh->emits;
}

/* Uploads changed materials, and sets what has changed. */
static void upload(const GlMaterials *old, const GlMaterials *fresh, int own_meshes, MaterialsChange *change) {
    static const GlMaterial none;
    size_t used = (size_t)own_meshes * sizeof *fresh->of_mesh;
    change->tables = !old->sheens || sheen_tables_differ(old->sheens, fresh->sheens);
    change->coverage = change->emission = memcmp(old->of_mesh, fresh->of_mesh, used) != 0;
    change->emission |= old->mesh_count != fresh->mesh_count;
    glBindBuffer(GL_UNIFORM_BUFFER, fresh->uniforms);
    for (int k = 0; k < fresh->count; k++) {
        size_t at = (size_t)k * (size_t)fresh->stride;
        const unsigned char *block = fresh->blocks + at;
        const GlMaterial *before = k < old->count ? &old->all[k] : &none;
        bool same = old->uploaded && k < old->count && memcmp(old->blocks + at, block, sizeof(Uniforms)) == 0;
        if (!same || !is_same(before, &fresh->all[k])) add_change(before, &fresh->all[k], change);
        if (!same || fresh->uniforms != old->uniforms)
            glBufferSubData(GL_UNIFORM_BUFFER, (GLintptr)at, (GLsizeiptr)sizeof(Uniforms), block);
    }
}

/* Allocates the records of materials, all zero. */
static WeftResult allocate(GlMaterials *self, const WeftScene *scene, WeftError *error) {
    self->all = alloc_array((size_t)self->count, sizeof(GlMaterial));
    self->blocks = alloc_array((size_t)self->count, (size_t)self->stride);
    self->of_mesh = alloc_array((size_t)scene->mesh_count, sizeof(int));
    self->mesh_count = scene->mesh_count;
    bool allocated = self->all && self->blocks && self->of_mesh;
    return allocated ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

static void make_uniforms(GlMaterials *self) {
    glGenBuffers(1, &self->uniforms);
    glBindBuffer(GL_UNIFORM_BUFFER, self->uniforms);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)self->count * self->stride, NULL, GL_DYNAMIC_DRAW);
}

/* Frees everything that another record does not have too. */
static void free_unshared(GlMaterials *self, const GlMaterials *other) {
    sheen_tables_free_but(self->sheens, other ? other->sheens : NULL);
    free(self->all);
    free(self->blocks);
    free(self->of_mesh);
}

WeftResult materials_update(GlMaterials *self, const WeftScene *scene, const GlTextures *textures, int threads,
                            MaterialsChange *change, WeftError *error) {
    GlMaterials fresh = *self;
    *change = (MaterialsChange){0};
    fresh.sheens = NULL;
    fresh.panes = false;
    fresh.count = scene_shaded_materials(scene);
    WeftResult result = allocate(&fresh, scene, error);
    if (fresh.count != self->count) make_uniforms(&fresh);
    if (result == WEFT_OK) result = cloths_update(&self->cloths, scene, error);
    fresh.cloths = self->cloths;
    if (result == WEFT_OK) result = sheen_tables_renew(self->sheens, scene, threads, &fresh.sheens, error);
    if (result == WEFT_OK && !take(&fresh, self, scene, textures, threads))
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK) result = families_make(scene, textures, fresh.all, error);
    if (result == WEFT_OK) {
        upload(self, &fresh, scene_own_meshes(scene), change);
        result = gl_check(error, "materials");
        self->uploaded = fresh.uploaded = result == WEFT_OK;
    }
    if (fresh.count != self->count) glDeleteBuffers(1, result == WEFT_OK ? &self->uniforms : &fresh.uniforms);
    free_unshared(result == WEFT_OK ? self : &fresh, result == WEFT_OK ? &fresh : self);
    if (result == WEFT_OK) *self = fresh;
    return result;
}

static WeftResult make_buffer(GlMaterials *self, const WeftScene *scene, WeftError *error) {
    GLint aligned = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &aligned);
    self->count = scene_shaded_materials(scene);
    self->stride = ((int)sizeof(Uniforms) + aligned - 1) / aligned * aligned;
    WeftResult result = allocate(self, scene, error);
    if (result == WEFT_OK) make_uniforms(self);
    return result;
}

WeftResult materials_create(const WeftScene *scene, const GlTextures *textures, int threads, GlMaterials *out,
                            WeftError *error) {
    MaterialsChange change;
    *out = (GlMaterials){0};
    WeftResult result = make_buffer(out, scene, error);
    if (result == WEFT_OK) result = materials_update(out, scene, textures, threads, &change, error);
    if (result != WEFT_OK) materials_destroy(out);
    return result;
}

void materials_destroy(GlMaterials *self) {
    if (self->uniforms) glDeleteBuffers(1, &self->uniforms);
    cloths_destroy(&self->cloths);
    free_unshared(self, NULL);
    *self = (GlMaterials){0};
}

void material_in_light(const GlMaterial *self, float env_light_kappa, ShaderKey *key) {
    key->focus = key->narrow = 0;
    for (int k = 0; k < SLOT_COUNT; k++) {
        key->focus |= (self->finest[k] > AMBIENT_CLOSE - AMBIENT_BLEND) << k;
        key->narrow |= (self->finest[k] > env_light_kappa - AMBIENT_FINER - AMBIENT_BLEND) << k;
    }
}

void materials_bind(const GlMaterials *self, const GlTextures *textures, int material, int block) {
    const GlMaterial *m = &self->all[material];
    for (int k = 0; k < m->group_count; k++) textures_bind(textures, m->groups[k], k);
    if (m->cloth) cloths_bind(&self->cloths, m->cloth, UNIT_CLOTH_CELLS, UNIT_CLOTH_COLORS);
    glBindBufferRange(GL_UNIFORM_BUFFER, (GLuint)block, self->uniforms, (GLintptr)material * self->stride,
                      (GLsizeiptr)sizeof(Uniforms));
}
