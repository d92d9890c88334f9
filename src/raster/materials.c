#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/materials.h"

#include <epoxy/gl.h>

#include "base/fail.h"
#include "raster/check.h"
#include "raster/families.h"
#include "scene/shade.h"

/* The block "Material" of shader.c. */
typedef struct Uniforms {
    float inputs[INPUT_COUNT][4]; /* w: 1 where it has a map */
    float places[INPUT_COUNT][2][4];
    float e[4];    /* layer, low, high, tilt */
    float more[4]; /* alpha cutoff */
    AmbientWeights fits[SHADER_SLOTS * AMBIENT_HELD];
} Uniforms;

static bool is_all(const Input *input, int count, float x) {
    bool all = true;
    for (int c = 0; c < count; c++) all &= !(input->value[c] < x) && !(input->value[c] > x);
    return all;
}

static InputState state_of(const Input *input, InputKind kind) {
    int count = kind == INPUT_COLOR ? 3 : 1;
    if (input->texture) return INPUT_MAP;
    if (is_all(input, count, 0.0f)) return INPUT_ZERO;
    return kind != INPUT_ANGLE && kind != INPUT_DIRECTION && is_all(input, count, 1.0f) ? INPUT_ONE
                                                                                        : INPUT_VALUE;
}

static void add_map(GlMaterial *self, const GlTextures *textures, const Material *material, int k,
                    Uniforms *uniforms) {
    const Input *input = &material->inputs[k];
    TexturePlace at = textures_place(textures, input, textures_color(material, k));
    self->key.inputs[k].channel = (int16_t)input->channel;
    self->key.inputs[k].texcoord = (int16_t)input->texcoord;
    for (int row = 0; row < 2; row++)
        for (int c = 0; c < 3; c++) uniforms->places[k][row][c] = input->transform[3 * row + c];
    uniforms->places[k][0][3] = (float)at.layer;
    uniforms->inputs[k][3] = 1.0f;
}

static void add_input(GlMaterial *self, const GlTextures *textures, const Material *material, int k,
                      Uniforms *uniforms) {
    const Input *input = &material->inputs[k];
    InputKind kind = input_infos[k].kind;
    self->key.inputs[k].state = (int16_t)state_of(input, kind);
    self->key.inputs[k].like = -1;
    for (int c = 0; c < 3; c++) uniforms->inputs[k][c] = input->value[c];
    if (kind == INPUT_DIRECTION) {
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
    memcpy(uniforms->e, place, sizeof place);
}

/* Holds the tables of the slots whose parameters are numbers. */
static bool add_fits(GlMaterial *self, const Material *material, int threads, Uniforms *uniforms) {
    AmbientFit *fit = alloc_array(1, sizeof *fit);
    Surface surface = material_plain(material);
    Stack m;
    if (!fit) return false;
    stack_make(&m, &surface, &self->key.choices, (TableRef){.kind = TABLE_NONE}, dir(0.0f, 0.0f, 1.0f));
    const Slot *const slots[SHADER_SLOTS] = {&m.diffuse, &m.specular, &m.sheen, &m.coat, &m.dust};
    for (int k = 0; k < SHADER_SLOTS; k++) {
        const Lobe *lobe = &slots[k]->lobe;
        if (!(slots[k]->pick > 0.0f) || !shader_holds(&self->key, k)) continue;
        ambient_fit(fit, lobe, lobe->params[0], lobe->params[0], threads);
        ambient_hold(fit, uniforms->fits + k * AMBIENT_HELD);
        self->finest[k] = fit->finest;
        self->key.turning |= fit->turning << k;
    }
    free(fit);
    return true;
}

static void make_material(GlMaterial *self, const Material *material, const GlTextures *textures,
                          Uniforms *uniforms) {
    self->key.choices = material_choices(material);
    self->key.alpha_mode = (int)material->alpha_mode;
    self->key.unlit = material->unlit;
    self->key.double_sided = material->double_sided;
    for (int k = 0; k < INPUT_COUNT; k++) add_input(self, textures, material, k, uniforms);
    uniforms->more[0] = material->alpha_cutoff;
}

static WeftResult make_uniforms(GlMaterials *self, const WeftScene *scene, const GlTextures *textures,
                                int threads, WeftError *error) {
    GLint aligned = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &aligned);
    self->stride = ((int)sizeof(Uniforms) + aligned - 1) / aligned * aligned;
    size_t stride = (size_t)self->stride, count = (size_t)self->count;
    unsigned char *all = alloc_array(count, stride);
    if (!all) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    bool whole = true;
    for (size_t k = 0; k < count; k++) {
        Uniforms uniforms = {0};
        GlMaterial *material = &self->all[k];
        if (material->worn) {
            make_material(material, &scene->materials[k], textures, &uniforms);
            add_table(material, sheen_tables_of(self->sheens, (int)k),
                      sheen_tables_index(self->sheens, (int)k), &uniforms);
            whole &= add_fits(material, &scene->materials[k], threads, &uniforms);
        }
        memcpy(all + k * stride, &uniforms, sizeof uniforms);
    }
    glBindBuffer(GL_UNIFORM_BUFFER, self->uniforms);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)(count * stride), all, GL_STATIC_DRAW);
    free(all);
    if (!whole) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    return gl_check(error, "materials");
}

WeftResult materials_create(const WeftScene *scene, const GlTextures *textures, int threads, GlMaterials *out,
                            WeftError *error) {
    *out = (GlMaterials){.count = scene->material_count};
    out->all = alloc_array((size_t)scene->material_count, sizeof(GlMaterial));
    if (!out->all) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int m = 0; m < scene->mesh_count; m++) {
        GlMaterial *material = &out->all[scene->meshes[m].material];
        material->worn = true;
        material->key.colored |= scene->meshes[m].color != NULL;
    }
    glGenBuffers(1, &out->uniforms);
    WeftResult result = sheen_tables_create(scene, threads, &out->sheens, error);
    if (result == WEFT_OK) result = make_uniforms(out, scene, textures, threads, error);
    if (result == WEFT_OK) result = families_make(scene, textures, out->all, error);
    if (result != WEFT_OK) materials_destroy(out);
    return result;
}

void materials_destroy(GlMaterials *self) {
    if (self->uniforms) glDeleteBuffers(1, &self->uniforms);
    sheen_tables_free(self->sheens);
    free(self->all);
    *self = (GlMaterials){0};
}

void material_in_light(const GlMaterial *self, float lamp_kappa, ShaderKey *key) {
    key->focus = key->narrow = 0;
    for (int k = 0; k < SHADER_SLOTS; k++) {
        key->focus |= (self->finest[k] > AMBIENT_CLOSE - AMBIENT_BLEND) << k;
        key->narrow |= (self->finest[k] > lamp_kappa - AMBIENT_FINER - AMBIENT_BLEND) << k;
    }
}

void materials_bind(const GlMaterials *self, const GlTextures *textures, int material, int block) {
    const GlMaterial *m = &self->all[material];
    for (int k = 0; k < m->group_count; k++) textures_bind(textures, m->groups[k], k);
    glBindBufferRange(GL_UNIFORM_BUFFER, (GLuint)block, self->uniforms, (GLintptr)material * self->stride,
                      (GLsizeiptr)sizeof(Uniforms));
}
