/* layers.c - AOVs as the channels and attributes of an .exr */
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/frame/traced.h"

#include <stdio.h>
#include <string.h>

#include "base/fail.h"

void weft_render_record(WeftRenderDesc *desc, unsigned aovs) {
    const unsigned hits = 1u << WEFT_AOV_ALBEDO | 1u << WEFT_AOV_NORMAL | 1u << WEFT_AOV_DEPTH;
    const unsigned places = 1u << WEFT_AOV_POSITION | 1u << WEFT_AOV_UV;
    const unsigned mattes = 1u << WEFT_AOV_OBJECT | 1u << WEFT_AOV_MATERIAL;
    const unsigned slots = (2u << WEFT_AOV_OTHER) - (1u << WEFT_AOV_DIFFUSE);
    if (aovs & (hits | places | mattes | slots)) desc->first_hits = 1;
    if (aovs & slots) desc->slots = 1;
    if (aovs & places) desc->places = 1;
    if (aovs & mattes) desc->mattes = 1;
    if (aovs & 1u << WEFT_AOV_VARIANCE) desc->halves = WEFT_HALVES_INDEPENDENT;
}

/* The channels of an AOV, by the names that Nuke, Blender and OpenEXR's own tools use. */
static const char *const channels[WEFT_AOV_COUNT][4] = {
    {"albedo.R", "albedo.G", "albedo.B"},
    {"N.X", "N.Y", "N.Z"},
    {"Z"},
    {"variance.R", "variance.G", "variance.B"},
    {"sampleCount"},
    {"P.X", "P.Y", "P.Z"},
    {"UV.U", "UV.V"},
    [WEFT_AOV_DIFFUSE] = {"diffuse.R", "diffuse.G", "diffuse.B"},
    [WEFT_AOV_SPECULAR] = {"specular.R", "specular.G", "specular.B"},
    [WEFT_AOV_SHEEN] = {"sheen.R", "sheen.G", "sheen.B"},
    [WEFT_AOV_COAT] = {"coat.R", "coat.G", "coat.B"},
    [WEFT_AOV_DUST] = {"dust.R", "dust.G", "dust.B"},
    [WEFT_AOV_OTHER] = {"other.R", "other.G", "other.B"},
};

enum { PAIRS = MATTE_RANKS / 2 };

/* A kind of matte: its name in the file, and its channels. */
typedef struct MatteLayer {
    const char *name, *channels[PAIRS][4];
} MatteLayer;

#define MATTE_CHANNELS(name, pair)                                                                                     \
    { name pair ".R", name pair ".G", name pair ".B", name pair ".A" }
#define MATTE_LAYER(name)                                                                                              \
    {                                                                                                                  \
        name, { MATTE_CHANNELS(name, "00"), MATTE_CHANNELS(name, "01"), MATTE_CHANNELS(name, "02") }                   \
    }
static const MatteLayer mattes[FILM_MATTES] = {MATTE_LAYER("CryptoObject"), MATTE_LAYER("CryptoMaterial")};

/* Appends a layer without pixels; returns its image. */
static WeftImage *add_layer(WeftRenderLayers *out, const char *const names[4]) {
    WeftImageLayer *layer = &out->layers[out->layer_count++];
    memcpy(layer->channels, names, sizeof layer->channels);
    return (WeftImage *)layer->image; /* made by layers_alloc */
}

/* Appends an attribute, or fails with WEFT_MESSAGE_MEMORY. Takes both texts. */
static WeftResult add_text(WeftRenderLayers *out, char *name, char *text, WeftError *error) {
    out->texts[out->text_count++] = (WeftImageText){name, text};
    return name && text ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "AOVs", NULL);
}

/* Returns a copy of the key of an attribute of a matte; NULL where memory is short. */
static char *matte_key(const MatteLayer *matte, const char *what) {
    char key[48];
    char hash[9];
    snprintf(hash, sizeof hash, "%08x", (unsigned)matte_hash(matte->name));
    snprintf(key, sizeof key, "cryptomatte/%.7s/%s", hash, what);
    return strdup(key);
}

static char *manifest(const WeftScene *scene, int kind) {
    const int count = scene->mesh_count;
    const char **names = alloc_array((size_t)count, sizeof *names);
    for (int k = 0; names && k < count; k++)
        names[k] = kind == FILM_OBJECTS ? matte_object(scene, k) : matte_material(scene, scene->meshes[k].material);
    char *text = names ? matte_manifest(names, count) : NULL;
    free(names);
    return text;
}

static WeftResult add_matte(const TracedPicture *picture, int kind, WeftRenderLayers *out, WeftError *error) {
    const Film *film = &picture->film;
    const MatteLayer *matte = &mattes[kind];
    WeftResult result = WEFT_OK;
    for (int pair = 0; pair < PAIRS && result == WEFT_OK; pair++) {
        WeftImage *image = add_layer(out, matte->channels[pair]);
        result = weft_image_create(film->width, film->height, 4, WEFT_PIXEL_F32, image, error);
        float *pixel = image->pixels;
        for (int y = 0; result == WEFT_OK && y < film->height; y++)
            for (int x = 0; x < film->width; x++, pixel += 4) film_matte(film, kind, pair, x, y, pixel);
    }
    if (result == WEFT_OK) result = add_text(out, matte_key(matte, "name"), strdup(matte->name), error);
    if (result == WEFT_OK) result = add_text(out, matte_key(matte, "hash"), strdup("MurmurHash3_32"), error);
    if (result == WEFT_OK) result = add_text(out, matte_key(matte, "conversion"), strdup("uint32_to_float32"), error);
    if (result == WEFT_OK)
        result = add_text(out, matte_key(matte, "manifest"), manifest(picture->context.scene, kind), error);
    return result;
}

static bool layers_alloc(WeftRenderLayers *out) {
    enum { TEXTS = 4 * FILM_MATTES };
    *out = (WeftRenderLayers){0};
    WeftImage *images = alloc_array(WEFT_IMAGE_LAYERS, sizeof *images);
    out->layers = alloc_array(WEFT_IMAGE_LAYERS, sizeof *out->layers);
    out->texts = alloc_array(TEXTS, sizeof *out->texts);
    for (int k = 0; out->layers && images && k < WEFT_IMAGE_LAYERS; k++) out->layers[k].image = &images[k];
    if (images && out->layers && out->texts) return true;
    free(images);
    free(out->layers);
    free(out->texts);
    *out = (WeftRenderLayers){0};
    return false;
}

void weft_render_layers_free(WeftRenderLayers *layers) {
    WeftImage *images = layers->layers ? (WeftImage *)layers->layers[0].image : NULL;
    for (int k = 0; k < layers->layer_count; k++) weft_image_free(&images[k]);
    for (int k = 0; k < layers->text_count; k++) {
        free((char *)layers->texts[k].name);
        free((char *)layers->texts[k].text);
    }
    free(images);
    free(layers->layers);
    free(layers->texts);
    *layers = (WeftRenderLayers){0};
}

WeftResult weft_render_layers(const WeftRender *render, unsigned aovs, WeftRenderLayers *out, WeftError *error) {
    const TracedPicture *picture = render_picture(render);
    WeftResult result = layers_alloc(out) ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "AOVs", NULL);
    for (int aov = 0; aov < WEFT_AOV_COUNT && result == WEFT_OK; aov++) {
        if (!(aovs & 1u << aov)) continue;
        const bool matte = aov == WEFT_AOV_OBJECT || aov == WEFT_AOV_MATERIAL;
        WeftImage first = {0};
        result = film_aov(&picture->film, (WeftAov)aov, &first, error);
        if (result == WEFT_OK && !matte) *add_layer(out, channels[aov]) = first;
        if (!matte) continue;
        weft_image_free(&first); /* the matte was recorded, as the first layer showed */
        if (result == WEFT_OK) result = add_matte(picture, aov - WEFT_AOV_OBJECT, out, error);
    }
    if (result != WEFT_OK) weft_render_layers_free(out);
    return result;
}
