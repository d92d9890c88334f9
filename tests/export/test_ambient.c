/* The light of an environment map by exported text: C that looks up a map agrees with weft's own way in `weft plot
 * ambient`, the other languages compile, and lobes whose light is more than weights of look-ups are refused. */
#include <dlfcn.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "plot/ambient_ways.h"
#include "scene/light/env_split.h"
#include "scratch.h"
#include "shading/dialect/angles.h"
#include "weft/export.h"

enum { WIDTH = 64, HEIGHT = 32, LOOKS = 7 };

/* A sky that is brighter above, with a window to one side. */
static WeftImage sky(void) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, &image, &error), WEFT_OK);
    float *p = image.pixels;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++, p += 3) {
            const float up = 1.0f - (float)y / (float)HEIGHT;
            const bool window = x > 12 && x < 18 && y > 8 && y < 14;
            p[0] = 0.1f + 0.3f * up + (window ? 20.0f : 0.0f);
            p[1] = 0.1f + 0.5f * up + (window ? 18.0f : 0.0f);
            p[2] = 0.2f + 0.7f * up + (window ? 15.0f : 0.0f);
        }
    return image;
}

/* The functions of a text in C, as a library. */
typedef struct Program {
    void *library;
    void (*look)(const float wo[3], int k, float out[4]); /* axis, kappa */
    void (*light)(const float wo[3], const float looks[][3], float out[3]);
    void (*eval)(const float wo[3], const float wi[3], float out[3]);
} Program;

/* Copies the address of a function of the library. */
static void take(void *library, const char *name, void *function) {
    void *found = dlsym(library, name);
    if (!found) fail_msg("%s", dlerror());
    memcpy(function, (const void *)&found, sizeof(void *));
}

static Program program_make(const WeftLobe *lobe, const char *id) {
    const WeftExportDesc desc = {.lobe = lobe, .target = WEFT_EXPORT_C, .ambient = 1, .prefix = "x_"};
    WeftExport made;
    WeftError error;
    if (weft_export(&desc, &made, &error) != WEFT_OK) fail_msg("%s", error.text);
    FILE *file = fopen("ambient.c", "w");
    assert_non_null(file);
    fputs(made.text, file);
    fprintf(file,
            "void look(const float *o, int k, float *out);\nvoid look(const float *o, int k, float *out) {\n"
            "  XDir wo = {o[0], o[1], o[2]}, a = x_%s_ambient_axis(x_%s_default(), wo, k);\n"
            "  out[0] = a.x, out[1] = a.y, out[2] = a.z, out[3] = x_%s_ambient_kappa(x_%s_default(), wo, k);\n}\n",
            id, id, id, id);
    fprintf(file,
            "void light(const float *o, float (*l)[3], float *out);\nvoid light(const float *o, float (*l)[3], float "
            "*out) {\n"
            "  XDir wo = {o[0], o[1], o[2]};\n  XRgb c[7], white = {1.0f, 1.0f, 1.0f};\n"
            "  for (int k = 0; k < 7; k++) c[k].r = l[k][0], c[k].g = l[k][1], c[k].b = l[k][2];\n"
            "  XRgb s = x_%s_ambient(x_%s_default(), white, wo, c[0], c[1], c[2], c[3], c[4], c[5], c[6]);\n"
            "  out[0] = s.r, out[1] = s.g, out[2] = s.b;\n}\n",
            id, id);
    fprintf(file,
            "void eval(const float *o, const float *i, float *out);\nvoid eval(const float *o, const float *i, float "
            "*out) {\n"
            "  XDir wo = {o[0], o[1], o[2]}, wi = {i[0], i[1], i[2]};\n  XRgb white = {1.0f, 1.0f, 1.0f};\n"
            "  XRgb f = x_%s_eval(x_%s_default(), white, wo, wi);\n  out[0] = f.r, out[1] = f.g, out[2] = f.b;\n}\n",
            id, id);
    assert_int_equal(fclose(file), 0);
    weft_export_free(&made);
    assert_int_equal(system("gcc -std=c99 -O1 -Wall -Wextra -Werror -shared -fPIC ambient.c -o ambient.so -lm"), 0);
    Program program = {.library = dlopen("./ambient.so", RTLD_NOW)};
    if (!program.library) fail_msg("%s", dlerror());
    take(program.library, "look", (void *)&program.look);
    take(program.library, "light", (void *)&program.light);
    take(program.library, "eval", (void *)&program.eval);
    return program;
}

/* The frame of a normal, as `weft plot ambient` has it. */
typedef struct Frame {
    Vec3 x, y, z;
} Frame;

static Frame frame_of(Vec3 n) {
    Frame f = {.z = n};
    f.x = vec3_normal_or(vec3_cross(vec3(0.0f, 1.0f, 0.0f), n), vec3(1.0f, 0.0f, 0.0f));
    f.y = vec3_cross(n, f.x);
    return f;
}

static void to_local(const Frame *f, Vec3 w, float out[3]) {
    out[0] = vec3_dot(w, f->x), out[1] = vec3_dot(w, f->y), out[2] = vec3_dot(w, f->z);
}

/* What an engine does: looks the map without its lights up where the text says, and adds the lights. */
static void engine_light(const Program *program, const AmbientParts *parts, Vec3 n, float out[3]) {
    const Frame f = frame_of(n);
    float wo[3], looks[LOOKS][3];
    to_local(&f, vec3(0.0f, 0.0f, 1.0f), wo);
    for (int k = 0; k < LOOKS; k++) {
        float look[4];
        program->look(wo, k, look);
        const Vec3 w = vec3_madd(vec3_madd(vec3_scale(f.x, look[0]), f.y, look[1]), f.z, look[2]);
        ambient_rest_about(parts, w, look[3], looks[k]);
    }
    program->light(wo, (const float(*)[3])looks, out);
    for (int k = 0; k < parts->env_light_count; k++) {
        float wi[3], value[3];
        to_local(&f, parts->env_lights[k].direction, wi);
        if (wi[2] <= 0.0f) continue;
        program->eval(wo, wi, value);
        for (int c = 0; c < 3; c++) out[c] += value[c] * wi[2] * parts->env_lights[k].color[c];
    }
}

static void text_for_c_gives_the_light_of_weft_own_way(void **state) {
    (void)state;
    static const char *const lobes[][2] = {
        {"charlie-neubelt", "charlie_neubelt"}, {"ashikhmin-neubelt", "ashikhmin_neubelt"}, {"ltc-fibre", "ltc_fibre"}};
    static const float normals[][3] = {
        {0.0f, 0.0f, 1.0f}, {0.6f, 0.0f, 0.8f}, {-0.3f, 0.8f, 0.52f}, {0.0f, 0.98f, 0.2f}};
    char folder[SCRATCH_SIZE];
    WeftError error;
    if (system("command -v gcc >/dev/null 2>&1") != 0) skip();
    assert_true(scratch_enter(folder));
    WeftImage image = sky();
    AmbientMap *map;
    AmbientParts parts;
    const Environment environment = {.kind = ENVIRONMENT_IMAGE, .strength = 1.0f, .image = image};
    assert_int_equal(ambient_map_make(&image, &map, &error), WEFT_OK);
    assert_int_equal(ambient_split(&environment, AMBIENT_LIGHTS, &parts, &error), WEFT_OK);
    assert_true(parts.env_light_count > 0);
    for (size_t k = 0; k < sizeof lobes / sizeof *lobes; k++) {
        WeftLobe lobe;
        WeftReflection *reflection;
        assert_int_equal(weft_lobe_init(lobes[k][0], &lobe, &error), WEFT_OK);
        for (int c = 0; c < 3; c++) lobe.f0[c] = lobe.f90[c] = 1.0f;
        assert_int_equal(weft_reflection_of_lobe(&lobe, &reflection, &error), WEFT_OK);
        AmbientModel *model = ambient_model_make(map, &(WeftPlotModel){.reflection = reflection, .lobe = &lobe});
        assert_non_null(model);
        const Program program = program_make(&lobe, lobes[k][1]);
        for (size_t j = 0; j < sizeof normals / sizeof *normals; j++) {
            const Vec3 n = vec3_normal_or(vec3(normals[j][0], normals[j][1], normals[j][2]), vec3(0.0f, 0.0f, 1.0f));
            float reference[3], ways[AMBIENT_WAYS][3], is[3];
            ambient_model_light(model, n, reference, ways);
            engine_light(&program, &parts, n, is);
            print_message("%-18s %zu: %.4f, weft plot %.4f, reference %.4f\n", lobes[k][0], j, (double)is[1],
                          (double)ways[WAY_WEFT][1], (double)reference[1]);
            for (int c = 0; c < 3; c++)
                if (!(fabsf(is[c] - ways[WAY_WEFT][c]) <= 0.02f * ways[WAY_WEFT][c] + 1e-4f))
                    fail_msg("%s, normal %zu: %g is not %g", lobes[k][0], j, (double)is[c], (double)ways[WAY_WEFT][c]);
        }
        dlclose(program.library);
        ambient_model_free(model);
        weft_reflection_free(reflection);
    }
    ambient_map_free(map);
    weft_image_free(&image);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

/* Every look of a map that is 1 everywhere is 1, and the light is then E, whatever the look-ups weigh. */
static void even_map_gives_the_albedo(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE];
    WeftLobe lobe;
    WeftError error;
    if (system("command -v gcc >/dev/null 2>&1") != 0) skip();
    assert_true(scratch_enter(folder));
    assert_int_equal(weft_lobe_init("charlie-neubelt", &lobe, &error), WEFT_OK);
    const Program program = program_make(&lobe, "charlie_neubelt");
    for (int k = 1; k < 10; k++) {
        const float z = 0.1f * (float)k, wo[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        float looks[LOOKS][3], light[3], e[3];
        for (int j = 0; j < 3 * LOOKS; j++) looks[j / 3][j % 3] = 1.0f;
        program.light(wo, (const float(*)[3])looks, light);
        weft_lobe_albedo(&lobe, z, e);
        assert_true(fabsf(light[0] - e[0]) <= 0.01f * e[0] + 1e-3f);
    }
    dlclose(program.library);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void texts_of_other_languages_compile(void **state) {
    (void)state;
    static const struct {
        WeftExportTarget target;
        const char *before, *behind, *command;
    } forms[] = {
        {WEFT_EXPORT_GLSL, "#version 330 core\n", "out vec4 pixel;\nvoid main() { pixel = vec4(1.0); }\n",
         "glslangValidator -S frag text.frag >log 2>&1"},
        {WEFT_EXPORT_ESSL, "#version 300 es\nprecision highp float;\n",
         "out vec4 pixel;\nvoid main() { pixel = vec4(1.0); }\n", "glslangValidator -S frag text.frag >log 2>&1"},
        {WEFT_EXPORT_HLSL, "", "\nfloat4 main() : SV_Target { return 1.0; }\n",
         "glslangValidator -D -V -e main -S frag text.frag -o t.spv >log 2>&1"},
    };
    char folder[SCRATCH_SIZE];
    WeftLobe lobe;
    WeftError error;
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) skip();
    assert_true(scratch_enter(folder));
    assert_int_equal(weft_lobe_init("charlie-neubelt", &lobe, &error), WEFT_OK);
    for (size_t k = 0; k < sizeof forms / sizeof *forms; k++) {
        const WeftExportDesc desc = {.lobe = &lobe, .target = forms[k].target, .ambient = 1};
        WeftExport made;
        if (weft_export(&desc, &made, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_true(made.table_count > 0);
        FILE *file = fopen("text.frag", "w");
        assert_non_null(file);
        fprintf(file, "%s%s%s", forms[k].before, made.text, forms[k].behind);
        assert_int_equal(fclose(file), 0);
        if (system(forms[k].command) != 0) fail_msg("%s: %s", weft_export_target_name((int)desc.target), made.text);
        weft_export_free(&made);
    }
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void lobes_beyond_look_ups_are_refused(void **state) {
    (void)state;
    static const char *const lobes[][2] = {{"ggx", "two colours"}, {"fibre", "its colour"}};
    WeftLobe lobe;
    WeftExport made;
    WeftError error;
    for (size_t k = 0; k < sizeof lobes / sizeof *lobes; k++) {
        assert_int_equal(weft_lobe_init(lobes[k][0], &lobe, &error), WEFT_OK);
        assert_int_equal(weft_export(&(WeftExportDesc){.lobe = &lobe, .ambient = 1}, &made, &error), WEFT_USAGE);
        if (!strstr(error.text, lobes[k][1])) fail_msg("%s: %s", lobes[k][0], error.text);
    }
    assert_int_equal(weft_export(&(WeftExportDesc){.profile = "khronos", .ambient = 1}, &made, &error), WEFT_USAGE);
    const WeftExportDesc toy = {.lobe = &lobe, .ambient = 1, .target = WEFT_EXPORT_SHADERTOY};
    assert_int_equal(weft_export(&toy, &made, &error), WEFT_USAGE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_for_c_gives_the_light_of_weft_own_way),
        cmocka_unit_test(even_map_gives_the_albedo),
        cmocka_unit_test(texts_of_other_languages_compile),
        cmocka_unit_test(lobes_beyond_look_ups_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
