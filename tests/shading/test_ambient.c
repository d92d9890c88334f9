/* Light of an environment in C, over all lobes: under even light every strategy returns E; weights are not
 * negative; a far light gives what f says; sharp light is met within a few hundredths; occlusion takes what it
 * says; layers and coats leave what they should; lights and residual are all of an environment */
#include "cases.h"

#include "scene/light/env_split.h"
#include "shading/ambient/ambient.h"
#include "shading/ambient/ambient_fit.h"

/* An environment that is even, with a light or two. */
typedef struct Even {
    float radiance;
    int count;
    AmbientLight env_lights[2];
} Even;

static Rgb even_about(const void *user, Dir w, float kappa) {
    (void)w, (void)kappa;
    return rgb_grey(((const Even *)user)->radiance);
}
static Rgb even_irradiance(const void *user, Dir w) { return even_about(user, w, 0.0f); }
static AmbientLight even_light(const void *user, int k) { return ((const Even *)user)->env_lights[k]; }

static AmbientSourceCalls even_calls(const Even *even) {
    return (AmbientSourceCalls){even_about, even_irradiance, even_about, even_light, even, even->count, 6.0f,
                                NULL,       even_light,      even->count};
}

static bool asked(int lobe) { return !(weft_lobe_info(lobe)->traits & TRAIT_REFERENCE); }

/* Where roughness 0.1 and 1 are. */
static void fit(AmbientFit *to, int id) {
    Lobe lobe = lobe_default(id);
    float a = lobe_rough(id, 0.1f).params[0], b = lobe_rough(id, 1.0f).params[0];
    ambient_fit(to, &lobe, min(a, b), max(a, b), 0);
}

static void fit_one(AmbientFit *to, int id, float roughness) {
    Lobe lobe = lobe_rough(id, roughness);
    ambient_fit(to, &lobe, lobe.params[0], lobe.params[0], 0);
}

static AmbientTables all_tables(AmbientTable t) { return (AmbientTables){t, t, t, t, t}; }

static SeenStack one_lobe(Lobe lobe, Dir o) {
    SeenStack m;
    stack_clear(&m.stack);
    slot_even(&m.stack.sheen, lobe, rgb_grey(1.0f), rgb_grey(1.0f), 1.0f);
    seen_prepare(&m, o);
    return m;
}

static Rgb ambient_of(SeenStack m, AmbientTables t, AmbientSource s, float occlusion) {
    return stack_ambient(&m.stack, &m.view, t, s, occlusion, occlusion);
}

/* Direction k of some: of a lobe that turns at 0 to 180 degrees, since a table stands for either side. */
static Dir direction_about(int id, double cos_theta, int k) {
    bool turns = weft_lobe_info(id)->traits & TRAIT_ANISOTROPIC;
    return direction_cos(cos_theta, turns ? (double)(k % 5) * 0.25 * PI_DOUBLE : 0.0);
}

/* What the table has for E is E, at nodes and between them, and no weight takes light away. */
static void even_environment_returns_the_albedo(void **state) {
    (void)state;
    static AmbientFit table;
    Even even = {.radiance = 1.0f};
    AmbientSourceCalls calls = even_calls(&even);
    int at = 0;
    for (int id = 0; id < LOBE_COUNT; id++) {
        if (!asked(id) || !test_turn(&at, 1, 7)) continue;
        fit(&table, id);
        int headings = table.by_azimuth ? AMBIENT_HEADINGS : 1;
        for (int plane = 0; plane < headings * AMBIENT_PLANES; plane++)
            for (int row = 0; row < table.rows; row++)
                for (int column = 0; column < AMBIENT_COLUMNS; column++) {
                    int k = plane % AMBIENT_PLANES;
                    if (k < 4 || k >= 4 * AMBIENT_GROUP_SECOND)
                        assert_true(table.texels[plane * table.rows + row][column] >= 0.0f);
                }
        for (int k = 0; k < 12; k++) {
            Lobe lobe = lobe_rough(id, 0.35f + 0.2f * (float)(k % 4));
            Dir o = direction_about(id, 0.15 + 0.28 * (double)(k / 4), k);
            Albedo e = albedo_quadrature(&lobe, o, 1e-3);
            for (int s = 0; s < AMBIENT_STRATEGIES; s++) {
                Rgb got = ambient_of(one_lobe(lobe, o), all_tables(ambient_table(&table, s)), &calls, 1.0f);
                float off = abs(got.r - (e.f0 + e.f90));
                /* E of fibres as good as appears near grazing at low alpha: rows are far apart there */
                if (off > 0.01f * (e.f0 + e.f90) + 0.009f)
                    fail_msg("%s, strategy %d, cosine %g: %g for %g", weft_lobe_info(id)->id, s, (double)o.z,
                             (double)got.r, (double)(e.f0 + e.f90));
            }
        }
    }
}

/* A table knows how far wo is from the nap, not on which side, and a yarn that runs athwart differs by that: it has the
 * mean of both. */
static void table_of_an_uneven_lobe_has_the_mean_of_both_sides(void **state) {
    (void)state;
    static AmbientFit table;
    Even even = {.radiance = 1.0f};
    AmbientSourceCalls calls = even_calls(&even);
    Lobe lobe = lobe_rough(LOBE_YARN, 0.35f);
    lobe_set(&lobe, weft_lobe_param_find(LOBE_YARN, "azimuth"), 0.25f * PI);
    ambient_fit(&table, &lobe, lobe.params[0], lobe.params[0], 0);
    float e[2], got[2];
    for (int k = 0; k < 2; k++) {
        Dir o = direction_cos(0.2, k ? -0.25 * (double)PI : 0.25 * (double)PI);
        Albedo albedo = albedo_quadrature(&lobe, o, 1e-3);
        e[k] = albedo.f0 + albedo.f90;
        got[k] = ambient_of(one_lobe(lobe, o), all_tables(ambient_table(&table, AMBIENT_IRRADIANCE)), &calls, 1.0f).r;
    }
    assert_true(abs(e[0] - e[1]) > 0.05f * e[0]);
    for (int k = 0; k < 2; k++) assert_float_equal(got[k], 0.5f * (e[0] + e[1]), 0.01f);
}

/* A table of that lobe alone, baked as polynomials. */
static AmbientTable bake(const Lobe *lobe, int strategy, AmbientWeights baked[AMBIENT_BAKED]) {
    static AmbientFit fitted;
    ambient_fit(&fitted, lobe, lobe->params[0], lobe->params[0], 0);
    ambient_bake(&fitted, baked);
    AmbientTable t = ambient_table(&fitted, strategy);
    t.baked = 0;
    return t;
}

/* Baked as polynomials the same table still has E, where a lobe turns too. */
static void baked_weights_return_the_albedo(void **state) {
    (void)state;
    static AmbientWeights baked[AMBIENT_BAKED];
    Even even = {.radiance = 1.0f};
    AmbientSourceCalls calls = even_calls(&even);
    calls.baked = baked;
    int at = 0;
    for (int id = 0; id < LOBE_COUNT; id++)
        for (int k = 0; asked(id) && k < 9; k++) {
            if (!test_turn(&at, 1, 11)) continue;
            Lobe lobe = lobe_rough(id, 0.4f + 0.25f * (float)(k % 3));
            Dir o = direction_about(id, 0.15 + 0.35 * (double)(k / 3), k);
            AmbientTable t = bake(&lobe, AMBIENT_FITTED, baked);
            Albedo e = albedo_quadrature(&lobe, o, 1e-3);
            Rgb got = ambient_of(one_lobe(lobe, o), all_tables(t), &calls, 1.0f);
            float truth = e.f0 + e.f90, off = abs(got.r - truth);
            if (off > 0.02f * truth + 0.009f)
                fail_msg("%s, cosine %g: %g for %g", weft_lobe_info(id)->id, (double)o.z, (double)got.r, (double)truth);
        }
}

/* E of that lobe alone, as a stack asks for it. */
static void fill_own(AlbedoTable *table, const Lobe *lobe) {
    albedo_table_fill(table, lobe, lobe->params[0], lobe->params[0], 0);
}

/* A sheen with that table. */
static SeenStack tabled(Lobe lobe, Dir o, const AlbedoTable *table) {
    SeenStack m = one_lobe(lobe, o);
    m.stack.table = albedo_table_ref(table);
    m.stack.albedo = ALBEDO_TABLE;
    m.stack.albedo_coord = lobe.params[0];
    seen_prepare(&m, o);
    return m;
}

/* Where a lobe fades away, its polynomials swing about zero: nothing becomes negative, or much. */
static void baked_weights_of_a_fading_lobe_are_not_negative(void **state) {
    (void)state;
    static const float roughnesses[] = {0.1f, 0.14f, 0.22f, 0.6f};
    static const float cosines[] = {1.0f, 0.995f, 0.97f, 0.9f, 0.7f, 0.3f, 0.03f};
    static AlbedoTable albedo;
    static AmbientWeights baked[AMBIENT_BAKED];
    Even even = {.radiance = 1.0f};
    AmbientSourceCalls calls = even_calls(&even);
    calls.baked = baked;
    int at = 0;
    for (int id = 0; id < LOBE_COUNT; id++)
        for (size_t k = 0; asked(id) && k < sizeof roughnesses / sizeof roughnesses[0]; k++) {
            if (!test_turn(&at, 1, 11)) continue;
            Lobe lobe = lobe_rough(id, roughnesses[k]);
            AmbientTable t = bake(&lobe, ambient_strategy(id, true, false), baked);
            fill_own(&albedo, &lobe);
            for (size_t n = 0; n < sizeof cosines / sizeof cosines[0]; n++) {
                Dir o = direction_cos((double)cosines[n], 0.0);
                SeenStack m = tabled(lobe, o, &albedo);
                Rgb got = stack_ambient(&m.stack, &m.view, all_tables(t), &calls, 1.0f, 1.0f);
                Albedo own = albedo_quadrature(&lobe, o, 1e-4);
                float e = lobe_depends_on_azimuth(&lobe) ? own.f0 + own.f90
                                                         : m.view.e_o.e; /* a brushed lobe's table is a bound */
                if (!(got.r >= 0.0f && abs(got.r - e) <= 0.03f * e + 0.003f))
                    fail_msg("%s, roughness %g, cosine %g: %g for %g", weft_lobe_info(id)->id, (double)roughnesses[k],
                             (double)o.z, (double)got.r, (double)e);
            }
        }
}

/* A sheen that is next to nothing at the normal and much at the rim has its E under a white sky all the same,
 * to a hundredth of itself. */
static void faint_sheens_keep_albedo_under_a_white_sky(void **state) {
    (void)state;
    static const int lobes[] = {LOBE_FIBRE, LOBE_LTC_FIBRE, LOBE_PATRY, LOBE_CHARLIE_NEUBELT};
    static AlbedoTable albedo;
    static AmbientWeights baked[AMBIENT_BAKED];
    Even even = {.radiance = 1.0f};
    AmbientSourceCalls calls = even_calls(&even);
    calls.baked = baked;
    int at = 0;
    for (int k = 0; k < 4 * 5; k++) {
        if (!test_turn(&at, 1, 3)) continue;
        Lobe lobe = lobe_rough(lobes[k % 4], 0.25f + 0.05f * (float)(k / 4));
        AmbientTable t = bake(&lobe, AMBIENT_FITTED, baked);
        fill_own(&albedo, &lobe);
        for (int n = 1; n < 40; n++) {
            Dir o = direction_cos(0.025 * n, 0.0);
            SeenStack m = tabled(lobe, o, &albedo);
            for (t.strategy = 0; t.strategy < AMBIENT_STRATEGIES; t.strategy++) {
                Rgb got = stack_ambient(&m.stack, &m.view, all_tables(t), &calls, 1.0f, 1.0f);
                if (!(abs(got.r - m.view.e_o.e) <= 0.01f * m.view.e_o.e + 1e-9f))
                    fail_msg("%s, alpha %g, strategy %d, cosine %g: %g for %g", weft_lobe_info(lobe.id)->id,
                             (double)lobe.params[0], t.strategy, (double)o.z, (double)got.r, (double)m.view.e_o.e);
            }
        }
    }
}

/* An environment of lights alone is reflected by a broad lobe as f itself. */
static void environment_lights_are_shaded_as_lights(void **state) {
    (void)state;
    static AmbientFit table;
    Even even = {.count = 2};
    even.env_lights[0] = (AmbientLight){direction(0.6, 1.0), rgb(2.0f, 1.0f, 0.5f), 20.0f, 0};
    even.env_lights[1] = (AmbientLight){direction(1.4, 4.0), rgb(0.1f, 0.3f, 3.0f), 20.0f, 1};
    AmbientSourceCalls calls = even_calls(&even);
    Lobe lobe = lobe_rough(LOBE_CHARLIE_CONTY_KULLA, 0.5f);
    fit(&table, lobe.id);
    AmbientTables tables = all_tables(ambient_table(&table, AMBIENT_FITTED));
    Dir o = direction(0.9, 0.2);
    float f[2];
    for (int k = 0; k < 2; k++)
        f[k] = lobe_eval(&lobe, angles_between(o, even.env_lights[k].w)) * even.env_lights[k].w.z;
    Rgb got = ambient_of(one_lobe(lobe, o), tables, &calls, 1.0f);
    assert_float_equal(got.r, 2.0f * f[0] + 0.1f * f[1], 1e-6);
    assert_float_equal(got.g, f[0] + 0.3f * f[1], 1e-6);
    assert_float_equal(got.b, 0.5f * f[0] + 3.0f * f[1], 1e-6);
    /* a crease dims them */
    got = ambient_of(one_lobe(lobe, o), tables, &calls, 0.6f);
    assert_float_equal(got.r, 0.6f * (2.0f * f[0] + 0.1f * f[1]), 1e-6);
}

/* Grey fibres reflect a light as they do from its direction, and an even sky as they do from all. */
static void tinted_lobes_have_the_tint_of_a_direction(void **state) {
    (void)state;
    static AlbedoTable albedo;
    static AmbientFit table;
    const float grey = 0.3f;
    int checked = 0;
    for (int id = 0; id < LOBE_COUNT; id++) {
        if (!(weft_lobe_info(id)->traits & TRAIT_TINTED) || !asked(id)) continue;
        Lobe lobe = lobe_rough(id, 0.7f);
        fit_one(&table, id, 0.7f);
        fill_own(&albedo, &lobe);
        SeenStack m = tabled(lobe, direction(0.3, 0.2), &albedo);
        m.stack.sheen.f0 = rgb_grey(grey);
        for (int k = 0; k < 6; k++) {
            Dir o = direction(0.3 + 0.2 * k, 0.2), w = direction(1.2, 0.4 + 0.5 * k);
            Even even = {.count = 1, .env_lights = {{w, rgb_grey(1.0f), 1e9f, 0}}}, sky = {.radiance = 1.0f};
            AmbientSourceCalls one = even_calls(&even), all = even_calls(&sky);
            seen_prepare(&m, o);
            LobeValue x = lobe_value(&lobe, angles_between(o, w));
            float f = x.f * w.z * tint_color(x.tint, grey);
            AmbientTables tables = all_tables(ambient_table(&table, AMBIENT_SAMPLED));
            assert_float_equal(ambient_of(m, tables, &one, 1.0f).r, f, 1e-4f * f + 1e-7f);
            float e = m.view.e_o.e * tint_color(m.view.e_o.tint, grey);
            assert_float_equal(ambient_of(m, tables, &all, 1.0f).r, e, 0.04f * e + 2e-4f);
            checked++;
        }
    }
    assert_true(checked > 0);
}

/* Grey fibres that lean reflect an even sky as they do from all directions, to whichever side the viewer is. */
static void leaning_lobes_have_the_tint_of_their_heading(void **state) {
    (void)state;
    static AlbedoTable albedo;
    static AmbientWeights baked[AMBIENT_BAKED];
    static AmbientFit table;
    const float greys[3] = {0.1f, 0.3f, 0.8f};
    int checked = 0;
    for (int id = 0; id < LOBE_COUNT; id++) {
        if (!(weft_lobe_info(id)->traits & TRAIT_TINTED) || !asked(id) || ambient_lean_azimuth(id) < 0) continue;
        for (int k = 0; k < 3; k++) {
            Lobe lobe = lobe_rough(id, 0.65f + 0.1f * (float)k);
            lobe_set(&lobe, weft_lobe_param_find(id, "tilt"), 0.2f + 0.15f * (float)k);
            fill_own(&albedo, &lobe);
            AmbientTable t = bake(&lobe, ambient_strategy(id, true, false), baked);
            ambient_fit(&table, &lobe, 0.9f * lobe.params[0], lobe.params[0], 0);
            for (int n = 0; n < 20; n++) {
                Dir o = direction_cos(0.1 + 0.2 * (n % 4), 0.25 * PI_DOUBLE * (n % 5));
                Even sky = {.radiance = 1.0f};
                AmbientSourceCalls calls = even_calls(&sky);
                float e[3];
                calls.baked = baked;
                albedo_in_color(&lobe, o, greys, 1e-4, e);
                SeenStack m = tabled(lobe, o, &albedo);
                m.stack.nap = nap_of(lobe.params[weft_lobe_param_find(id, "tilt")], dir(1.0f, 0.0f, 0.0f));
                m.stack.sheen.f0 = rgb(greys[0], greys[1], greys[2]);
                seen_prepare(&m, o);
                for (int kept = 0; kept < 2; kept++) {
                    const AmbientTable of = kept ? ambient_table(&table, AMBIENT_FITTED) : t;
                    Rgb got = ambient_of(m, all_tables(of), &calls, 1.0f);
                    float off = max(max(abs(got.r / e[0] - 1.0f), abs(got.g / e[1] - 1.0f)), abs(got.b / e[2] - 1.0f));
                    if (!(off < 0.04f))
                        fail_msg("%s, %s: %g, %g, %g for %g, %g, %g", case_name(&lobe, o).text,
                                 kept ? "table" : "baked", (double)got.r, (double)got.g, (double)got.b, (double)e[0],
                                 (double)e[1], (double)e[2]);
                    checked++;
                }
            }
        }
    }
    assert_true(checked > 0);
}

/* The cosine-weighted mean of what is seen is the occlusion, and more is never seen less of. */
static void occlusion_of_lights_has_the_stated_mean(void **state) {
    (void)state;
    for (int k = 0; k <= 20; k++) {
        enum { STEPS = 20000 };
        float occlusion = (float)k / 20.0f, before = 0.0f;
        double mean = 0.0;
        for (int n = 0; n < STEPS; n++) {
            float x = ((float)n + 0.5f) / STEPS, seen = occlusion_cone(occlusion, sqrt(x));
            assert_true(seen >= before - 1e-6f && seen <= 1.0f);
            before = seen;
            mean += (double)seen / STEPS;
        }
        assert_float_equal((float)mean, occlusion, 2e-4);
    }
}

/* The integral of a stack over the hemisphere: in even light, what ambient light must be. */
static Rgb whole(const SeenStack *m, Dir o) {
    enum { RINGS = 96, TURNS = 128 };
    double sum[3] = {0.0};
    for (int k = 0; k < RINGS * TURNS; k++) {
        double u = (k / TURNS + 0.5) / RINGS, theta = 1.57079632679 * u;
        Dir i = direction(theta, 6.28318530718 * (k % TURNS + 0.5) / TURNS);
        double solid = (sin)(theta)*1.57079632679 / RINGS * 6.28318530718 / TURNS;
        Rgb f = seen_eval(m, i, 0).f_cos;
        sum[0] += solid * (double)f.r, sum[1] += solid * (double)f.g, sum[2] += solid * (double)f.b;
    }
    return rgb((float)sum[0], (float)sum[1], (float)sum[2]);
}

static void layer_rules_dim_the_base_under_an_environment(void **state) {
    (void)state;
    static AmbientFit diffuse, specular, sheen;
    static AlbedoTable albedo;
    Even even = {.radiance = 1.0f};
    AmbientSourceCalls calls = even_calls(&even);
    Lobe velvet = lobe_default(LOBE_CHARLIE_CONTY_KULLA);
    albedo_table_fill(&albedo, &velvet, 0.1f, 1.0f, 0);
    fit(&diffuse, LOBE_LAMBERT);
    fit(&specular, LOBE_GGX);
    fit(&sheen, LOBE_CHARLIE_CONTY_KULLA);
    AmbientTables tables = {ambient_table(&diffuse, AMBIENT_FITTED), ambient_table(&specular, AMBIENT_FITTED),
                            ambient_table(&sheen, AMBIENT_FITTED), ambient_table(&specular, AMBIENT_FITTED),
                            ambient_table(&diffuse, AMBIENT_FITTED)};
    for (int layer = 0; layer < LAYER_COUNT; layer++)
        for (int k = 0; k < 6; k++) {
            Surface s = {.base_color = {0.7f, 0.4f, 0.1f}, .roughness = 0.6f, .specular = 1.0f, .sheen = 1.0f};
            Choices c = choices_unmade();
            s.sheen_color = rgb(0.4f, 0.6f, 0.8f);
            s.sheen_roughness = k % 2 ? 0.8f : 0.5f;
            s.specular_color = rgb_grey(1.0f);
            s.reflectance = 0.46f;
            s.nap_direction = s.anisotropy_direction = dir(1.0f, 0.0f, 0.0f);
            c.layer = layer;
            SeenStack m;
            Dir o = direction_cos(0.2 + 0.35 * (double)(k / 2), 0.3);
            seen_make(&m, &s, &c, albedo_table_ref(&albedo), o);
            Rgb truth = whole(&m, o), got = stack_ambient(&m.stack, &m.view, tables, &calls, 1.0f, 1.0f);
            if (layer == LAYER_STOCHASTIC) continue; /* its bounces are the path tracer's */
            float off = abs(got.r - truth.r) + abs(got.g - truth.g) + abs(got.b - truth.b);
            float all = truth.r + truth.g + truth.b;
            /* rules min and max meet E(wi), half E(h), seed and side-by-side the interface, on average alone */
            const Stack *made = &m.stack;
            bool averaged = layer == LAYER_ALBEDO_MIN || layer == LAYER_ALBEDO_MAX || IS_BELOW_F(made);
            float most = layer == LAYER_ALBEDO_HALF ? 0.1f : averaged ? 0.06f : 0.03f;
            if (!(off < most * all))
                fail_msg("layer %d, cosine %g: %.2f %%", layer, (double)o.z, (double)(100.0f * off / all));
        }
}

/* Sums over the texels of a small sharp map. */
enum { WIDTH = 48, HEIGHT = 24 };
typedef struct Sharp {
    AmbientParts parts;
    WeftImage image;
    Vec3 x, y, z; /* the frame that is asked in */
} Sharp;

static Rgb sharp_mean(const WeftImage *image, Vec3 d, float kappa) {
    double sum[3] = {0.0}, all = 0.0;
    const float *p = image->pixels;
    for (int k = 0; k < image->width * image->height; k++) {
        double v = (k / image->width + 0.5) / image->height;
        Vec3 i = latlong_direction((k % image->width + 0.5) / image->width, v);
        float mu = vec3_dot(d, i);
        double w = (sin)(v * PI_DOUBLE) * (double)(kappa > 0.0f ? exp(kappa * (mu - 1.0f)) : max(mu, 0.0f));
        all += w;
        for (int c = 0; c < 3; c++) sum[c] += w * (double)p[3 * k + c];
    }
    return rgb((float)(sum[0] / all), (float)(sum[1] / all), (float)(sum[2] / all));
}
static Vec3 sharp_world(const Sharp *s, Dir w) {
    return vec3_madd(vec3_madd(vec3_scale(s->x, w.x), s->y, w.y), s->z, w.z);
}
static Dir sharp_local(const Sharp *s, Vec3 w) { return dir(vec3_dot(w, s->x), vec3_dot(w, s->y), vec3_dot(w, s->z)); }
static Rgb sharp_radiance(const void *user, Dir w, float kappa) {
    const Sharp *s = user;
    return sharp_mean(&s->image, sharp_world(s, w), kappa);
}
static Rgb sharp_irradiance(const void *user, Dir w) { return sharp_radiance(user, w, 0.0f); }
static Rgb sharp_residual(const void *user, Dir w, float kappa) {
    const Sharp *s = user;
    float c[3];
    ambient_rest_about(&s->parts, sharp_world(s, w), kappa, c);
    return rgb(c[0], c[1], c[2]);
}
static AmbientLight sharp_light(const void *user, int k) {
    const Sharp *s = user;
    const EnvLight *light = &s->parts.env_lights[k];
    return (AmbientLight){sharp_local(s, light->direction), rgb(light->color[0], light->color[1], light->color[2]),
                          env_light_density(light), k};
}
static AmbientLight sharp_point(const void *user, int k) {
    const Sharp *s = user;
    const EnvPoint *point = &s->parts.points[k];
    AmbientLight l = sharp_light(user, point->light);
    l.w = sharp_local(s, point->direction);
    l.color = rgb(point->color[0], point->color[1], point->color[2]);
    return l;
}

/* A grey room with two windows and a warm light. */
static void make_sharp(Sharp *s) {
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, &s->image, NULL), WEFT_OK);
    float *p = s->image.pixels;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++, p += 3) {
            float room = 0.1f + 0.1f * (float)(x % 7 < 3) + 0.01f * (float)y;
            bool window = (x > 8 && x < 12 && y > 5 && y < 9) || (x > 30 && x < 33 && y > 8 && y < 12);
            bool light = x == 20 && y == 4;
            p[0] = room + (window ? 5.0f : light ? 40.0f : 0.0f);
            p[1] = room + (window ? 6.0f : light ? 25.0f : 0.0f);
            p[2] = room + (window ? 8.0f : light ? 10.0f : 0.0f);
        }
    Environment e = {.kind = ENVIRONMENT_IMAGE, .image = s->image, .strength = 1.0f};
    assert_int_equal(ambient_split(&e, AMBIENT_LIGHTS, &s->parts, NULL), WEFT_OK);
}

/* Over a sphere, of three roughnesses: the reference sums f over the texels, each in 4 by 4 parts. */
static double sphere_error(Sharp *s, const AmbientFit *table, int strategy, float rough, float step) {
    AmbientSourceCalls calls = {
        sharp_radiance,           sharp_irradiance,         sharp_residual, sharp_light, s,
        s->parts.env_light_count, s->parts.env_light_kappa, NULL,           sharp_point, s->parts.point_count};
    double off = 0.0, all = 0.0;
    for (int n = 0; n < 24; n++) {
        float z = 0.15f + 0.033f * (float)n, side = sqrt(1.0f - z * z), turn = 2.4f * (float)n;
        Vec3 eye = {0.0f, 0.0f, 1.0f};
        s->z = vec3(side * cos(turn), side * sin(turn), z);
        s->x = vec3_normal_or(vec3_madd(eye, s->z, -z), eye);
        s->y = vec3_cross(s->z, s->x);
        Lobe lobe = lobe_rough(table->lobe.id, rough + step * (float)(n % 3));
        Dir o = sharp_local(s, eye);
        double truth[3] = {0.0};
        for (int k = 0; k < 16 * WIDTH * HEIGHT; k++) {
            double v = (k / (4 * WIDTH) + 0.5) / (4 * HEIGHT);
            Dir i = sharp_local(s, latlong_direction((k % (4 * WIDTH) + 0.5) / (4 * WIDTH), v));
            if (!(i.z > 0.0f)) continue;
            const float *p = (const float *)s->image.pixels + 3 * (k / (16 * WIDTH) * WIDTH + k % (4 * WIDTH) / 4);
            double w = (double)(lobe_eval(&lobe, angles_between(o, i)) * i.z) * (sin)(v * PI_DOUBLE);
            for (int c = 0; c < 3; c++) truth[c] += w * (double)p[c];
        }
        Rgb got = ambient_of(one_lobe(lobe, o), all_tables(ambient_table(table, strategy)), &calls, 1.0f);
        const float values[3] = {got.r, got.g, got.b};
        for (int c = 0; c < 3; c++) {
            truth[c] *= 2.0 * PI_DOUBLE * PI_DOUBLE / (16.0 * WIDTH * HEIGHT);
            off += (double)z * fabs((double)values[c] - truth[c]);
            all += (double)z * truth[c];
        }
    }
    return off / all;
}

/* Whatever does not go to lights is the residual's. */
static void light_of_the_map_is_in_lights_or_residual(void **state) {
    (void)state;
    static const int env_lights[] = {0, 1, 2, AMBIENT_LIGHTS, AMBIENT_LIGHTS_MAX};
    Sharp s = {0};
    make_sharp(&s);
    Environment e = {.kind = ENVIRONMENT_IMAGE, .image = s.image, .strength = 1.0f};
    for (size_t k = 0; k < sizeof env_lights / sizeof env_lights[0]; k++) {
        AmbientParts parts;
        assert_int_equal(ambient_split(&e, env_lights[k], &parts, NULL), WEFT_OK);
        assert_true(parts.env_light_count <= env_lights[k] && (env_lights[k] < 2) == !parts.env_light_count);
        for (int c = 0; c < 3; c++) {
            double sum = 4.0 * PI_DOUBLE * (double)parts.residual_sh[0][c];
            for (int n = 0; n < parts.env_light_count; n++) sum += (double)parts.env_lights[n].color[c];
            assert_float_equal((float)sum, 4.0f * PI_FLOAT * parts.terms[0][c], 1e-4f * (float)sum);
            for (int n = 0; n < parts.point_count; n++) sum -= (double)parts.points[n].color[c];
            assert_float_equal((float)sum, 4.0f * PI_FLOAT * parts.residual_sh[0][c], 1e-4f * (float)sum);
        }
    }
    weft_image_free(&s.image);
}

/* A stretched highlight passes through a part of a light only. */
static void streaks_show_the_shape_of_a_light(void **state) {
    (void)state;
    static AmbientFit table;
    Sharp s = {0};
    make_sharp(&s);
    Lobe lobe = lobe_rough(LOBE_SILK, 0.3f);
    ambient_fit(&table, &lobe, lobe.params[0], lobe.params[0], 0);
    double off = sphere_error(&s, &table, AMBIENT_SAMPLED, 0.3f, 0.0f);
    print_message("%.1f %%\n", 100.0 * off);
    assert_true(off < 0.05);
    weft_image_free(&s.image);
}

/* A lobe of terms is sampled in strips where it is stretched, as workflow disney has it brushed, and else is round. */
static void stretched_terms_are_sampled(void **state) {
    (void)state;
    static AmbientFit table;
    Lobe lobe = lobe_rough(LOBE_COOK_TORRANCE, 0.3f);
    ambient_fit(&table, &lobe, lobe.params[0], lobe.params[0], 0);
    assert_false(table.by_azimuth);
    assert_int_equal(ambient_strategy(lobe.id, table.by_azimuth, false), AMBIENT_FITTED);
    lobe.params[COOK_TORRANCE_STRETCH] = 5.0f;
    lobe.params[COOK_TORRANCE_D] = to_float(D_GGX_ANISO);
    ambient_fit(&table, &lobe, lobe.params[0], lobe.params[0], 0);
    assert_true(table.by_azimuth);
    assert_int_equal(ambient_strategy(lobe.id, table.by_azimuth, false), AMBIENT_SAMPLED);
}

static void sharp_environment_is_within_the_stated_error(void **state) {
    (void)state;
    static const int lobes[] = {
        LOBE_LAMBERT,         LOBE_FABRIC_LAMBERT, LOBE_BURLEY_SHEEN, LOBE_CHARLIE_NEUBELT, LOBE_CHARLIE_KHRONOS,
        LOBE_EXPONENTIAL_LIT, LOBE_PATRY,          LOBE_LTC_FIBRE,    LOBE_THREADS,         LOBE_FIBRE};
    static AmbientFit table;
    Sharp s = {0};
    make_sharp(&s);
    assert_true(s.parts.env_light_count > 2 && s.parts.env_light_count <= AMBIENT_LIGHTS);
    for (size_t k = 0; k < sizeof lobes / sizeof lobes[0]; k++) {
        if (test_short() && k % 8) continue;
        fit(&table, lobes[k]);
        double fitted = sphere_error(&s, &table, AMBIENT_FITTED, 0.4f, 0.3f),
               plain = sphere_error(&s, &table, AMBIENT_IRRADIANCE, 0.4f, 0.3f);
        if (!(fitted < 0.05)) fail_msg("%s: %.1f %%", weft_lobe_info(lobes[k])->id, 100.0 * fitted);
        /* what a matt surface gets is already right */
        if (k > 1) assert_true(fitted < plain);
    }
    weft_image_free(&s.image);
}

/* A lobe that is a ring is known by its density, and then its samples are nearer than one axis is. */
static void ring_shaped_lobes_are_nearer_with_samples(void **state) {
    (void)state;
    static const int rings[] = {LOBE_FIBRE, LOBE_LTC_FIBRE, LOBE_LTC_FIBRE_PUBLISHED, LOBE_FIBRE_TABLE};
    static AmbientFit table;
    Sharp s = {0};
    make_sharp(&s);
    for (int id = 0; id < LOBE_COUNT; id++) {
        if (!asked(id)) continue;
        bool ring = false;
        for (size_t k = 0; k < sizeof rings / sizeof rings[0]; k++) ring |= rings[k] == id;
        fit_one(&table, id, 0.35f);
        if (ring != (table.denser > AMBIENT_DENSER))
            fail_msg("%s: denser by 2^%g", weft_lobe_info(id)->id, (double)table.denser);
    }
    for (size_t k = 0; k < sizeof rings / sizeof rings[0]; k++) {
        fit_one(&table, rings[k], 0.35f);
        double sampled = sphere_error(&s, &table, AMBIENT_SAMPLED, 0.35f, 0.0f),
               fitted = sphere_error(&s, &table, AMBIENT_FITTED, 0.35f, 0.0f);
        print_message("%s: sampled %.1f %%, fitted %.1f %%\n", weft_lobe_info(rings[k])->id, 100.0 * sampled,
                      100.0 * fitted);
        assert_true(sampled < 0.8 * fitted);
        assert_int_equal(ambient_strategy(rings[k], false, true), AMBIENT_SAMPLED);
    }
    weft_image_free(&s.image);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(even_environment_returns_the_albedo),
                                       cmocka_unit_test(table_of_an_uneven_lobe_has_the_mean_of_both_sides),
                                       cmocka_unit_test(baked_weights_return_the_albedo),
                                       cmocka_unit_test(environment_lights_are_shaded_as_lights),
                                       cmocka_unit_test(tinted_lobes_have_the_tint_of_a_direction),
                                       cmocka_unit_test(leaning_lobes_have_the_tint_of_their_heading),
                                       cmocka_unit_test(occlusion_of_lights_has_the_stated_mean),
                                       cmocka_unit_test(layer_rules_dim_the_base_under_an_environment),
                                       cmocka_unit_test(light_of_the_map_is_in_lights_or_residual),
                                       cmocka_unit_test(baked_weights_of_a_fading_lobe_are_not_negative),
                                       cmocka_unit_test(streaks_show_the_shape_of_a_light),
                                       cmocka_unit_test(stretched_terms_are_sampled),
                                       cmocka_unit_test(sharp_environment_is_within_the_stated_error),
                                       cmocka_unit_test(ring_shaped_lobes_are_nearer_with_samples),
                                       cmocka_unit_test(faint_sheens_keep_albedo_under_a_white_sky)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
