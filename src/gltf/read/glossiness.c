#include "gltf/read/glossiness.h"

#include "base/equal.h"
#include "base/fail.h"
#include "gltf/asset/field.h"
#include "gltf/asset/material_fields.h"
#include "image/pixel.h"
#include "shading/material/convert.h"

static bool waits(const Material *material) {
    return material->inputs[INPUT_roughness].channel == (int)CHANNEL_A_GLOSS;
}

/* Makes the roughness a number, for want of a picture with alpha: a missing alpha is 1. */
static void settle(Input *roughness) {
    roughness->value[0] = 1.0f - roughness->value[0];
    roughness->texture = roughness->texcoord = roughness->channel = 0;
}

void glossiness_begin(Material *material) {
    const Material plain = material_default();
    Input *roughness = &material->inputs[INPUT_roughness];
    material->choices[CHOICE_workflow] = WORKFLOW_SPECULAR;
    material->inputs[INPUT_metallic] = plain.inputs[INPUT_metallic];
    material->inputs[INPUT_specular] = plain.inputs[INPUT_specular];
    if (!roughness->texture) settle(roughness);
}

size_t glossiness_count(const WeftScene *scene) {
    size_t count = 0;
    for (int m = 0; m < scene->material_count; m++) count += waits(&scene->materials[m]);
    return count;
}

static float alpha_of(const WeftImage *image, size_t pixel) {
    return (float)pixel_value(image, (pixel + 1) * (size_t)image->channels - 1);
}

/* Makes a grey image of 1 - factor alpha, of 16 bits since the product has more than 8. */
static bool invert(Asset *asset, const WeftImage *from, float factor, WeftImage *out) {
    const size_t count = (size_t)from->width * (size_t)from->height;
    if (weft_image_create(from->width, from->height, 1, WEFT_PIXEL_U16, out, asset->error) != WEFT_OK) {
        asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
        return false;
    }
    for (size_t k = 0; k < count; k++) {
        const float roughness = 1.0f - factor * alpha_of(from, k);
        ((uint16_t *)out->pixels)[k] = (uint16_t)(fminf(fmaxf(roughness, 0.0f), 1.0f) * 65535.0f + 0.5f);
    }
    return true;
}

/* Returns an earlier material whose glossiness is the same; -1 if there is none. */
static int twin(const Input *gloss, const WeftScene *scene, int material) {
    for (int m = 0; m < material; m++)
        if (gloss[m].texture == gloss[material].texture && is_equal(gloss[m].value[0], gloss[material].value[0]))
            return scene->materials[m].inputs[INPUT_roughness].texture ? m : -1;
    return -1;
}

/* Returns the texture, + 1, with the roughness of a glossiness that has a picture; 0 after a sticky failure. */
static int roughness_texture(Asset *asset, const Input *gloss) {
    WeftScene *scene = asset->scene;
    const Texture *from = &scene->textures[gloss->texture - 1];
    WeftImage *image = &scene->images[scene->image_count];
    if (!invert(asset, &scene->images[from->image], gloss->value[0], image)) return 0;
    Texture *made = &scene->textures[scene->texture_count];
    *made = *from;
    made->path = NULL;
    made->levels = NULL; /* of glossiness */
    made->image = scene->image_count++;
    return ++scene->texture_count;
}

/* Says that a picture has no glossiness. */
static void warn_of_alpha(Asset *asset, int material) {
    Field root = field_root(asset), list = field_member(&root, "materials"),
          of = field_element(&list, (size_t)material),
          extension = field_extension(&of, "KHR_materials_pbrSpecularGlossiness"),
          texture = field_member(&extension, "specularGlossinessTexture");
    field_warn(&texture, WEFT_MESSAGE_GLTF_WARN_REPAIRED,
               "its picture has no alpha, which is the glossiness: that is 1, times glossinessFactor");
}

void glossiness_end(Asset *asset) {
    WeftScene *scene = asset->scene;
    if (asset->result != WEFT_OK || !glossiness_count(scene)) return;
    Input *gloss = asset_array(asset, &asset->arena, (size_t)scene->material_count, sizeof *gloss);
    for (int m = 0; m < scene->material_count && asset->result == WEFT_OK; m++) {
        Input *roughness = &scene->materials[m].inputs[INPUT_roughness];
        if (!waits(&scene->materials[m])) continue;
        const int texture = roughness->texture;
        const WeftImage *image = texture ? &scene->images[scene->textures[texture - 1].image] : NULL;
        if (!image || !image->pixels || image->channels % 2) {
            if (image && image->pixels) warn_of_alpha(asset, m);
            settle(roughness);
            continue;
        }
        gloss[m] = *roughness;
        const int same = twin(gloss, scene, m);
        roughness->texture =
            same < 0 ? roughness_texture(asset, &gloss[m]) : scene->materials[same].inputs[INPUT_roughness].texture;
        roughness->value[0] = 1.0f;
        roughness->channel = (int)CHANNEL_R;
    }
}
