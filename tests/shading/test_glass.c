/* Thin glass: that it sends on all light, alike both ways, never more; what facets lose of it; and that of engines */
#include "cases.h"

enum { PAIRS = 4000 };

static Dir mirrored(Dir i) { return dir(i.x, i.y, -i.z); }

/* White glass of ior 1.5 without a sheen. */
static Surface pane(float roughness) {
    Surface s = white_cloth(0.5f);
    s.sheen_color = rgb_grey(0.0f);
    s.specular_color = rgb_grey(1.0f);
    s.attenuation_color = rgb_grey(1.0f);
    s.anisotropy_direction = dir(1.0f, 0.0f, 0.0f);
    s.specular = 1.0f;
    s.ior = 1.5f;
    s.transmission = 1.0f;
    s.roughness = roughness;
    s.fuzz_color = rgb_grey(1.0f);
    s.coat_color = rgb_grey(1.0f);
    s.coat_ior = 1.5f;
    return s;
}

static SeenStack seen_through(const Surface *s, TableRef e, int layer, Dir o) {
    Choices choices = choices_unmade();
    SeenStack seen;
    choices.layer = layer;
    if (s->fuzz > 0.0f) choices.rim = RIM_FUZZ;
    seen_make(&seen, s, &choices, e, o);
    return seen;
}

/* R and T in green: midpoint sums on the grid of cases.h. */
static void sums(const SeenStack *seen, Dir o, int cells, double side[2]) {
    const Grid grid = grid_about(o);
    const double step = 2.0 / cells;
    side[0] = side[1] = 0.0;
    for (int j = 0; j < cells; j++)
        for (int k = 0; k < cells; k++) {
            double area;
            const Dir i = grid_direction(grid, -1.0 + step * (j + 0.5), -1.0 + step * (k + 0.5), &area);
            side[0] += (double)seen_eval(seen, i, 1).f_cos.g * area * step * step;
            side[1] += (double)seen_eval(seen, mirrored(i), 1).f_cos.g * area * step * step;
        }
}

static const TableRef no_table = {.kind = TABLE_NONE};

/* E of the highlight alone, and the fit of what it lacks to 1. */
static void lost_light_is_what_the_integral_lacks(void **state) {
    (void)state;
    double worst = 0.0, grazing = 0.0, mean = 0.0;
    for (int a = 0; a < 12; a++)
        for (int c = 0; c < 12; c++) {
            const float alpha = a ? (float)a / 11.0f : 0.02f, cosine = c ? (float)c / 11.0f : 0.02f;
            WeftLobe ggx;
            float e[3];
            assert_int_equal(weft_lobe_init("ggx", &ggx, NULL), WEFT_OK);
            ggx.params[GGX_ALPHA] = alpha;
            for (int k = 0; k < 3; k++) ggx.f0[k] = ggx.f90[k] = 1.0f;
            weft_lobe_albedo(&ggx, cosine, e);
            double *of = cosine < 0.04f ? &grazing : &worst;
            *of = fmax(*of, fabs(1.0 - (double)e[0] - (double)ggx_lost(alpha, cosine)));
        }
    for (int a = 1; a <= 20; a++) {
        enum { STEPS = 4000 };
        const float alpha = 0.05f * (float)a;
        double sum = 0.0;
        for (int k = 0; k < STEPS; k++) {
            const double cosine = (k + 0.5) / STEPS;
            sum += 2.0 * (double)ggx_lost(alpha, (float)cosine) * cosine / STEPS;
        }
        mean = fmax(mean, fabs((double)ggx_lost_average(alpha) / sum - 1.0));
    }
    print_message("L within %.1e, grazing %.1e; its mean within %.1e of itself\n", worst, grazing, mean);
    assert_true(worst < 8e-4 && grazing < 1.6e-3 && mean < 2e-3);
}

static void white_glass_sends_on_all_light(void **state) {
    (void)state;
    static const float roughnesses[] = {0.15f, 0.3f, 0.45f, 0.6f, 0.8f, 1.0f};
    double worst = 0.0;
    for (int n = 0; n < 24; n++) {
        Surface s = pane(roughnesses[n % 6]);
        s.ior = n % 4 == 3 ? 2.2f : 1.5f;
        const Dir o = direction_cos(0.12 + 0.035 * n, 0.3);
        const SeenStack seen = seen_through(&s, no_table, CHOICE_AUTO, o);
        double side[2];
        sums(&seen, o, 300, side);
        assert_true(side[1] > 0.3);
        worst = fmax(worst, fabs(side[0] + side[1] - 1.0));
    }
    print_message("R + T of glass is 1 within %.1e\n", worst);
    assert_true(worst < 1e-3);
}

/* Fuzz lies over the glass, and takes from both of its sides what it reflects itself. */
static void glass_under_white_fuzz_sends_on_all_light(void **state) {
    (void)state;
    static AlbedoTable table;
    double worst = 0.0;
    const Lobe fibres = lobe_default(LOBE_LTC_FIBRE);
    albedo_table_fill(&table, &fibres, 0.05f, 1.0f, 0);
    for (int n = 0; n < 24; n++) {
        Surface s = pane(0.15f + 0.17f * (float)(n % 6));
        s.fuzz = 0.25f + 0.25f * (float)(n % 4);
        s.fuzz_roughness = 0.2f + 0.2f * (float)(n % 5);
        const Dir o = direction_cos(0.12 + 0.035 * n, 0.3);
        const SeenStack seen = seen_through(&s, albedo_table_ref(&table), CHOICE_AUTO, o);
        double side[2];
        assert_true(seen.stack.sheen.normal > 0.0f && seen.view.e_o.e > 0.0f);
        sums(&seen, o, 300, side);
        worst = fmax(worst, fabs(side[0] + side[1] - 1.0));
    }
    print_message("R + T of glass under fuzz is 1 within %.1e\n", worst);
    assert_true(worst < 1e-3);
}

/* Neither share, metal, tint, ior, roughness, stretch, coat nor light through cloth beside it makes light. Each second
 * surface is white, with every pair of metalness and transmission and, of each, a range of light through cloth. */
static void no_glass_gains_light(void **state) {
    (void)state;
    Random random = {21};
    double most = 0.0;
    for (int n = 0; n < 72; n++) {
        Surface s = random_surface(&random, false);
        const bool white = n % 2 == 0;
        const int pair = n / 2 % 12;
        s.sheen_color = rgb_grey(0.0f);
        s.transmission = white ? 0.5f + 0.25f * (float)(pair / 4) : random_unit(&random);
        if (white) {
            s.metallic = 0.25f * (float)(pair % 4);
            s.base_color = s.specular_color = rgb_grey(1.0f);
        }
        s.attenuation_color = rgb_grey(1.0f);
        s.roughness = weft_mix(n % 2 ? 0.15f : 0.4f, 1.0f, s.roughness);
        if (s.roughness < 0.4f) s.anisotropy = 0.0f;
        s.clearcoat_roughness = weft_mix(0.3f, 1.0f, s.clearcoat_roughness);
        s.diffuse_transmission = white ? 0.5f * (float)(n / 24) : random_unit(&random);
        s.diffuse_transmission_color = s.base_color;
        const Dir o = direction_cos(0.1 + 0.0125 * n, 0.4);
        const SeenStack seen = seen_through(&s, no_table, CHOICE_AUTO, o);
        double side[2];
        sums(&seen, o, 200, side);
        most = fmax(most, side[0] + side[1]);
    }
    print_message("R + T is at most %.4f\n", most);
    assert_true(most < 1.0 + 1.5e-3);
}

/* A white pane that is half metal reflects and sends on the mean of a metal and a pane, as glTF mixes them. */
static void half_metal_is_the_mean_of_metal_and_glass(void **state) {
    (void)state;
    for (int n = 0; n < 4; n++) {
        const Dir o = direction_cos(0.3 + 0.2 * n, 0.3);
        double mean[2] = {0.0}, side[2];
        for (int metallic = 0; metallic < 3; metallic++) {
            Surface s = pane(0.4f + 0.1f * (float)n);
            s.metallic = metallic < 2 ? (float)metallic : 0.5f;
            const SeenStack seen = seen_through(&s, no_table, CHOICE_AUTO, o);
            sums(&seen, o, 300, side);
            for (int k = 0; k < 2 && metallic < 2; k++) mean[k] += 0.5 * side[k];
        }
        for (int k = 0; k < 2; k++)
            if (fabs(side[k] - mean[k]) > 1e-4) fail_msg("pane %d, side %d: %g is not %g", n, k, side[k], mean[k]);
    }
}

/* What facets that are stretched lose stays lost in part: it is that of their smaller alpha which is given back. */
static void stretched_glass_loses_light(void **state) {
    (void)state;
    static const float stretches[] = {0.0f, 0.3f, 0.6f, 0.9f};
    double least[4], most = 0.0;
    for (int k = 0; k < 4; k++) {
        least[k] = 2.0;
        for (int n = 0; n < 16; n++) {
            Surface s = pane(0.3f);
            s.anisotropy = stretches[k];
            const Dir o = direction_cos(0.25 + 0.25 * (n % 4), 0.5 * (n / 4));
            const SeenStack seen = seen_through(&s, no_table, CHOICE_AUTO, o);
            double side[2];
            sums(&seen, o, 300, side);
            least[k] = fmin(least[k], side[0] + side[1]);
            most = fmax(most, side[0] + side[1]);
        }
    }
    print_message("R + T at roughness 0.3 is at least %.3f, %.3f, %.3f, %.3f at anisotropy 0, .3, .6, .9\n", least[0],
                  least[1], least[2], least[3]);
    assert_true(most < 1.0 + 1e-3 && least[0] > 0.999 && least[1] > 0.95 && least[3] > 0.5);
}

static void glass_is_the_same_both_ways(void **state) {
    (void)state;
    static const int layers[] = {LAYER_ADDITIVE, LAYER_SEED, LAYER_SIDE_BY_SIDE};
    Random random = {22};
    double worst = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        Surface s = random_surface(&random, false);
        s.transmission = random_unit(&random);
        s.clearcoat = 0.0f; /* which dims by wo alone */
        const Dir o = random_direction(&random), i = random_direction(&random);
        const SeenStack front = seen_through(&s, no_table, layers[n % 3], o),
                        back = seen_through(&s, no_table, layers[n % 3], i);
        const double a = (double)(seen_eval(&front, mirrored(i), 1).f_cos.g / i.z),
                     b = (double)(seen_eval(&back, mirrored(o), 1).f_cos.g / o.z);
        worst = fmax(worst, fabs(a - b) / fmax(fmax(a, b), 1e-3));
    }
    print_message("f through glass is reciprocal within %.1e\n", worst);
    assert_true(worst < 1e-4);
}

/* --- glass of engines --- */

/* The profiles that draw glass beside those of glTF. */
static const char *const engines[] = {"three", "babylon", "filament-sheen", "openpbr", "babylon-openpbr"};
enum { ENGINES = sizeof engines / sizeof *engines };

static SeenStack seen_as(const char *profile, const Surface *s, Dir o) {
    Choices choices = choices_unmade();
    SeenStack seen;
    choices.profile = 0;
    while (strcmp(weft_profile_name(choices.profile), profile) != 0) choices.profile++;
    seen_make(&seen, s, &choices, no_table, o);
    return seen;
}

/* A pane in a colour under an even light, in green: of transmission t an engine mixes t base_color (1 - E) with what the
 * diffuse lobe was, E being the split sum F0 A + F90 B of its highlight. Babylon.js has 1 - F0 besides. */
static void engines_let_through_what_their_sources_say(void **state) {
    (void)state;
    for (int e = 0; e < ENGINES; e++) {
        const bool babylon = e == 1;
        double worst = 0.0, front = 0.0;
        for (int n = 0; n < 18; n++) {
            Surface s = pane(0.2f + 0.15f * (float)(n % 6));
            s.sheen = 0.0f; /* fuzz takes from the base even where it is black */
            s.base_color = rgb(0.9f, 0.7f, 0.2f);
            s.transmission = n % 3 ? 0.4f : 1.0f;
            s.ior = n % 4 == 3 ? 2.0f : 1.5f;
            const Dir o = direction_cos(n ? 0.2 + 0.045 * n : 1.0, 0.3);
            const SeenStack seen = seen_as(engines[e], &s, o);
            const Lobe white = lobe_rough(LOBE_GGX, s.roughness);
            const Albedo a = albedo_quadrature(&white, o, 1e-5);
            const double root = ((double)s.ior - 1.0) / ((double)s.ior + 1.0), f0 = root * root;
            const double through = 1.0 - f0 * (double)a.f0 - (double)a.f90,
                         wanted =
                             (double)s.transmission * (double)s.base_color.g * through * (babylon ? 1.0 - f0 : 1.0);
            double side[2];
            sums(&seen, o, 200, side);
            if (n == 0) front = side[1] / ((double)s.transmission * (double)s.base_color.g);
            worst = fmax(worst, fabs(side[1] / wanted - 1.0));
        }
        print_message("%-15s through glass within %.1e of the split sum; %.3f of white at the front\n", engines[e],
                      worst, front);
        assert_true(worst < 6e-3);
    }
}

/* White panes of engines send on all light; those that scale their highlight for what its facets lose, a little more. */
static void glass_of_engines_makes_hardly_any_light(void **state) {
    (void)state;
    for (int e = 0; e < ENGINES; e++) {
        const bool scaled = e < 3, babylon = e == 1;
        double least = 2.0, most = 0.0;
        for (int n = 0; n < 18; n++) {
            Surface s = pane(0.2f + 0.15f * (float)(n % 6));
            s.sheen = 0.0f;
            const Dir o = direction_cos(0.12 + 0.05 * n, 0.3);
            const SeenStack seen = seen_as(engines[e], &s, o);
            double side[2];
            sums(&seen, o, 200, side);
            least = fmin(least, side[0] + side[1]);
            most = fmax(most, side[0] + side[1]);
        }
        print_message("%-15s R + T of white glass is %.4f to %.4f\n", engines[e], least, most);
        assert_true(least > (babylon ? 0.95 : 0.999) && most < (scaled ? 1.0 + 3e-3 : 1.0 + 1e-3));
    }
}

/* Without fuzz, a coat or what an engine does for one direction alone, both ways are alike. */
static void glass_of_engines_is_the_same_both_ways(void **state) {
    (void)state;
    Random random = {24};
    double worst = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        Surface s = random_surface(&random, false);
        s.transmission = random_unit(&random);
        s.clearcoat = 0.0f;
        s.sheen = 0.0f;
        const Dir o = random_direction(&random), i = random_direction(&random);
        const SeenStack front = seen_as(engines[n % ENGINES], &s, o), back = seen_as(engines[n % ENGINES], &s, i);
        const double a = (double)(seen_eval(&front, mirrored(i), 1).f_cos.g / i.z),
                     b = (double)(seen_eval(&back, mirrored(o), 1).f_cos.g / o.z);
        worst = fmax(worst, fabs(a - b) / fmax(fmax(a, b), 1e-3));
    }
    print_message("f through glass of engines is reciprocal within %.1e\n", worst);
    assert_true(worst < 1e-4);
}

/* What samples of either side find, against the grid; and the pdf of all is 1 but for what is drawn below a horizon. */
static void samples_find_the_light_through_glass(void **state) {
    (void)state;
    enum { SAMPLES = 200000 };
    Random random = {23};
    for (int n = 0; n < 8 + ENGINES; n++) {
        Surface s = pane(0.3f + 0.1f * (float)(n % 8));
        s.transmission = n % 2 ? 1.0f : 0.5f;
        s.base_color = n == 6 ? rgb(0.9f, 0.5f, 0.3f) : rgb_grey(1.0f);
        s.diffuse_transmission = n % 4 == 2 ? 0.5f : 0.0f;
        s.diffuse_transmission_color = rgb_grey(1.0f);
        const Dir o = direction_cos(0.2 + 0.1 * (n % 8), 1.0);
        const SeenStack seen = n < 8 ? seen_through(&s, no_table, CHOICE_AUTO, o) : seen_as(engines[n - 8], &s, o);
        double drawn[2] = {0.0}, square[2] = {0.0}, side[2];
        for (int k = 0; k < SAMPLES; k++) {
            const Dir i = seen_sample(&seen, random_unit(&random), random_unit(&random));
            const StackValue v = seen_eval(&seen, i, 1);
            const double x = v.pdf > 0.0f ? (double)(v.f_cos.g / v.pdf) : 0.0;
            drawn[i.z < 0.0f] += x / SAMPLES;
            square[i.z < 0.0f] += x * x / SAMPLES;
        }
        sums(&seen, o, 300, side);
        for (int k = 0; k < 2; k++) {
            const double error = (sqrt)(fmax(square[k] - drawn[k] * drawn[k], 0.0) / SAMPLES) + 2e-4;
            if (!(fabs(drawn[k] - side[k]) < 5.0 * error))
                fail_msg("pane %d, side %d: %.5f drawn, %.5f in all", n, k, drawn[k], side[k]);
        }
    }
}

/* A pane in a colour, and one so thick that half of its light is absorbed. */
static void colour_and_thickness_take_what_they_say(void **state) {
    (void)state;
    Surface s = pane(0.5f), t = s;
    const Dir o = direction_cos(0.8, 0.0), i = mirrored(dir_opposite(o));
    const SeenStack clear = seen_through(&s, no_table, CHOICE_AUTO, o);
    t.base_color = rgb(0.5f, 1.0f, 0.25f);
    t.thickness = 0.3f;
    t.attenuation_distance = 0.1f;
    t.attenuation_color = rgb_grey(0.7937005f); /* cubed it is a half */
    const SeenStack tinted = seen_through(&t, no_table, CHOICE_AUTO, o);
    const Rgb a = seen_eval(&clear, i, 1).f_cos, b = seen_eval(&tinted, i, 1).f_cos;
    assert_float_equal(b.r / a.r, 0.25f, 1e-4f);
    assert_float_equal(b.g / a.g, 0.5f, 1e-4f);
    assert_float_equal(b.b / a.b, 0.125f, 1e-4f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lost_light_is_what_the_integral_lacks),
        cmocka_unit_test(white_glass_sends_on_all_light),
        cmocka_unit_test(glass_under_white_fuzz_sends_on_all_light),
        cmocka_unit_test(no_glass_gains_light),
        cmocka_unit_test(half_metal_is_the_mean_of_metal_and_glass),
        cmocka_unit_test(stretched_glass_loses_light),
        cmocka_unit_test(glass_is_the_same_both_ways),
        cmocka_unit_test(engines_let_through_what_their_sources_say),
        cmocka_unit_test(glass_of_engines_makes_hardly_any_light),
        cmocka_unit_test(glass_of_engines_is_the_same_both_ways),
        cmocka_unit_test(samples_find_the_light_through_glass),
        cmocka_unit_test(colour_and_thickness_take_what_they_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
