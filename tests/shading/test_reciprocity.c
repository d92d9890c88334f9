/* Symmetries that the lobes claim: reciprocal, isotropic, anisotropic */
#include "cases.h"

enum { PAIRS = 100000 };

static bool close_to(float a, float b) { return fabsf(a - b) <= 1e-5f * fmaxf(fabsf(a), fabsf(b)) + 1e-30f; }

static Dir turned(Dir w, double angle) {
    float c = (float)(cos)(angle), s = (float)(sin)(angle);
    return dir(c * w.x - s * w.y, s * w.x + c * w.y, w.z);
}

static void lobes_are_reciprocal_as_their_traits_claim(void **state) {
    (void)state;
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (!(weft_lobe_info(id)->traits & TRAIT_RECIPROCAL)) continue;
        Random random = {2};
        for (int n = 0; n < PAIRS; n++) {
            Lobe lobe = case_lobe(id, n % case_count(id));
            int shadow = weft_lobe_param_find(id, "v"); /* the help of a term says where it is not */
            if (shadow >= 0 && strstr(weft_term_help(WEFT_TERM_V, (int)lobe.params[shadow]), "not reciprocal"))
                continue;
            Dir o = random_direction(&random), i = random_direction(&random);
            LobeValue v = lobe_value(&lobe, angles_between(o, i)), w = lobe_value(&lobe, angles_between(i, o));
            float f = v.f, g = w.f;
            if (n % 2) /* in a colour */
                f *= lobe_color(v, 0.4f, lobe_second(&lobe, 0.4f, 0.9f)),
                    g *= lobe_color(w, 0.4f, lobe_second(&lobe, 0.4f, 0.9f));
            if (!close_to(f, g))
                fail_msg("%s: f(o, i) = %.9g, f(i, o) = %.9g", case_name(&lobe, o).text, (double)f, (double)g);
        }
    }
}

/* Turning rounds the directions, and a lobe of alpha magnifies that by up to 1/alpha^2. */
static float turning_error(const Lobe *lobe) {
    float alpha = weft_lobe_info((int)lobe->id)->param_count ? max(min(lobe->params[0], 1.0f), 1e-3f) : 1.0f;
    return 1e-5f / (alpha * alpha);
}

static void isotropic_lobes_do_not_depend_on_azimuth(void **state) {
    (void)state;
    for (int id = 0; id < weft_lobe_count(); id++) {
        bool anisotropic = weft_lobe_info(id)->traits & TRAIT_ANISOTROPIC;
        int k = weft_lobe_param_find(id, "anisotropy");
        if (anisotropic && k < 0) continue; /* no parameter makes it round */
        assert_true(anisotropic || k < 0);
        Random random = {4};
        for (int n = 0; n < PAIRS; n++) {
            Lobe lobe = case_lobe(id, n % case_count(id));
            if (anisotropic) lobe_set(&lobe, k, 0.0f);
            if (turning_error(&lobe) > 0.1f) continue;
            double angle = 6.0 * (double)random_unit(&random);
            Dir o = random_direction(&random), i = random_direction(&random);
            float f = lobe_eval(&lobe, angles_between(o, i));
            float g = lobe_eval(&lobe, angles_between(turned(o, angle), turned(i, angle)));
            if (fabsf(f - g) > turning_error(&lobe) * max(f, g) + 1e-5f)
                fail_msg("%s: f = %.9g, turned %.9g", case_name(&lobe, o).text, (double)f, (double)g);
        }
    }
}

static void anisotropic_lobes_depend_on_azimuth(void **state) {
    (void)state;
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (!(weft_lobe_info(id)->traits & TRAIT_ANISOTROPIC) || case_walks(id)) continue;
        bool seen = false;
        for (int k = 0; k < case_count(id); k++) { /* by some of its choices */
            Lobe lobe = case_lobe(id, k);
            int how = weft_lobe_param_find(id, "anisotropy"), stretch = weft_lobe_param_find(id, "stretch"),
                tilt = weft_lobe_param_find(id, "tilt"), crimp = weft_lobe_param_find(id, "crimp");
            if (how >= 0) lobe_set(&lobe, how, 0.8f);
            if (stretch >= 0) lobe_set(&lobe, stretch, 4.0f);
            if (tilt >= 0) lobe_set(&lobe, tilt, 0.7f);
            if (crimp >= 0) lobe_set(&lobe, crimp, 0.1f); /* steep yarn draws its streak out to both directions */
            /* an eighth of a turn: a quarter may lay one yarn of threads over the other; at grazing, and in a highlight
             * across fibres, which grazing light has little of */
            for (int pair = 0; pair < 2; pair++) {
                Dir o = pair ? direction(0.86, 0.0) : direction(0.02, 0.0);
                Dir i = pair ? direction(0.3, 1.0) : direction(0.8, 0.3);
                float f = lobe_eval(&lobe, angles_between(o, i));
                float g = lobe_eval(&lobe, angles_between(turned(o, 0.8), turned(i, 0.8)));
                seen = seen || fabsf(f - g) > 0.2f * max(f, g);
            }
        }
        assert_true(seen);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_are_reciprocal_as_their_traits_claim),
        cmocka_unit_test(isotropic_lobes_do_not_depend_on_azimuth),
        cmocka_unit_test(anisotropic_lobes_depend_on_azimuth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
