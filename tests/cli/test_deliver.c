/* `weft deliver`: the files for each target, what they hold, how near they come, and that none is left half done.
 *
 * Labels: slow unsanitized */
#include "run.h"

#include <math.h>
#include <sys/stat.h>

#include <jansson.h>

#include "base/file.h"
#include "image/ktx2/ktx2.h"
#include "weft/weft.h"

static const char all_targets[] = "khronos,three,babylon,filament,blender,core";

static void delivered(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%d: %s", ran.code, ran.err);
    ran_free(&ran);
}

/* Removes a folder of files, which work_end leaves. */
static void folder_clear(const char *path) {
    DIR *folder = opendir(path);
    if (!folder) return;
    for (struct dirent *entry; (entry = readdir(folder));) unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    assert_int_equal(rmdir(path), 0);
}

static int files_in(const char *path) {
    DIR *folder = opendir(path);
    int count = 0;
    if (!folder) return -1;
    while (readdir(folder)) count++;
    closedir(folder);
    return count - 2;
}

static json_t *json_of(const char *path) {
    json_error_t error;
    json_t *json = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!json) fail_msg("%s: %s", path, error.text);
    return json;
}

/* The JSON chunk of a .glb, without a reader of weft's own. */
static json_t *glb_json(const char *path) {
    size_t size;
    json_error_t error;
    char *bytes = file_bytes(path, &size);
    assert_non_null(bytes);
    assert_true(size > 20 && memcmp(bytes, "glTF", 4) == 0 && memcmp(bytes + 16, "JSON", 4) == 0);
    const unsigned char *length = (const unsigned char *)bytes + 12;
    const size_t text = length[0] + 256u * length[1] + 65536u * length[2];
    json_t *json = json_loadb(bytes + 20, text, 0, &error);
    if (!json) fail_msg("%s: %s", path, error.text);
    free(bytes);
    return json;
}

static double number(const json_t *json, const char *key) {
    const json_t *value = json_object_get(json, key);
    if (!json_is_number(value)) fail_msg("\"%s\" is no number", key);
    return json_number_value(value);
}

static json_t *part(const json_t *material, const char *extension) {
    return json_object_get(json_object_get(material, "extensions"), extension);
}

static const json_t *target_of(const json_t *summary, const char *name) {
    size_t k;
    json_t *target, *targets = json_object_get(summary, "targets");
    json_array_foreach(targets, k, target) {
        if (strcmp(json_string_value(json_object_get(target, "target")), name) == 0) return target;
    }
    fail_msg("there is no target %s", name);
    return NULL;
}

/* What each viewer must not be given; ends with NULL. */
static const struct {
    const char *target, *never[8];
} forbidden[] = {
    {"three", {"KHR_materials_fuzz", "KHR_materials_coat", "KHR_materials_diffuse_transmission", NULL}},
    {"babylon", {"KHR_materials_fuzz", NULL}},
    {"filament", {"KHR_materials_ior", "KHR_materials_anisotropy", "KHR_materials_fuzz", NULL}},
    {"blender", {"KHR_materials_fuzz", "KHR_materials_coat", NULL}},
    {"core",
     {"KHR_materials_ior", "KHR_materials_anisotropy", "KHR_materials_fuzz", "KHR_materials_sheen",
      "KHR_materials_specular", "KHR_materials_clearcoat", NULL}},
};

/* Opens what was written for each target by other means than weft's, and by weft. */
static void files_hold_what_targets_read(const char *folder, const char *name) {
    char path[128];
    for (size_t k = 0; k < sizeof forbidden / sizeof *forbidden; k++) {
        snprintf(path, sizeof path, "%s/%s-%s.glb", folder, name, forbidden[k].target);
        json_t *root = glb_json(path);
        char *text = json_dumps(root, 0);
        for (const char *const *never = forbidden[k].never; *never; never++)
            if (strstr(text, *never)) fail_msg("%s has %s", path, *never);
        if (strstr(text, "\"weft\":")) fail_msg("%s has extras.weft", path);
        free(text);
        json_decref(root);
        WeftScene *scene;
        WeftError error;
        if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        weft_scene_free(scene);
        WeftImage sheet;
        snprintf(path, sizeof path, "%s/%s-%s.png", folder, name, forbidden[k].target);
        assert_int_equal(weft_image_read(path, &sheet, NULL, NULL), WEFT_OK);
        assert_true(sheet.width > sheet.height / 2 && sheet.height > 64);
        weft_image_free(&sheet);
    }
}

/* The numbers of every target; far and near, colours differ by no more than `most`, or `bare` without extensions. */
static void numbers_are_within(const char *path, double most, double bare, double sky) {
    json_t *summary = json_of(path), *target;
    size_t k;
    assert_true(json_array_size(json_object_get(summary, "targets")) == 6);
    json_array_foreach(json_object_get(summary, "targets"), k, target) {
        const json_t *errors = json_object_get(target, "errors");
        const char *name = json_string_value(json_object_get(target, "target"));
        const double limit = strcmp(name, "core") == 0 ? bare : most;
        for (int v = 0; v < 2; v++) {
            const json_t *view = json_object_get(errors, v ? "far" : "near");
            if (!(number(view, "mean_color") <= limit) || !(number(view, "profile_l1") <= limit))
                fail_msg("%s: %s: %g, columns %g", name, v ? "far" : "near", number(view, "mean_color"),
                         number(view, "profile_l1"));
            assert_true(number(view, "flip") >= 0.0 && number(view, "flip") < 0.5 && number(view, "contrast") > 0.0);
        }
        if (!(fabs(number(errors, "even_sky")) <= sky)) fail_msg("%s: sky %g", name, number(errors, "even_sky"));
        assert_true(json_array_size(json_object_get(target, "materials")) >= 1);
        assert_true(number(target, "bytes") > 100.0);
    }
    json_decref(summary);
}

static void draft_is_delivered_to_every_target(void **state) {
    (void)state;
    delivered(LIST("deliver", "twill 3/1; warp 1#28385c; weft 1w; sett 26 18", "--to", all_targets, "-o", "cloth",
                   "--size", "128", "--width", "64", "--spp", "8"));
    assert_int_equal(files_in("cloth"), 13); /* and nothing of the work */
    files_hold_what_targets_read("cloth", "twill-3-1-warp-1-28385c-weft-1w-sett-26-18");
    numbers_are_within("cloth/twill-3-1-warp-1-28385c-weft-1w-sett-26-18.json", 0.5, 0.5, 0.4);
    json_t *summary = json_of("cloth/twill-3-1-warp-1-28385c-weft-1w-sett-26-18.json");
    const json_t *lost = json_object_get(target_of(summary, "filament"), "lost");
    assert_true(json_array_size(lost) == 1);
    lost = json_array_get(lost, 0);
    assert_string_equal(json_string_value(json_object_get(lost, "what")), "KHR_materials_anisotropy");
    assert_non_null(strstr(json_string_value(json_object_get(lost, "why")), "highlights are round"));
    assert_true(json_array_size(json_object_get(lost, "materials")) == 1);
    assert_string_equal(json_string_value(json_array_get(json_object_get(lost, "materials"), 0)), "cloth");
    /* Babylon.js has the fit of three.js, without mip levels */
    static const char *const fitted[] = {"three", "babylon", "core"};
    for (int k = 0; k < 3; k++) {
        const json_t *materials = json_object_get(target_of(summary, fitted[k]), "materials");
        const json_t *baked = json_object_get(json_array_get(materials, 0), "baked");
        assert_true(number(baked, "fitted") > 0.0 && number(baked, "fitted") < number(baked, "copied"));
        assert_true((number(baked, "levels") > 0.0) == (k == 0));
    }
    json_decref(summary);
    folder_clear("cloth");
}

/* A smooth material can be matched far better than threads: the worst is core, which has no rim. */
static void material_is_delivered_near_the_truth(void **state) {
    (void)state;
    delivered(LIST("deliver", "preset:velvet", "--to", all_targets, "-o", "soft", "--name", "v", "--width", "64",
                   "--spp", "16"));
    files_hold_what_targets_read("soft", "v");
    numbers_are_within("soft/v.json", 0.1, 0.35, 0.2);
    json_t *summary = json_of("soft/v.json");
    static const char *const near[] = {"three", "babylon", "filament", "blender"};
    for (int k = 0; k < 4; k++) {
        const json_t *errors = json_object_get(target_of(summary, near[k]), "errors");
        assert_true(number(json_object_get(errors, "far"), "mean_color") < 0.06);
        assert_true(fabs(number(errors, "even_sky")) < 0.05);
    }
    json_decref(summary);
    folder_clear("soft");
}

/* A quad with normals and what the viewers differ in, and things of others that have to stay. */
static void asset_make(const char *extension) {
    static const char head[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0},{\"camera\":0,\"translation\":[0,0,3],\"name\":\"eye\"}],"
        "\"cameras\":[{\"name\":\"front\",\"type\":\"perspective\",\"perspective\":{\"yfov\":0.6,\"znear\":0.1}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[-1,-1,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"materials\":[{\"name\":\"satin\",\"doubleSided\":true,\"extras\":{\"mine\":1},"
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.1,0.1,1],\"metallicFactor\":0,\"roughnessFactor\":0.3},"
        "\"extensions\":{";
    char text[4096];
    snprintf(text, sizeof text,
             "%s%s}}],\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_materials_ior\","
             "\"KHR_materials_fuzz\",\"KHR_materials_anisotropy\",\"KHR_materials_pbrSpecularGlossiness\"]}",
             head, extension);
    file_make("asset.gltf", text, strlen(text));
}

static const char everything[] =
    "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.5,0.4,0.4],\"sheenRoughnessFactor\":0.4},"
    "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.7},\"KHR_materials_ior\":{\"ior\":1.8},"
    "\"KHR_materials_fuzz\":{\"fuzzFactor\":0.3}";

static void asset_keeps_all_that_the_target_reads(void **state) {
    (void)state;
    asset_make(everything);
    delivered(LIST("deliver", "asset.gltf", "--to", all_targets, "-o", "asset", "--width", "48", "--spp", "8"));
    files_hold_what_targets_read("asset", "asset");
    numbers_are_within("asset/asset.json", 0.06, 0.15, 0.25);
    json_t *root = glb_json("asset/asset-filament.glb");
    const json_t *material = json_array_get(json_object_get(root, "materials"), 0);
    /* the index of refraction became a specular colour, (0.8 / 2.8)^2 / 0.04 times the strength that is fitted */
    const json_t *specular = part(material, "KHR_materials_specular");
    const double green = json_number_value(json_array_get(json_object_get(specular, "specularColorFactor"), 1));
    if (!(green > 0.0 && green < 2.040817)) fail_msg("%g", green);
    assert_null(json_object_get(specular, "specularFactor"));
    assert_non_null(part(material, "KHR_materials_sheen"));
    assert_true(number(json_object_get(material, "extras"), "mine") > 0.5);
    assert_string_equal(json_string_value(json_object_get(json_array_get(json_object_get(root, "nodes"), 1), "name")),
                        "eye");
    json_decref(root);
    root = glb_json("asset/asset-khronos.glb");
    material = json_array_get(json_object_get(root, "materials"), 0);
    assert_non_null(part(material, "KHR_materials_fuzz"));
    json_decref(root);
    root = glb_json("asset/asset-core.glb");
    assert_null(json_object_get(root, "extensionsUsed"));
    json_decref(root);
    json_t *summary = json_of("asset/asset.json");
    assert_true(json_array_size(json_object_get(target_of(summary, "khronos"), "lost")) == 0);
    assert_true(json_array_size(json_object_get(target_of(summary, "core"), "lost")) == 4);
    json_decref(summary);
    folder_clear("asset");
}

static bool tells(const json_t *lost, const char *text) {
    size_t k;
    json_t *loss;
    json_array_foreach(lost, k, loss) {
        if (strstr(json_string_value(json_object_get(loss, "why")), text)) return true;
    }
    return false;
}

/* Glass keeps its base colour, by which no reflection is matched, where an extension is taken out. */
static void glass_keeps_its_color(void **state) {
    (void)state;
    static const char *const targets[] = {"khronos", "three", "filament", "core"};
    asset_make("\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_ior\":{\"ior\":1.8},"
               "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.7}");
    delivered(LIST("deliver", "asset.gltf", "--to", "khronos,three,filament,core", "-o", "glass", "--width", "32",
                   "--spp", "1"));
    json_t *summary = json_of("glass/asset.json");
    for (size_t k = 0; k < sizeof targets / sizeof *targets; k++) {
        char path[64];
        snprintf(path, sizeof path, "glass/asset-%s.glb", targets[k]);
        json_t *root = glb_json(path);
        const json_t *material = json_array_get(json_object_get(root, "materials"), 0);
        const json_t *base = json_object_get(json_object_get(material, "pbrMetallicRoughness"), "baseColorFactor");
        const double red = json_number_value(json_array_get(base, 0)),
                     green = json_number_value(json_array_get(base, 1));
        if (fabs(red - 0.5) > 1e-5 || fabs(green - 0.1) > 1e-5) fail_msg("%s: %g %g", targets[k], red, green);
        assert_int_equal(part(material, "KHR_materials_transmission") != NULL, k < 3);
        const json_t *target = target_of(summary, targets[k]), *lost = json_object_get(target, "lost");
        if (tells(lost, "as if it were opaque") != (k == 3)) fail_msg("%s: %s", targets[k], json_dumps(lost, 0));
        /* what glass reflects is its highlight alone, which is round in Filament where this one is stretched */
        const json_t *satin = json_array_get(json_object_get(target, "materials"), 0);
        const double matched = number(satin, "matched"), copied = number(satin, "copied");
        if (!(matched < (k == 2 ? 0.7 * copied : 0.3))) fail_msg("%s: %g, %g copied", targets[k], matched, copied);
        json_decref(root);
    }
    json_decref(summary);
    folder_clear("glass");
}

/* Filament's web build multiplies the reflection of metals by the strength of specular, so it gets a colour instead. */
static void strength_of_specular_dims_no_metal_in_filament(void **state) {
    (void)state;
    asset_make("\"KHR_materials_specular\":{\"specularFactor\":0.25,\"specularColorFactor\":[1,0.5,2]}");
    delivered(LIST("deliver", "asset.gltf", "--to", "three,filament", "-o", "dim", "--width", "32", "--spp", "1"));
    json_t *root = glb_json("dim/asset-filament.glb");
    const json_t *specular = part(json_array_get(json_object_get(root, "materials"), 0), "KHR_materials_specular");
    const json_t *color = json_object_get(specular, "specularColorFactor");
    assert_null(json_object_get(specular, "specularFactor"));
    static const double expected[] = {0.25, 0.125, 0.5};
    for (size_t c = 0; c < 3; c++) assert_true(fabs(json_number_value(json_array_get(color, c)) - expected[c]) < 1e-4);
    json_decref(root);
    root = glb_json("dim/asset-three.glb"); /* others get what the asset says */
    specular = part(json_array_get(json_object_get(root, "materials"), 0), "KHR_materials_specular");
    assert_true(fabs(number(specular, "specularFactor") - 0.25) < 1e-6);
    json_decref(root);
    folder_clear("dim");
}

/* Filament draws no specular reflection beside a sheen, of metals neither, where KHR_materials_specular is missing. */
static void sheen_has_a_specular_beside_it_in_filament(void **state) {
    (void)state;
    asset_make("\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.4,0.4,0.4],\"sheenRoughnessFactor\":0.5}");
    delivered(LIST("deliver", "asset.gltf", "--from", "filament-sheen", "--to", "filament", "-o", "rim", "--width",
                   "32", "--spp", "1"));
    json_t *root = glb_json("rim/asset-filament.glb");
    const json_t *material = json_array_get(json_object_get(root, "materials"), 0);
    assert_non_null(part(material, "KHR_materials_sheen"));
    const json_t *color = json_object_get(part(material, "KHR_materials_specular"), "specularColorFactor");
    assert_int_equal(json_array_size(color), 3);
    char *used = json_dumps(json_object_get(root, "extensionsUsed"), 0);
    assert_non_null(strstr(used, "\"KHR_materials_specular\""));
    free(used);
    json_decref(root);
    folder_clear("rim");
}

static void unlit_material_keeps_its_color(void **state) {
    (void)state;
    char text[1024];
    snprintf(text, sizeof text, "%s,\"KHR_materials_unlit\":{}", everything);
    asset_make(text);
    delivered(LIST("deliver", "asset.gltf", "--to", "core", "-o", "flat", "--width", "32", "--spp", "1"));
    json_t *root = glb_json("flat/asset-core.glb");
    const json_t *material = json_array_get(json_object_get(root, "materials"), 0);
    const json_t *color = json_object_get(json_object_get(material, "pbrMetallicRoughness"), "baseColorFactor");
    assert_non_null(part(material, "KHR_materials_unlit"));
    assert_true(fabs(json_number_value(json_array_get(color, 0)) - 0.5) < 1e-6);
    assert_true(fabs(json_number_value(json_array_get(color, 1)) - 0.1) < 1e-6);
    json_decref(root);
    folder_clear("flat");
}

static double far_color(const json_t *summary, const char *target) {
    return number(json_object_get(json_object_get(target_of(summary, target), "errors"), "far"), "mean_color");
}

/* Silk is fitted for each viewer by itself: one whose highlights are round, or that has no rim, is no farther off. The fit
 * for Filament is to its own sky, which the sheet's path tracer does not have. */
static void cloth_is_fitted_for_each_target(void **state) {
    (void)state;
    delivered(LIST("deliver", "preset:woven-charmeuse", "--to", "three,filament,core,u3m", "-o", "silk", "--name", "s",
                   "--size", "256", "--width", "64", "--spp", "16"));
    json_t *summary = json_of("silk/s.json");
    static const char *const names[] = {"three", "filament", "core"};
    static const double most[] = {0.12, 0.13, 0.12};
    for (int k = 0; k < 3; k++)
        if (!(far_color(summary, names[k]) < most[k])) fail_msg("%s: %g", names[k], far_color(summary, names[k]));
    /* the archive of the textile industry is read again as what it says */
    const json_t *u3m = target_of(summary, "u3m"), *files = json_object_get(u3m, "files");
    assert_string_equal(json_string_value(json_object_get(files, "u3m")), "s-u3m.u3ma");
    assert_true(json_array_size(json_object_get(u3m, "lost")) > 0 && far_color(summary, "u3m") < 0.3);
    const json_t *loss = json_array_get(json_object_get(u3m, "lost"), 0);
    assert_string_equal(json_string_value(json_object_get(loss, "what")), "its own shading");
    assert_int_equal(strncmp(json_string_value(json_object_get(loss, "why")), "U3M has the principled shader", 29), 0);
    WeftMaterial material;
    WeftError error;
    if (weft_material_read("silk/s-u3m.u3ma", &material, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    json_decref(summary);
    folder_clear("silk");
}

/* Returns true if a target's file names its textures as KTX 2 too, each beside a PNG. */
static bool has_levels(const char *path) {
    json_t *root = glb_json(path), *texture;
    size_t k, plain = 0, own = 0;
    json_array_foreach(json_object_get(root, "textures"), k, texture) {
        const json_t *offer = json_object_get(json_object_get(texture, "extensions"), "KHR_texture_basisu");
        const json_t *images = json_object_get(root, "images");
        const json_t *image = json_array_get(images, (size_t)json_integer_value(json_object_get(texture, "source")));
        plain += strcmp(json_string_value(json_object_get(image, "mimeType")), "image/png") == 0;
        image = json_array_get(images, (size_t)json_integer_value(json_object_get(offer, "source")));
        own += offer && strcmp(json_string_value(json_object_get(image, "mimeType")), "image/ktx2") == 0;
    }
    json_decref(root);
    assert_true(plain > 0 && (own == 0 || own == plain));
    return own > 0;
}

/* Makes a picture of `side` texels whose normals have that slope, in checks of one texel. */
static void picture_make(const char *path, int side, double slope) {
    WeftImage image;
    assert_int_equal(weft_image_create(side, side, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    const double z = 1.0 / sqrt(1.0 + slope * slope);
    for (int k = 0; k < side * side; k++) {
        const double sign = (k + k / side) % 2 ? 1.0 : -1.0, n[3] = {sign * slope * z, 0.0, z};
        for (int c = 0; c < 3; c++)
            ((unsigned char *)image.pixels)[3 * k + c] = (unsigned char)lrint(127.5 * (n[c] + 1.0));
    }
    assert_int_equal(weft_image_write_as(path, &image, &(WeftImageWriting){.data = 1}, NULL), WEFT_OK);
    weft_image_free(&image);
}

/* A triangle with a normal map whose slopes are so steep. */
static void bumps_make(double slope) {
    picture_make("bumps.png", 16, slope);
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[-1,-1,0],"
        "\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
        "\"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"images\":[{\"uri\":\"bumps.png\"}],\"textures\":[{\"source\":0}],"
        "\"materials\":[{\"normalTexture\":{\"index\":0},\"doubleSided\":true,"
        "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.3}}]}";
    file_make("bumps.gltf", text, strlen(text));
}

/* A fine normal map gets levels whose roughness has what their normals lack; a gentle one stays as it is. */
static void fine_normal_maps_get_levels(void **state) {
    (void)state;
    bumps_make(0.1);
    delivered(LIST("deliver", "bumps.gltf", "--to", "three", "-o", "bumps", "--width", "32", "--spp", "1"));
    json_t *root = glb_json("bumps/bumps-three.glb");
    assert_null(json_object_get(root, "extensionsUsed"));
    json_decref(root);
    bumps_make(0.5);
    delivered(LIST("deliver", "bumps.gltf", "--to", "three,babylon", "-o", "bumps", "--width", "32", "--spp", "1"));
    root = glb_json("bumps/bumps-babylon.glb");
    assert_null(json_object_get(root, "extensionsUsed"));
    json_decref(root);
    WeftScene *scene;
    WeftMaterial material;
    WeftError error;
    if (weft_scene_load("bumps/bumps-three.glb", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_scene_material(scene, 0, &material, &error), WEFT_OK);
    WeftImage map = weft_scene_texture(scene, material.inputs[weft_material_input_find("roughness")].texture);
    assert_int_equal(map.width, 16); /* the first level is as it was: a factor of 0.3 */
    assert_true(abs(((const unsigned char *)map.pixels)[1] - 77) <= 3);
    weft_scene_free(scene);
    /* the last of the levels, read as a viewer does: alpha^2 is .3^4 + .5^2 */
    root = glb_json("bumps/bumps-three.glb");
    const json_t *images = json_object_get(root, "images"), *views = json_object_get(root, "bufferViews");
    const json_t *view =
        json_array_get(views, (size_t)number(json_array_get(images, json_array_size(images) - 1), "bufferView"));
    size_t size;
    char *bytes = file_bytes("bumps/bumps-three.glb", &size);
    const size_t json_size = (size_t)((unsigned char)bytes[12] + 256 * (unsigned char)bytes[13]);
    const json_t *at = json_object_get(view, "byteOffset");
    file_make("last.ktx2", bytes + 28 + json_size + (size_t)json_integer_value(at), (size_t)number(view, "byteLength"));
    Ktx2 file;
    FileBytes own;
    WeftImage last;
    assert_int_equal(file_read("last.ktx2", SIZE_MAX, &own, NULL), WEFT_OK);
    const ImageSource source = {.data = own.data, .size = own.size, .name = "last.ktx2"};
    assert_int_equal(ktx2_open(&source, &file, &error), WEFT_OK);
    assert_int_equal(ktx2_picture(&file, 4, 0, &last, &error), WEFT_OK);
    assert_true(last.width == 1 && last.height == 1);
    const double alpha = pow(((const unsigned char *)last.pixels)[1] / 255.0, 2.0);
    if (!(fabs(alpha - sqrt(pow(0.3, 4.0) + 0.25)) < 0.03)) fail_msg("alpha %g", alpha);
    weft_image_free(&last);
    free(own.data);
    free(bytes);
    json_decref(root);
    json_t *summary = json_of("bumps/bumps.json");
    char *text = json_dumps(json_object_get(target_of(summary, "three"), "extensions"), 0);
    assert_non_null(strstr(text, "KHR_texture_basisu"));
    free(text);
    json_decref(summary);
    folder_clear("bumps");
}

/* Replaces the textures and materials of bumps.gltf by these. */
static void bumps_with(const char *rest) {
    bumps_make(0.5);
    json_t *root = json_of("bumps.gltf"), *own = json_loads(rest, 0, NULL);
    assert_non_null(own);
    assert_int_equal(json_object_update(root, own), 0);
    char *text = json_dumps(root, 0);
    file_make("bumps.gltf", text, strlen(text));
    free(text);
    json_decref(own);
    json_decref(root);
}

static json_int_t texture_of(const json_t *root, size_t material, bool normal) {
    const json_t *object = json_array_get(json_object_get(root, "materials"), material);
    if (!normal) object = json_object_get(object, "pbrMetallicRoughness");
    const json_t *info = json_object_get(object, normal ? "normalTexture" : "metallicRoughnessTexture");
    return json_integer_value(json_object_get(info, "index"));
}

/* Two materials have the same first level of roughness, but below it that of their own normals. A third has all maps of
 * the first. */
static void materials_share_maps_that_are_equal_at_all_levels(void **state) {
    (void)state;
    bumps_with("{\"images\":[{\"uri\":\"gentle.png\"},{\"uri\":\"steep.png\"}],"
               "\"textures\":[{\"source\":0},{\"source\":1}],\"meshes\":[{\"primitives\":["
               "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0},"
               "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":1},"
               "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":2}]}],\"materials\":["
               "{\"normalTexture\":{\"index\":0},\"pbrMetallicRoughness\":{\"roughnessFactor\":0.3}},"
               "{\"normalTexture\":{\"index\":1},\"pbrMetallicRoughness\":{\"roughnessFactor\":0.3}},"
               "{\"normalTexture\":{\"index\":0},\"pbrMetallicRoughness\":{\"roughnessFactor\":0.3}}]}");
    picture_make("gentle.png", 16, 0.35);
    picture_make("steep.png", 16, 1.5);
    delivered(LIST("deliver", "bumps.gltf", "--to", "three", "-o", "two", "--width", "32", "--spp", "1"));
    json_t *root = glb_json("two/bumps-three.glb");
    assert_true(texture_of(root, 0, true) != texture_of(root, 1, true));
    assert_true(texture_of(root, 0, false) != texture_of(root, 1, false));
    assert_true(texture_of(root, 0, true) == texture_of(root, 2, true));
    assert_true(texture_of(root, 0, false) == texture_of(root, 2, false));
    json_decref(root);
    folder_clear("two");
}

/* A map of roughness with more texels than the normal map is left as it is, and so is the normal map. */
static void finer_roughness_is_not_resampled(void **state) {
    (void)state;
    for (int finer = 0; finer < 2; finer++) {
        bumps_with("{\"images\":[{\"uri\":\"bumps.png\"},{\"uri\":\"rough.png\"}],"
                   "\"textures\":[{\"source\":0},{\"source\":1}],\"materials\":[{\"normalTexture\":{\"index\":0},"
                   "\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":1}}}]}");
        picture_make("rough.png", finer ? 64 : 16, 0.0);
        delivered(LIST("deliver", "bumps.gltf", "--to", "three", "-o", "fine", "--width", "32", "--spp", "1"));
        json_t *root = glb_json("fine/bumps-three.glb");
        assert_true((texture_of(root, 0, false) == 1) == (finer == 1));
        assert_true((texture_of(root, 0, true) == 0) == (finer == 1));
        json_decref(root);
        folder_clear("fine");
    }
}

/* Textures have mip levels of their own for viewers that read them, unless told otherwise. */
static void levels_are_for_those_who_read_them(void **state) {
    (void)state;
    static const char *const formats[] = {"auto", "png", "ktx2"};
    for (int k = 0; k < 3; k++) {
        delivered(LIST("deliver", "plain; both 1#a06040; sett 20", "--to", "three,babylon", "-o", "mips", "--name", "p",
                       "--size", "64", "--width", "32", "--spp", "1", "--textures", formats[k]));
        assert_true(has_levels("mips/p-three.glb") == (k != 1));
        assert_true(has_levels("mips/p-babylon.glb") == (k == 2));
        folder_clear("mips");
    }
    assert_complaint(NULL, LIST("deliver", "plain", "--to", "three", "-o", "no", "--textures", "jpeg"), WEFT_USAGE,
                     "--textures");
}

/* A scene that was saved with its threads has them as textures. */
static void woven_asset_is_baked(void **state) {
    (void)state;
    delivered(LIST("render", "builtin:bend", "--preset", "woven-poplin", "--save", "woven.glb"));
    delivered(
        LIST("deliver", "woven.glb", "--to", "three", "-o", "baked", "--size", "128", "--width", "48", "--spp", "4"));
    json_t *root = glb_json("baked/woven-three.glb"), *summary = json_of("baked/woven.json");
    assert_true(json_array_size(json_object_get(root, "images")) >= 3);
    assert_string_equal(json_string_value(json_object_get(summary, "reference")), "its threads");
    const json_t *errors = json_object_get(target_of(summary, "three"), "errors");
    assert_true(number(json_object_get(errors, "far"), "mean_color") < 0.3);
    json_decref(root);
    json_decref(summary);
    folder_clear("baked");
}

/* One command line may deliver many sources: an option of cloth alone is told, and does not stop those without. */
static void a_size_of_cloth_is_told_where_nothing_is_woven(void **state) {
    (void)state;
    Ran ran = RUN("deliver", "preset:velvet", "--to", "three,core", "-o", "sized", "--size", "64", "--width", "32",
                  "--spp", "1");
    const char *line = strstr(ran.err, "warning: --size is for cloth, and nothing is woven in preset:velvet");
    if (ran.code != 0 || !line || strstr(line + 1, "warning: ")) fail_msg("%d: %s", ran.code, ran.err);
    ran_free(&ran);
    folder_clear("sized");
}

static void senseless_delivery_is_refused(void **state) {
    (void)state;
    asset_make("\"KHR_materials_pbrSpecularGlossiness\":{\"glossinessFactor\":0.5}");
    assert_complaint(NULL, LIST("deliver", "asset.gltf", "--to", "three", "-o", "no"), WEFT_INPUT,
                     "weft match ASSET --workflow metallic");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "thre", "-o", "no"), WEFT_USAGE,
                     "khronos, three, babylon, filament, blender, core, u3m; did you mean three?");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three,,core", "-o", "no"), WEFT_USAGE,
                     "is not a target");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three,three", "-o", "no"), WEFT_USAGE,
                     "is named twice");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "-o", "no"), WEFT_USAGE, "--to is required");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three"), WEFT_USAGE, "-o DIR is required");
    assert_complaint(NULL, LIST("deliver", "felt.binary", "--to", "three", "-o", "no"), WEFT_USAGE, "weft fit FILE");
    assert_complaint(NULL, LIST("deliver", "nothing here", "--to", "three", "-o", "no"), WEFT_USAGE, "nothing");
    file_make("model.obj", "v 0 0 0\n", 8);
    assert_complaint(NULL, LIST("deliver", "model.obj", "--to", "three", "-o", "no"), WEFT_INPUT,
                     "model.obj: is nothing that can be delivered");
    assert_complaint(NULL, LIST("deliver", "gone.glb", "--to", "three", "-o", "no"), WEFT_INPUT, "gone.glb");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three", "--from", "three", "-o", "no"), WEFT_USAGE,
                     "--from: goes with an asset");
    assert_complaint(NULL, LIST("deliver", "asset.gltf", "--to", "three", "--sett", "20", "-o", "no"), WEFT_USAGE,
                     "--sett: goes with a draft");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three", "--name", "../x", "-o", "no"), WEFT_USAGE,
                     "is not a name of files");
    assert_int_equal(files_in("no"), -1); /* the folder is gone with what it was made for */
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three", "-o", "asset.gltf"), WEFT_RESOURCES,
                     "asset.gltf: is a file; -o names a folder");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", " core , thre", "-o", "no"), WEFT_USAGE,
                     "--to thre: is not a target");
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three", "-o", "missing/below"), WEFT_RESOURCES,
                     "missing/below");
    asset_make("}},{\"name\":\"second\",\"extensions\":{");
    assert_complaint(NULL, LIST("deliver", "asset.gltf", "--to", "u3m", "-o", "no", "--width", "32", "--spp", "1"),
                     WEFT_USAGE, "a U3M holds one material");
    assert_int_equal(files_in("no"), -1);
    /* a file in the place of one of the results is not lost */
    assert_int_equal(mkdir("taken", 0777), 0);
    assert_int_equal(mkdir("taken/v-three.png", 0777), 0);
    assert_complaint(NULL, LIST("deliver", "preset:velvet", "--to", "three", "--name", "v", "-o", "taken"),
                     WEFT_RESOURCES, "taken/v-three.png");
    assert_int_equal(files_in("taken"), 1);
    assert_int_equal(rmdir("taken/v-three.png"), 0);
    folder_clear("taken");
}

/* The folder that was there keeps what it had, and one that was made for the delivery goes again. */
static void interrupted_delivery_leaves_nothing(void **state) {
    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    file_make("kept/old.txt", "old", 3);
    static const char *const folders[] = {"kept", "fresh"};
    for (int k = 0; k < 2; k++) {
        pid_t child = program_start(WEFT_PROGRAM, NULL,
                                    LIST("deliver", "preset:woven-denim", "--to", "three,core", "-o", folders[k],
                                         "--spp", "4096", "--size", "64"));
        await_handler(child);
        sleep_seconds(0.5 + k);
        kill(child, SIGINT);
        Ran ran = program_end(child);
        assert_int_equal(ran.code, 130);
        assert_true(one_complaint(ran.err) && strstr(ran.err, "interrupted; nothing was written"));
        ran_free(&ran);
    }
    assert_int_equal(files_in("kept"), 1);
    assert_int_equal(files_in("fresh"), -1);
    folder_clear("kept");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draft_is_delivered_to_every_target),
        cmocka_unit_test(material_is_delivered_near_the_truth),
        cmocka_unit_test(asset_keeps_all_that_the_target_reads),
        cmocka_unit_test(unlit_material_keeps_its_color),
        cmocka_unit_test(glass_keeps_its_color),
        cmocka_unit_test(strength_of_specular_dims_no_metal_in_filament),
        cmocka_unit_test(sheen_has_a_specular_beside_it_in_filament),
        cmocka_unit_test(cloth_is_fitted_for_each_target),
        cmocka_unit_test(levels_are_for_those_who_read_them),
        cmocka_unit_test(fine_normal_maps_get_levels),
        cmocka_unit_test(materials_share_maps_that_are_equal_at_all_levels),
        cmocka_unit_test(finer_roughness_is_not_resampled),
        cmocka_unit_test(woven_asset_is_baked),
        cmocka_unit_test(a_size_of_cloth_is_told_where_nothing_is_woven),
        cmocka_unit_test(senseless_delivery_is_refused),
        cmocka_unit_test(interrupted_delivery_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
