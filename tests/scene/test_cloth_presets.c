/* What holds of the threads of every woven preset, at random places of the cloth: directions that lobe yarn draws carry
 * light that varies little, and points send back no more light than falls on the cloth, on the mean over it. A crown
 * alone may send back more, since it gets more than its share. */
#include "shading/cases.h"

#include <string.h>

#include "base/pi.h"
#include "scene/scene.h"
#include "shading/weave_light.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"

enum { PLACES = 400, DRAWN = 256, THREADS = 480 };

/* What drawn directions carry, f cos / pdf, of fibres of albedo 0.9: sums of it and of its square. White: of albedo 1. */
typedef struct Carried {
    double sum, square, white;
} Carried;

static Carried draw(const YarnPrepared *yarn, Dir o, Random *random) {
    Carried c = {0.0, 0.0, 0.0};
    YarnView view;
    yarn_view(yarn, o, &view);
    for (int k = 0; k < DRAWN; k++) {
        const Dir i = yarn_sample(yarn, &view, o, random_unit(random), random_unit(random));
        if (i.z <= 0.0f) continue;
        const LobeValue v = yarn_value(yarn, &view, angles_between(o, i));
        const double white = (double)(v.f * i.z / v.pdf), again = (double)v.s;
        const double all = white * (0.9 * (1.0 - again) + (double)yarn_reflectance(0.9f) * again);
        c.sum += all / DRAWN, c.square += all * all / DRAWN, c.white += white / DRAWN;
    }
    return c;
}

/* Over the places of a cloth, with the part that is open to light between threads. */
typedef struct Found {
    double
        variance; /* of what is carried, about the mean of each place, in parts of the squared mean of all */
    double mean, most; /* E of white fibres, on the mean and where it is largest */
} Found;

static Found find(const Weave *m, float degrees, Random *random) {
    double variance = 0.0, sum = 0.0;
    Found found = {0.0, 0.0, 0.0};
    for (int k = 0; k < PLACES; k++) {
        const WeavePoint point =
            weave_point(m, THREADS * random_unit(random), THREADS * random_unit(random), 0.02f);
        if (point.height <= WEAVE_NONE) continue;
        const Dir o =
            direction_cos((cos)((double)degrees * RADIANS), 2.0 * PI_DOUBLE * (double)random_unit(random));
        YarnPrepared yarn;
        yarn_prepare(weave_yarn(m, point), &yarn);
        const Carried c = draw(&yarn, o, random);
        const double white = c.white * (double)weave_open(m, point);
        variance += (c.square - c.sum * c.sum) / PLACES;
        sum += c.sum / PLACES;
        found.mean += white / PLACES;
        found.most = fmax(found.most, white);
    }
    found.variance = variance / (sum * sum);
    return found;
}

static bool is_woven(const char *name) {
    return strncmp(name, "woven-", 6) == 0 || strncmp(name, "irawan-", 7) == 0 ||
           strncmp(name, "sadeghi-", 8) == 0;
}

static void points_send_back_what_falls_on_the_cloth_with_little_variance(void **state) {
    (void)state;
    static const float degrees[] = {10, 45, 75};
    static const double most[] = {0.32, 0.36, 0.48};
    double worst[3] = {0.0, 0.0, 0.0}, mean[3] = {0.0, 0.0, 0.0};
    WeftScene *scene;
    WeftError error;
    Random random = {29};
    int count = 0;
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, &error), WEFT_OK);
    for (int k = 0; weft_preset_name(k); k++) {
        const char *name = weft_preset_name(k), *text = weft_preset_text(k);
        if (!is_woven(name)) continue;
        if (weft_scene_assign_material_memory(scene, NULL, text, strlen(text), name, NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        count++;
        printf("%-24s", name);
        for (int d = 0; d < 3; d++) {
            const Found f = find(&scene->cloths[scene->materials[0].cloth - 1]->weave, degrees[d], &random);
            printf("  %2.0f: variance %.2f, E %.2f, at most %.2f", (double)degrees[d], f.variance, f.mean,
                   f.most);
            assert_true(f.variance < most[d]);
            assert_true(f.mean < 1.0);
            worst[d] = fmax(worst[d], f.variance), mean[d] += f.variance;
        }
        printf("\n");
    }
    printf("variance on the mean %.2f, %.2f and %.2f, at worst %.2f, %.2f and %.2f\n", mean[0] / count,
           mean[1] / count, mean[2] / count, worst[0], worst[1], worst[2]);
    assert_true(count >= 20);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_send_back_what_falls_on_the_cloth_with_little_variance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
