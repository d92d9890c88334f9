#include "raster/material/textures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/thread.h"
#include "image/halve.h"
#include "raster/gl/gl_check.h"
#include "raster/material/slopes.h"
#include "weft/progress.h"

typedef struct Plan {
    const WeftScene *scene;
    TextureGroup *groups;
    int count;
    int side_most;   /* of the driver */
    int layers_most; /* likewise */
    bool one_size;
    TexturePlace *places;
} Plan;

TextureUse textures_use(const Material *material, int input) {
    const Input *i = &material->inputs[input];
    /* opacity is the alpha of a colour texture: the same texels, and alpha is never decoded */
    bool color = input_infos[input].kind == WEFT_INPUT_COLOR || (input == INPUT_opacity && i->channel == 3);
    return color ? TEXTURE_COLORS : TEXTURE_NUMBERS;
}

static GLenum format_of(const WeftImage *image, TextureUse use) {
    if (image->type == WEFT_PIXEL_U8 && use != TEXTURE_SLOPES)
        return use == TEXTURE_COLORS ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    return GL_RGBA16F; /* OpenGL ES 3.0 has no 16-bit integers that are filtered */
}

static bool same_group(bool one_size, const TextureGroup *a, const TextureGroup *b) {
    bool size = one_size || (a->width == b->width && a->height == b->height);
    return size && a->format == b->format && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
           a->nearest == b->nearest;
}

/* Returns the properties of the group that a texture needs. */
static TextureGroup group_for(const WeftScene *scene, int texture, TextureUse use, int side_most) {
    const Texture *t = &scene->textures[texture];
    const WeftImage *image = &scene->images[t->image];
    int width = image->width, height = image->height;
    if (use == TEXTURE_SLOPES) slopes_size(&width, &height);
    return (TextureGroup){.width = width < side_most ? width : side_most,
                          .height = height < side_most ? height : side_most,
                          .format = format_of(image, use),
                          .wrap_u = t->wrap_u,
                          .wrap_v = t->wrap_v,
                          .nearest = t->nearest};
}

static void place(Plan *plan, int texture, TextureUse use) {
    TexturePlace *at = &plan->places[TEXTURE_USES * texture + (int)use];
    if (at->group >= 0) return;
    TextureGroup group = group_for(plan->scene, texture, use, plan->side_most);
    int k = 0;
    while (k < plan->count &&
           !(same_group(plan->one_size, &plan->groups[k], &group) && plan->groups[k].layers < plan->layers_most))
        k++;
    if (k == plan->count) plan->groups[plan->count++] = group;
    TextureGroup *home = &plan->groups[k];
    if (group.width > home->width) home->width = group.width;
    if (group.height > home->height) home->height = group.height;
    *at = (TexturePlace){k, home->layers++};
}

/* Returns the number of groups that a material's maps are in, or -1 if one of them is in none. */
static int count_groups(const TexturePlace *places, int texture_count, const Material *material) {
    int groups[INPUT_COUNT], count = 0;
    for (int k = 0; k < INPUT_COUNT; k++) {
        int texture = material->inputs[k].texture - 1, g = 0;
        if (texture < 0) continue;
        if (texture >= texture_count) return -1;
        int group = places[TEXTURE_USES * texture + (int)textures_use(material, k)].group;
        if (group < 0) return -1;
        while (g < count && groups[g] != group) g++;
        if (g == count) groups[count++] = group;
    }
    return count;
}

/* Places all textures of materials in groups. Returns the most groups that one material needs. */
static int make_plan(Plan *plan) {
    const WeftScene *scene = plan->scene;
    int most = 0;
    plan->count = 0;
    for (int k = 0; k < TEXTURE_USES * scene->texture_count; k++) plan->places[k] = (TexturePlace){-1, 0};
    for (int m = 0; m < scene_shaded_materials(scene); m++) {
        const Material *material = &scene->materials[m];
        for (int k = 0; k < INPUT_COUNT; k++) {
            int texture = material->inputs[k].texture - 1;
            if (texture < 0) continue;
            place(plan, texture, textures_use(material, k));
            const Texture *t = &scene->textures[texture]; /* levels of its own have the slopes in their roughness */
            bool slopes = input_infos[k].kind == WEFT_INPUT_NORMAL && !t->nearest && !texture_levels(t);
            if (slopes) place(plan, texture, TEXTURE_SLOPES);
        }
        int count = count_groups(plan->places, scene->texture_count, material);
        if (count > most) most = count;
    }
    return most;
}

static GLenum wrap_of(TextureWrap wrap) {
    return wrap == WRAP_CLAMP ? GL_CLAMP_TO_EDGE : wrap == WRAP_MIRROR ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

static int levels_of(const TextureGroup *group) {
    int levels = 1;
    for (int side = group->width > group->height ? group->width : group->height; side > 1; side /= 2) levels++;
    return group->nearest ? 1 : levels;
}

static void make_group(GLuint texture, const TextureGroup *group) {
    int levels = levels_of(group);
    bool whole = group->format != GL_RGBA16F;
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    for (int level = 0, w = group->width, h = group->height; level < levels; level++) {
        glTexImage3D(GL_TEXTURE_2D_ARRAY, level, (GLint)group->format, w, h, group->layers, 0, GL_RGBA,
                     whole ? GL_UNSIGNED_BYTE : GL_FLOAT, NULL);
        w = halved(w);
        h = halved(h);
    }
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, (GLint)wrap_of(group->wrap_u));
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, (GLint)wrap_of(group->wrap_v));
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, group->nearest ? GL_NEAREST : GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, group->nearest ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, levels - 1);
}

/* Expands an image of 8 bits to four channels, as texture_fetch reads them. */
static void spread(const WeftImage *image, unsigned char *to) {
    const unsigned char *p = image->pixels;
    size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    size_t g = channels < 3 ? 0 : 1, b = channels < 3 ? 0 : 2;
    for (size_t k = 0; k < count; k++, p += channels, to += 4) {
        to[0] = p[0];
        to[1] = p[g];
        to[2] = p[b];
        to[3] = channels % 2 ? 255 : p[channels - 1];
    }
}

/* Writes an image as four channels in the group's size, which texture_fetch scales it to. Integers of 8 bits stay;
 * others become floats, with colours of 16 bits decoded from sRGB. */
static void put_texels(const WeftScene *scene, int texture, TextureUse use, const TextureGroup *group, void *texels) {
    const WeftImage *image = &scene->images[scene->textures[texture].image];
    bool whole = group->format != GL_RGBA16F;
    bool same = image->width == group->width && image->height == group->height;
    if (whole && same) {
        spread(image, texels);
        return;
    }
    size_t width = (size_t)group->width, height = (size_t)group->height;
    size_t size = whole ? 1 : sizeof(float);
    unsigned char *to = texels;
    Texture direct = scene->textures[texture];
    direct.wrap_u = direct.wrap_v = WRAP_CLAMP;
    if (same) direct.nearest = true;
    const SrgbTable *srgb = use == TEXTURE_COLORS && !whole ? &scene->srgb : NULL;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++, to += 4 * size) {
            Texel t = texture_fetch(&direct, scene->images, srgb, ((float)x + 0.5f) / (float)width,
                                    ((float)y + 0.5f) / (float)height);
            if (!whole) memcpy(to, t.c, sizeof t.c);
            for (size_t c = 0; whole && c < 4; c++) to[c] = (unsigned char)(t.c[c] * 255.0f + 0.5f);
        }
}

/* One layer with its mipmaps, one after the other. */
typedef struct Layer {
    int place; /* of GlTextures.places */
    void *texels;
} Layer;

typedef struct ArrayLayers {
    const Plan *plan;
    Layer items[WEFT_THREADS_MAX];
} ArrayLayers;

static size_t texel_size(const TextureGroup *group) { return group->format == GL_RGBA16F ? 4 * sizeof(float) : 4; }

/* Returns the size of all levels before that one. */
static size_t level_at(const TextureGroup *group, int level) {
    size_t texels = 0;
    for (int w = group->width, h = group->height; level > 0; level--, w = halved(w), h = halved(h))
        texels += (size_t)w * (size_t)h;
    return texels * texel_size(group);
}

/* Returns true if the levels of a group can be those of the texture's file: bytes, in the picture's own size. */
static bool has_own_levels(const WeftScene *scene, int texture, const TextureGroup *group) {
    const Texture *t = &scene->textures[texture];
    const WeftImage *image = &scene->images[t->image];
    const TextureLevels *own = texture_levels(t);
    return own && group->format != GL_RGBA16F && image->width == group->width && image->height == group->height &&
           levels_of(group) == own->count + 1;
}

static void make_layer(void *user, int item, int thread) {
    const ArrayLayers *layers = user;
    const Layer *layer = &layers->items[item];
    const TextureGroup *group = &layers->plan->groups[layers->plan->places[layer->place].group];
    const WeftScene *scene = layers->plan->scene;
    const TextureUse use = (TextureUse)(layer->place % TEXTURE_USES);
    const int texture = layer->place / TEXTURE_USES;
    unsigned char *to = layer->texels;
    if (use == TEXTURE_SLOPES) {
        slopes_make(&scene->images[scene->textures[texture].image], group->width, group->height, layer->texels);
        return;
    }
    put_texels(scene, texture, use, group, to);
    const TextureLevels *own = has_own_levels(scene, texture, group) ? texture_levels(&scene->textures[texture]) : NULL;
    for (int level = 1, w = group->width, h = group->height; level < levels_of(group);
         level++, w = halved(w), h = halved(h)) {
        unsigned char *from = to;
        to += (size_t)w * (size_t)h * texel_size(group);
        if (own)
            spread(&own->images[level - 1], to);
        else if (group->format == GL_RGBA16F)
            halve_f32((const float *)from, w, h, (float *)to);
        else
            halve_u8(from, w, h, group->format == GL_SRGB8_ALPHA8, to);
    }
}

static void upload_layer(const GlTextures *self, const Plan *plan, const Layer *layer) {
    TexturePlace at = plan->places[layer->place];
    const TextureGroup *group = &plan->groups[at.group];
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->groups[at.group]);
    for (int level = 0, w = group->width, h = group->height; level < levels_of(group);
         level++, w = halved(w), h = halved(h))
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, at.layer, w, h, 1, GL_RGBA,
                        group->format == GL_RGBA16F ? GL_FLOAT : GL_UNSIGNED_BYTE,
                        (const unsigned char *)layer->texels + level_at(group, level));
}

static bool is_wanted(const GlTextures *self, const Plan *plan, int place, bool stale) {
    return self->places[place].group >= 0 && (!stale || textures_stale(self, plan->scene, place / TEXTURE_USES));
}

/* Uploads all placed textures, or only the stale ones. As many layers are in memory at once as there are threads. */
static WeftResult fill_groups(GlTextures *self, const Plan *plan, bool stale, int threads, WeftError *error) {
    const WeftScene *scene = plan->scene;
    const int places = TEXTURE_USES * self->texture_count;
    ArrayLayers layers = {.plan = plan};
    WeftResult result = WEFT_OK;
    if (threads <= 0) threads = thread_count();
    for (int k = 0; k < places && result == WEFT_OK;) {
        int count = 0;
        for (; k < places && count < threads && result == WEFT_OK; k++) {
            if (!is_wanted(self, plan, k, stale)) continue;
            const TextureGroup *group = &plan->groups[self->places[k].group];
            Layer layer = {k, alloc_array(level_at(group, levels_of(group)), 1)};
            if (!layer.texels) result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
            layers.items[count++] = layer;
        }
        if (result == WEFT_OK) parallel_for(threads, count, make_layer, &layers);
        for (int n = 0; n < count; n++) {
            if (result == WEFT_OK) upload_layer(self, plan, &layers.items[n]);
            free(layers.items[n].texels);
        }
    }
    for (int k = 0; k < self->texture_count && result == WEFT_OK; k++) self->versions[k] = scene->textures[k].version;
    return result == WEFT_OK ? gl_check(error, "textures") : result;
}

static WeftResult upload(GlTextures *self, Plan *plan, int threads, const WeftLog *log, WeftError *error) {
    const char *name = plan->scene->name;
    if (make_plan(plan) > TEXTURE_SLOTS) {
        plan->one_size = self->one_size = true;
        if (make_plan(plan) > TEXTURE_SLOTS)
            return fail(error, WEFT_MESSAGE_GL_MEMORY, name, "a material whose textures are of more than %d kinds",
                        TEXTURE_SLOTS);
        warn(log, WEFT_MESSAGE_TEXTURES_SCALED, name, NULL);
    }
    self->group_count = plan->count;
    glGenTextures(plan->count, self->groups);
    for (int g = 0; g < plan->count; g++) make_group(self->groups[g], &plan->groups[g]);
    return fill_groups(self, plan, false, threads, error);
}

WeftResult textures_refresh(GlTextures *self, const WeftScene *scene, int threads, WeftError *error) {
    const Plan plan = {.scene = scene, .groups = self->kinds, .places = self->places};
    bool stale = false;
    for (int k = 0; k < self->texture_count; k++) stale |= textures_stale(self, scene, k);
    return stale ? fill_groups(self, &plan, true, threads, error) : WEFT_OK;
}

WeftResult textures_create(const WeftScene *scene, int threads, GlTextures *out, const WeftLog *log, WeftError *error) {
    *out = (GlTextures){.texture_count = scene->texture_count};
    if (!scene->texture_count) return WEFT_OK;
    size_t count = TEXTURE_USES * (size_t)scene->texture_count;
    Plan plan = {.scene = scene};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &plan.side_most);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &plan.layers_most);
    out->kinds = plan.groups = alloc_array(count, sizeof(TextureGroup));
    out->versions = alloc_array(count, sizeof(unsigned));
    out->places = plan.places = alloc_array(count, sizeof(TexturePlace));
    out->groups = alloc_array(count, sizeof(GLuint));
    bool allocated = plan.groups && plan.places && out->groups && out->versions;
    WeftResult result =
        allocated ? upload(out, &plan, threads, log, error) : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result != WEFT_OK) textures_destroy(out);
    return result;
}

void textures_destroy(GlTextures *self) {
    if (self->group_count) glDeleteTextures(self->group_count, self->groups);
    free(self->groups);
    free(self->kinds);
    free(self->versions);
    free(self->places);
    *self = (GlTextures){0};
}

bool textures_stale(const GlTextures *self, const WeftScene *scene, int texture) {
    return texture < self->texture_count && self->versions[texture] != scene->textures[texture].version;
}

/* Returns true if the texture as it is now fits in its place. */
static bool fits(const GlTextures *self, const WeftScene *scene, int texture, int side_most) {
    bool fit = true;
    for (int use = 0; use < TEXTURE_USES; use++) {
        int group = self->places[TEXTURE_USES * texture + use].group;
        if (group < 0) continue;
        TextureGroup wanted = group_for(scene, texture, (TextureUse)use, side_most);
        fit &= same_group(self->one_size, &self->kinds[group], &wanted);
    }
    return fit;
}

bool textures_serve(const GlTextures *self, const WeftScene *scene) {
    GLint side_most;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side_most);
    for (int k = 0; k < self->texture_count; k++)
        if (textures_stale(self, scene, k) && !fits(self, scene, k, side_most)) return false;
    for (int m = 0; m < scene_shaded_materials(scene); m++) {
        int count = count_groups(self->places, self->texture_count, &scene->materials[m]);
        if (count < 0 || count > TEXTURE_SLOTS) return false;
    }
    return true;
}

TexturePlace textures_place(const GlTextures *self, const Input *input, TextureUse use) {
    return self->places[TEXTURE_USES * (input->texture - 1) + (int)use];
}

float textures_slopes_level(const GlTextures *self, const Input *input) {
    TexturePlace map = textures_place(self, input, TEXTURE_NUMBERS),
                 slopes = textures_place(self, input, TEXTURE_SLOPES);
    if (map.group < 0 || slopes.group < 0) return 0.0f;
    return log2f((float)self->kinds[map.group].width / (float)self->kinds[slopes.group].width);
}

void textures_bind(const GlTextures *self, int group, int unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->groups[group]);
}

void textures_filter(const GlTextures *self, bool mipmaps) {
    for (int g = 0; g < self->group_count; g++) {
        GLint magnified;
        glBindTexture(GL_TEXTURE_2D_ARRAY, self->groups[g]);
        glGetTexParameteriv(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, &magnified);
        glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER,
                        mipmaps && magnified != GL_NEAREST ? GL_LINEAR_MIPMAP_LINEAR : magnified);
    }
}
