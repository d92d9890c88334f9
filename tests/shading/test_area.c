/* A surface under polygon lights: what whole stacks reflect, against brute force in double; nothing infinite
 * in hostile poses; the same in GLSL and on a GPU
 *
 * Labels: unsanitized */
#include "cases.h"
#include "lights.h"

#include "raster/frame/compute.h"
#include "scratch.h"
#include "shading/lobe/lobe_tables.h"
#include "text/assemble/dispatch.h"
#include "text/assemble/tables.h"

enum { POSES = 20 };

/* Where the test looks from: a few points a pose, more in long runs. */
static int spots(void) { return test_long() ? 24 : 6; }

typedef SeenStack (*StackAt)(const void *what, Dir o);
static SeenStack lone(const void *what, Dir o) { return light_lone(*(const Lobe *)what, o); }

/* sum |difference| / sum reference over the poses, of the green channel. */
static double error_of(StackAt stack_at, const void *what, int least) {
    uint64_t random = 7;
    double off = 0.0, all = 0.0;
    for (int p = 0; p < POSES; p++) {
        LightPose pose = light_pose(&random);
        for (int s = 0; s < spots(); s++) {
            Light light = light_seen(&pose, s % 2 == 1, &random);
            SeenStack m = stack_at(what, light.o);
            double expected = light_integral(light_stack, &m, light.o, light.corners, 4, least);
            double got = (double)light_on(&m, light_polygon(light.corners, 4)).g;
            assert_true(isfinite(got));
            off += fabs(got - expected);
            all += expected;
        }
    }
    return off / all;
}

static void a_lobe_is_near(Lobe lobe, double most, int least) {
    double error = error_of(lone, &lobe, least);
    print_message("%-28s %-5.3g %6.3f %%\n", weft_lobe_info(lobe.id)->id, (double)lobe.params[0], 100.0 * error);
    if (!(error <= most)) fail_msg("more than %g %%", 100.0 * most);
}

static void diffuse_base_under_a_polygon_is_exact(void **state) {
    (void)state;
    a_lobe_is_near(lobe_default(LOBE_LAMBERT), 0.001, 3);
    for (int id = 0; id < LOBE_COUNT; id++)
        if (weft_lobe_info(id)->traits & TRAIT_DIFFUSE) a_lobe_is_near(lobe_rough(id, 0.7f), 0.005, 2);
}

static void highlights_under_a_polygon_are_near_the_integral(void **state) {
    (void)state;
    static const float roughness[] = {0.2f, 0.35f, 0.5f, 0.7f, 1.0f};
    for (int k = 0; k < 5; k++) a_lobe_is_near(lobe_rough(LOBE_GGX, roughness[k]), 0.04, k < 1 ? 4 : 3);
    Lobe brushed = lobe_rough(LOBE_GGX, 0.5f);
    brushed.params[1] = 0.6f;
    a_lobe_is_near(brushed, 0.06, 3);
    a_lobe_is_near(lobe_rough(LOBE_SILK, 0.5f), 0.06, 3);
}

/* All that a sheen can be, as rough as alpha 0.1 and 0.5 are. */
static void sheens_under_a_polygon_are_near_the_integral(void **state) {
    (void)state;
    int at = 0;
    for (int id = 0; id < LOBE_COUNT; id++) {
        const WeftLobeInfo *info = weft_lobe_info(id);
        if (info->traits & (TRAIT_REFERENCE | TRAIT_DIFFUSE) || id == LOBE_GGX || id == LOBE_COOK_TORRANCE) continue;
        /* a highlight, a streak, and one that turns with the azimuth */
        bool coat = id == LOBE_BURLEY_COAT || id == LOBE_SILK || id == LOBE_LTC_FIBRE_HALF;
        for (int k = 0; k < 3; k++) {
            static const float alphas[] = {0.1f, 0.25f, 0.5f};
            if (test_turn(&at, 5, 7))
                a_lobe_is_near(lobe_rough(id, sqrt(alphas[k])), coat ? 0.08 : 0.05, k == 0 ? 3 : 2);
            if (info->param_count == 0) break;
        }
    }
}

static void leaning_sheens_under_a_polygon_are_near_the_integral(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++)
        a_lobe_is_near(lobe_fibres(lobe_rough(LOBE_FIBRE, 0.32f), 1.0f, k ? 0.5f : 0.05f, 1.0f), 0.05, 2);
}

/* A whole surface: its table of E, its choices. */
typedef struct Whole {
    Surface surface;
    Choices choices;
    const AlbedoTable *table;
} Whole;

static SeenStack whole(const void *what, Dir o) {
    const Whole *w = what;
    SeenStack m;
    seen_make(&m, &w->surface, &w->choices, albedo_table_ref(w->table), o);
    return m;
}

static AlbedoTable charlie;

/* A base under a sheen, each rule taking from it what it does for every wi; and what a rule takes matters. */
static void layer_rules_dim_the_base_under_a_polygon(void **state) {
    (void)state;
    static const int rules[] = {LAYER_ADDITIVE, LAYER_SEED, LAYER_ALBEDO_VIEW, LAYER_ALBEDO_MAX, LAYER_RECIPROCAL};
    for (int k = 0; k < 5; k++) {
        Whole w = {white_cloth(0.4f), test_choices(LOBE_CHARLIE_NEUBELT, rules[k]), &charlie};
        w.surface.base_color = rgb(0.7f, 0.6f, 0.5f);
        w.surface.ior = 1.5f;
        w.surface.roughness = 0.4f;
        w.surface.specular = 1.0f;
        w.surface.specular_color = rgb_grey(1.0f);
        double error = error_of(whole, &w, 3);
        print_message("%-12s %6.3f %%\n", weft_layer_name(rules[k]), 100.0 * error);
        assert_true(error < 0.02);
    }
}

/* Coats with normals of their own, metals, anisotropy, dust: all that a material has. */
static void surfaces_under_a_polygon_are_near_the_integral(void **state) {
    (void)state;
    Random random = {8};
    double sum = 0.0;
    int n = test_long() ? 40 : test_short() ? 2 : 4;
    for (int k = 0; k < n; k++) {
        Whole w = {random_surface(&random, true), test_choices(LOBE_CHARLIE_NEUBELT, LAYER_ALBEDO_MAX), &charlie};
        w.surface.roughness = max(w.surface.roughness, 0.3f);
        if (k % 2) w.surface = dusted(w.surface, 0.5f);
        double error = error_of(whole, &w, 3);
        sum += error;
        if (!(error < 0.05)) fail_msg("surface %d: %g %%", k, 100.0 * error);
    }
    print_message("%d surfaces: %.3f %% on average\n", n, 100.0 * sum / n);
}

/* Corners and viewers that nobody would ask for. */
static Polygon hostile_polygon(uint64_t *random) {
    Point corners[8];
    int count = any_polygon(random, 1.0, corners), kind = (int)(12.0 * light_random(random));
    double size = (exp2)(40.0 * light_random(random) - 20.0);
    for (int k = 0; k < count; k++) {
        Point *c = &corners[k];
        if (kind == 0) *c = point(0.0, 0.0, 0.0);                         /* the point itself */
        if (kind == 1) c->z = 0.0;                                        /* in the surface */
        if (kind == 2) *c = corners[0];                                   /* no extent */
        if (kind == 3) *c = point_add(corners[0], corners[1], k);         /* a line */
        if (kind == 4) *c = point(c->x, c->y, 1e-7 * c->z);               /* flat on the horizon */
        if (kind == 5) *c = point_add(*c, corners[0], k ? -1.0 : -1.0);   /* one corner at the point */
        if (kind == 6) c->z = 1e-9;                                       /* the surface touches the light */
        if (kind == 7) c->z = -fabs(c->z);                                /* below */
        if (kind == 8 && k % 2) *c = corners[k - 1];                      /* corners twice */
        *c = point_add(point(0.0, 0.0, 0.0), *c, kind == 9 ? 1.0 : size); /* of any size */
    }
    return light_polygon(corners, count);
}

static Dir hostile_view(uint64_t *random) {
    double kind = light_random(random), z = 1.0 - light_random(random);
    if (kind < 0.2) z = (exp2)(-20.0 * z);
    if (kind > 0.9) z = 1.0;
    double r = (sqrt)(1.0 - z * z), phi = 2.0 * PI_DOUBLE * light_random(random);
    return dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), (float)z);
}

static void hostile_polygons_give_finite_light(void **state) {
    (void)state;
    uint64_t random = 9;
    Random surfaces = {9};
    long n = test_long() ? 10000000 : test_short() ? 10000 : 100000;
    for (long k = 0; k < n; k++) {
        int id = (int)(k % LOBE_COUNT);
        Dir o = hostile_view(&random);
        Polygon p = hostile_polygon(&random);
        SeenStack m;
        if (k % 4 == 0 || case_walks(id)) {
            Whole w = {random_surface(&surfaces, true), test_choices(LOBE_CHARLIE_NEUBELT, (int)(k / 4 % LAYER_COUNT)),
                       &charlie};
            w.surface.roughness = 2.0f * random_unit(&surfaces) * random_unit(&surfaces);
            m = whole(&w, o);
        } else {
            m = light_lone(case_lobe(id, (int)(light_random(&random) * case_count(id))), o);
        }
        Rgb c = light_on(&m, p);
        if (!(isfinite(c.r) && isfinite(c.g) && isfinite(c.b) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f))
            fail_msg("%s, evaluation %ld: %g %g %g", weft_lobe_info(id)->id, k, (double)c.r, (double)c.g, (double)c.b);
    }
}

/* A stack in all of its slots, out of a row of numbers: made in C and in GLSL alike. */
static const int gpu_lobes[] = {LOBE_LAMBERT, LOBE_GGX, LOBE_CHARLIE_NEUBELT, LOBE_SILK, LOBE_FIBRE};
enum { GPU_LOBES = sizeof gpu_lobes / sizeof *gpu_lobes, GPU_INPUTS = 8, GPU_SAMPLES = 4096 };

static SeenStack row_stack(int sheen, float roughness, Dir n, Dir o) {
    SeenStack seen;
    Stack *m = &seen.stack;
    stack_clear(m);
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), rgb(0.7f, 0.5f, 0.3f), rgb_grey(0.0f), 1.0f);
    slot_even(&m->specular, lobe_rough(LOBE_GGX, roughness), rgb_grey(0.04f), rgb_grey(1.0f), 1.0f);
    slot_even(&m->sheen, lobe_rough(sheen, roughness), rgb(0.2f, 0.4f, 0.6f), rgb_grey(1.0f), 1.0f);
    slot_even(&m->coat, lobe_rough(LOBE_GGX, 0.3f), rgb_grey(0.1f), rgb_grey(0.2f), 1.0f);
    stack_coat_frame(m, n);
    m->base_fresnel = BASE_FRESNEL_LEAST;
    m->interface_f0 = rgb_grey(0.04f);
    m->interface_f90 = 1.0f;
    m->layer = LAYER_ALBEDO_MAX;
    m->color = rgb(0.2f, 0.4f, 0.6f);
    m->table = lobe_table_charlie_neubelt();
    m->albedo_coord = 0.3f;
    seen_prepare(&seen, o);
    return seen;
}

static const char stack_text[] =
    "\nStack row_stack(int sheen, float roughness, Dir n) {\n    Stack m;\n    stack_clear(m);\n"
    "    Rgb blue = rgb(0.2, 0.4, 0.6), white = rgb_grey(1.0);\n"
    "    slot_even(m.diffuse, lobe_default(LOBE_LAMBERT), rgb(0.7, 0.5, 0.3), rgb_grey(0.0), 1.0);\n"
    "    slot_even(m.specular, lobe_rough(LOBE_GGX, roughness), rgb_grey(0.04), white, 1.0);\n"
    "    slot_even(m.sheen, lobe_rough(sheen, roughness), blue, white, 1.0);\n"
    "    slot_even(m.coat, lobe_rough(LOBE_GGX, 0.3), rgb_grey(0.1), rgb_grey(0.2), 1.0);\n"
    "    stack_coat_frame(m, n);\n    m.base_fresnel = BASE_FRESNEL_LEAST;\n    m.interface_f0 = "
    "rgb_grey(0.04);\n"
    "    m.interface_f90 = 1.0;\n    m.layer = LAYER_ALBEDO_MAX;\n    m.color = blue;\n"
    "    m.table = lobe_table_charlie_neubelt();\n    m.albedo_coord = 0.3;\n    stack_prepare(m);\n"
    "    return m;\n}";

static void begin_text(Text *text, TextLanguage language) {
    text_begin(text, &(TextDesc){.language = language, .tables = true});
    text_dispatch(text, gpu_lobes, GPU_LOBES);
    text_lobe_tables(text);
    text_engine_tables(text, NULL, 0);
    text_include(text, "shading/area/area.h");
    text_line(text, "%s", stack_text);
}

static void polygon_text_is_valid_glsl(void **state) {
    (void)state;
    static const TextLanguage languages[] = {TEXT_GLSL_330, TEXT_GLSL_ES_300, TEXT_GLSL_450};
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) {
        print_message("glslangValidator is not installed\n");
        skip();
    }
    char folder[SCRATCH_SIZE], path[64], command[256];
    assert_true(scratch_make(folder));
    for (int l = 0; l < 3; l++) {
        Text text;
        WeftError error;
        bool vulkan = languages[l] == TEXT_GLSL_450;
        begin_text(&text, languages[l]);
        text_line(&text,
                  "\n%sout vec4 color;\nvoid main() {\n    Polygon p;\n    p.count = 4;\n"
                  "    for (int k = 0; k < 4; k++) p.corners[k] = dir(float(k), float(k * k), 1.0);\n"
                  "    Dir o = dir(0.6, 0.0, 0.8);\n    Stack m = row_stack(LOBE_FIBRE, 0.5, o);\n"
                  "    StackView w;\n    stack_view(m, o, w);\n    Rgb c = stack_polygon(m, w, p);\n"
                  "    color = vec4(c.r, c.g, c.b, polygon_ltc(area_cosine(o).m, o, p));\n}",
                  vulkan ? "layout(location = 0) " : "");
        if (text_end(&text, &error) != WEFT_OK) fail_msg("%s", error.text);
        snprintf(path, sizeof path, "%s/%d.frag", folder, l);
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_true(fputs(text.bytes, file) >= 0);
        assert_int_equal(fclose(file), 0);
        snprintf(command, sizeof command, "cd %s && glslangValidator %s -S frag %d.frag", folder,
                 vulkan ? "-V -o /dev/null" : "", l);
        assert_int_equal(system(command), 0);
        text_free(&text);
    }
    assert_true(scratch_remove(folder));
}

/* in0: o, sheen. in1: normal of the coat, roughness. in2 to in7: six corners; in2.w: how many. */
static const char body[] =
    "    Polygon p;\n    p.count = int(in2.w);\n"
    "    p.corners[0] = dir(in2.x, in2.y, in2.z);\n    p.corners[1] = dir(in3.x, in3.y, in3.z);\n"
    "    p.corners[2] = dir(in4.x, in4.y, in4.z);\n    p.corners[3] = dir(in5.x, in5.y, in5.z);\n"
    "    p.corners[4] = dir(in6.x, in6.y, in6.z);\n    p.corners[5] = dir(in7.x, in7.y, in7.z);\n"
    "    Dir o = dir(in0.x, in0.y, in0.z), n = dir(in1.x, in1.y, in1.z);\n"
    "    Stack m = row_stack(int(in0.w), in1.w, n);\n    StackView w;\n    stack_view(m, o, w);\n"
    "    Rgb c = stack_polygon(m, w, p);\n"
    "    out0 = vec4(c.r, c.g, c.b, polygon_cosine(p));\n";

static float gpu_in[GPU_INPUTS][4 * GPU_SAMPLES], gpu_out[4 * GPU_SAMPLES], gpu_want[4 * GPU_SAMPLES];

static void fill_samples(void) {
    static const int sheens[] = {LOBE_CHARLIE_NEUBELT, LOBE_SILK, LOBE_FIBRE};
    uint64_t random = 10;
    for (int s = 0; s < GPU_SAMPLES; s++) {
        Point corners[8];
        int count = any_polygon(&random, 1.5, corners), sheen = sheens[s % 3];
        if (count > 6) count = 6;
        Polygon p = light_polygon(corners, count);
        Dir o = direction_cos(0.02 + 0.98 * light_random(&random), 6.0 * light_random(&random));
        Dir n = direction(0.4 * light_random(&random), 6.0 * light_random(&random));
        float roughness = (float)(0.3 + 0.7 * light_random(&random));
        const float head[2][4] = {{o.x, o.y, o.z, (float)sheen}, {n.x, n.y, n.z, roughness}};
        for (int k = 0; k < 2; k++) memcpy(&gpu_in[k][4 * s], head[k], sizeof head[k]);
        for (int k = 0; k < count; k++) {
            const float corner[4] = {p.corners[k].x, p.corners[k].y, p.corners[k].z, (float)count};
            memcpy(&gpu_in[2 + k][4 * s], corner, sizeof corner);
        }
        SeenStack m = row_stack(sheen, roughness, n, o);
        Rgb c = light_on(&m, p);
        const float want[4] = {c.r, c.g, c.b, polygon_cosine(p)};
        memcpy(&gpu_want[4 * s], want, sizeof want);
    }
}

static void compare_on(TextLanguage language) {
    GlContext *context;
    Compute *compute;
    Text text;
    WeftError error = {0};
    if (context_create(language, &context, &error) != WEFT_OK) {
        print_message("%s\n", error.text);
        skip();
    }
    begin_text(&text, language);
    assert_int_equal(text_end(&text, &error), WEFT_OK);
    ComputeDesc desc = {.name = "a polygon light", .text = &text, .body = body, .inputs = GPU_INPUTS, .outputs = 1};
    if (compute_create(context, &desc, &compute, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(compute_tables(compute, text.tables, text.table_count, &error), WEFT_OK);
    const float *ins[GPU_INPUTS];
    for (int k = 0; k < GPU_INPUTS; k++) ins[k] = gpu_in[k];
    float *const outs[] = {gpu_out};
    assert_int_equal(compute_run(compute, GPU_SAMPLES, ins, outs, &error), WEFT_OK);
    int beyond = 0;
    for (int k = 0; k < 4 * GPU_SAMPLES; k++)
        beyond += !(fabsf(gpu_out[k] - gpu_want[k]) < 1e-3f * gpu_want[k] + 1e-5f);
    print_message("%d of %d numbers differ\n", beyond, 4 * GPU_SAMPLES);
    assert_true(beyond <= 4 * GPU_SAMPLES / 1000);
    compute_destroy(compute);
    text_free(&text);
    context_destroy(context);
}

static void polygon_light_in_glsl_agrees_with_c(void **state) {
    (void)state;
    fill_samples();
    compare_on(TEXT_GLSL_330);
    compare_on(TEXT_GLSL_ES_300);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diffuse_base_under_a_polygon_is_exact),
        cmocka_unit_test(highlights_under_a_polygon_are_near_the_integral),
        cmocka_unit_test(sheens_under_a_polygon_are_near_the_integral),
        cmocka_unit_test(leaning_sheens_under_a_polygon_are_near_the_integral),
        cmocka_unit_test(layer_rules_dim_the_base_under_a_polygon),
        cmocka_unit_test(surfaces_under_a_polygon_are_near_the_integral),
        cmocka_unit_test(hostile_polygons_give_finite_light),
        cmocka_unit_test(polygon_text_is_valid_glsl),
        cmocka_unit_test(polygon_light_in_glsl_agrees_with_c),
    };
    lobe_tables_make();
    fill_albedo(&charlie, LOBE_CHARLIE_NEUBELT);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
