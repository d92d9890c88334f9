/* area - prints how far polygon lights are off, for each lobe: one linearly transformed cosine of its own
 * alone, and stack_polygon; and what that costs
 *
 *   study_area [LOBE]
 *
 * Errors are sums of differences in hundredths of the sum, over twenty lights and points on a floor and a
 * sphere (tests/shading/lights.h); the reference is brute force. In brackets the worst light. */
#include <stdio.h>
#include <string.h>

#include "shading/catalogue/albedo.h"
#include "shading/lights.h"
#include "shading/lobe/lobe_tables.h"
#include "weft/ltc.h"

enum { LIGHTS = 20, SPOTS = 24 };

typedef struct Sums {
    double off, worst, light_off;
} Sums;

static void sums_add(Sums *sums, double difference) { sums->light_off += fabs(difference); }
static void sums_light(Sums *sums, double reference) {
    sums->off += sums->light_off;
    if (reference > 0.0 && sums->light_off > sums->worst * reference) sums->worst = sums->light_off / reference;
    sums->light_off = 0.0;
}

/* The points of a quadrature for one D. */
static int points_of(Polygon p) { return p.count * polygon_rays(p.count) * polygon_steps(p.count); }

static double alone(const WeftLtc *ltc, float value, Dir o, Polygon p) {
    WeftLtcLobe at = weft_ltc_at(ltc, o.z, value);
    Ltc m = ltc_of(at.z, at.q, at.b, at.r, o.z);
    return (double)((at.amplitude + at.amplitude_f90) * polygon_ltc(m, o, p));
}

/* ltc may be NULL. */
static void print_lobe(Lobe lobe, const WeftLtc *ltc) {
    uint64_t random = 1;
    Sums one = {0}, ours = {0};
    double all = 0.0;
    int most = 0, points = 0, seen = 0;
    for (int l = 0; l < LIGHTS; l++) {
        LightPose pose = light_pose(&random);
        double sum = 0.0;
        for (int s = 0; s < SPOTS; s++) {
            Light light = light_seen(&pose, s % 2 == 1, &random);
            Polygon p = light_polygon(light.corners, 4), above = polygon_clip(p);
            SeenStack m = light_lone(lobe, light.o);
            double reference = light_integral(light_stack, &m, light.o, light.corners, 4, 4);
            int n = points_of(above);
            sum += reference;
            sums_add(&ours, (double)light_on(&m, p).g - reference);
            if (ltc) sums_add(&one, alone(ltc, lobe.params[0], light.o, p) - reference);
            points += n;
            seen += n > 0;
            if (n > most) most = n;
        }
        sums_light(&ours, sum);
        sums_light(&one, sum);
        all += sum;
    }
    printf("%-27s %6.3g ", weft_lobe_info(lobe.id)->id, (double)lobe.params[0]);
    if (ltc)
        printf("%8.2f (%6.2f) ", 100.0 * one.off / all, 100.0 * one.worst);
    else
        printf("%8s %8s ", "-", "");
    printf("%8.3f (%6.2f)  %5.1f %4d\n", 100.0 * ours.off / all, 100.0 * ours.worst, (double)points / seen, most);
}

/* A lobe at the roughness of alphas, the least of which is for highlights. */
static void print_lobes(const char *only) {
    static const float alphas[] = {0.04f, 0.1f, 0.25f, 0.5f, 1.0f};
    printf("errors in %% (worst light)       one LTC alone       stack_polygon      evaluations\n"
           "lobe                         value                                         mean most\n");
    for (int id = 0; id < LOBE_COUNT; id++) {
        const WeftLobeInfo *info = weft_lobe_info(id);
        if (info->traits & TRAIT_REFERENCE || (only && strcmp(only, info->id) != 0)) continue;
        bool sharp = id == LOBE_GGX || id == LOBE_SILK || id == LOBE_COOK_TORRANCE || id == LOBE_BURLEY_COAT;
        WeftLobe lobe;
        WeftLtc *ltc = NULL;
        WeftError error;
        if (weft_lobe_init(info->id, &lobe, &error) == WEFT_OK &&
            weft_ltc_create(&lobe, &(WeftLtcDesc){.no_cache = 1}, &ltc, NULL, &error) != WEFT_OK)
            ltc = NULL; /* it turns with the tangent */
        for (int k = sharp ? 0 : 1; k < 5; k++) {
            print_lobe(lobe_rough(id, sqrt(alphas[k])), ltc);
            if (info->param_count == 0) break;
        }
        weft_ltc_free(ltc);
    }
}

/* A dielectric under a sheen. */
static void print_layers(void) {
    static AlbedoTable table;
    static const int rules[] = {LAYER_ADDITIVE, LAYER_SIDE_BY_SIDE, LAYER_ALBEDO_VIEW, LAYER_ALBEDO_MAX,
                                LAYER_RECIPROCAL};
    Lobe sheen = lobe_rough(LOBE_CHARLIE_NEUBELT, 0.5f);
    albedo_table_fill(&table, &sheen, 0.005f, 1.0f, 0);
    printf("\nlayer rule, errors in %%, evaluations\n");
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++) {
        Surface s = {.base_color = {0.8f, 0.8f, 0.8f}, .roughness = 0.4f, .specular = 1.0f, .ior = 1.5f};
        Choices c = choices_unmade();
        uint64_t random = 1;
        double off = 0.0, all = 0.0;
        int points = 0, seen = 0;
        s.specular_color = s.sheen_color = s.sheen_second = rgb_grey(1.0f);
        s.sheen = 1.0f;
        s.sheen_roughness = 0.5f;
        s.normal = s.clearcoat_normal = dir(0.0f, 0.0f, 1.0f);
        c.sheen_lobe = LOBE_CHARLIE_NEUBELT;
        c.layer = rules[k];
        for (int l = 0; l < LIGHTS; l++) {
            LightPose pose = light_pose(&random);
            for (int n = 0; n < SPOTS; n++) {
                Light light = light_seen(&pose, n % 2 == 1, &random);
                Polygon p = light_polygon(light.corners, 4);
                SeenStack m;
                seen_make(&m, &s, &c, albedo_table_ref(&table), light.o);
                double reference = light_integral(light_stack, &m, light.o, light.corners, 4, 3);
                off += fabs((double)light_on(&m, p).g - reference);
                all += reference;
                /* diffuse and sheen share the points of the cosine, the highlight has its own */
                points += 3 * points_of(polygon_clip(p));
                seen += polygon_clip(p).count > 0;
            }
        }
        printf("%-12s %6.3f  %5.1f\n", weft_layer_name(rules[k]), 100.0 * off / all, (double)points / seen);
    }
}

int main(int argc, char **argv) {
    if (argc > 2) {
        fputs("study_area [LOBE]\n", stderr);
        return WEFT_USAGE;
    }
    lobe_tables_make();
    print_lobes(argc > 1 ? argv[1] : NULL);
    if (argc < 2) print_layers();
    return 0;
}
