/* Tables that are wrong in known ways, made here by code of their own, and what the audit says of them
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "weft/weft.h"

enum { SIDE = 16 };

/* Sanitizers take their time: WEFT_TEST_SHORT=1 asks for every third case of a list. */
static int stride(void) {
    const char *wish = getenv("WEFT_TEST_SHORT");
    return wish && wish[0] == '1' ? 3 : 1;
}

static void assert_near(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance)) fail_msg("%.9g, not %.9g +- %g", got, expected, tolerance);
}

static WeftTableForm form_of(const char *text) {
    WeftTableForm form;
    assert_int_equal(weft_table_form_parse(text, &form, NULL), WEFT_OK);
    return form;
}

static WeftLobe lobe_of_id(const char *id) {
    WeftLobe lobe;
    assert_int_equal(weft_lobe_init(id, &lobe, NULL), WEFT_OK);
    return lobe;
}

static WeftImage table_make(int width, int height) {
    WeftImage image;
    assert_int_equal(weft_image_create(width, height, 1, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    return image;
}

static size_t count_of(const WeftImage *table) { return (size_t)table->width * (size_t)table->height; }

/* The audit of a table, which is released, as E of a lobe; axes may be NULL. */
static WeftAudit audited(WeftImage *table, const char *lobe_id, const char *axes, double scale) {
    WeftAudit audit;
    WeftError error = {0};
    const WeftLobe lobe = lobe_of_id(lobe_id);
    const WeftTableForm form = axes ? form_of(axes) : (WeftTableForm){0};
    const WeftAuditDesc desc = {.image = table, .lobe = &lobe, .form = axes ? &form : NULL, .scale = scale};
    if (weft_audit(&desc, &audit, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(audit.faults >= 1);
    for (int k = 0; k < audit.faults; k++) {
        const char *text = audit.found[k].text;
        print_message("%s: %s\n", weft_table_fault_name(audit.found[k].fault), text);
        assert_true(strlen(text) > 8 && strlen(text) < WEFT_AUDIT_TEXT - 1 && !strchr(text, '\n'));
    }
    weft_image_free(table);
    return audit;
}

/* That there is one fault, this one, and that its sentence says so. */
static void assert_fault(const WeftAudit *audit, WeftTableFault fault, const char *words) {
    assert_string_equal(weft_table_fault_name(audit->found[0].fault), weft_table_fault_name(fault));
    assert_int_equal(audit->faults, 1);
    if (!strstr(audit->found[0].text, words)) fail_msg("\"%s\" is not in \"%s\"", words, audit->found[0].text);
}

/* Conty Estevez and Kulla 2017, equation 2, and the denominator of Neubelt and Pettineo 2013, as the LUT
 * shader of the glTF sample renderer has it: cut off at 1. */
static double d_charlie(double alpha, double cos_h) {
    return (2.0 + 1.0 / alpha) * (pow)(1.0 - cos_h * cos_h, 0.5 / alpha) / (2.0 * PI_DOUBLE);
}
static double v_neubelt(double o, double i) { return 1.0 / (4.0 * (o + i - o * i)); }

typedef struct Draw {
    double u, v;
} Draw;

/* Point k of n of Hammersley's, the same for all texels. */
static Draw hammersley(int k, int n) {
    double v = 0.0, part = 0.5;
    for (unsigned bits = (unsigned)k; bits; bits >>= 1, part *= 0.5) v += part * (bits & 1u);
    return (Draw){(double)k / n, v};
}

static Draw random_draw(int k, uint32_t seed) {
    const uint32_t key = hash_combine(hash32(seed), (uint32_t)k);
    return (Draw){(double)unit_float(hash32(key)), (double)unit_float(hash_combine(key, 1))};
}

/* One term of an estimate of E: what half vector (s, c) at azimuth 2 pi u gives, for d = D(h). */
static double term(double o, double s, double c, double u, double d, double most) {
    const double dot = (sqrt)(1.0 - o * o) * s * (cos)(2.0 * PI_DOUBLE * u) + o * c, i = 2.0 * dot * c - o;
    return i > 0.0 && dot > 0.0 ? fmin(v_neubelt(o, i), most) * d * i * dot : 0.0;
}

/* E of Charlie as the glTF sample renderer's LUT has it (source/shaders/ibl_filtering.frag): half vectors
 * drawn from D cos_h of alpha r^2, but weighted as if they were uniform, and D of r, not r^2, in the sum. */
static double biased(double o, double r, int n) {
    const double alpha = r * r;
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        const Draw draw = hammersley(k, n);
        const double s = (pow)(draw.v, alpha / (2.0 * alpha + 1.0)), c = (sqrt)(1.0 - s * s);
        sum += term(o, s, c, draw.u, d_charlie(r, c), 1.0);
    }
    return 8.0 * PI_DOUBLE * sum / n;
}

/* E of charlie-neubelt from uniform half vectors, other ones for each texel. */
static double noisy(double o, double r, int n, uint32_t seed) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        const Draw draw = random_draw(k, seed);
        const double c = draw.v, s = (sqrt)(1.0 - c * c);
        sum += term(o, s, c, draw.u, d_charlie(r * r, c), HUGE_VAL);
    }
    return 8.0 * PI_DOUBLE * sum / n;
}

/* A table of charlie-neubelt by uniform half vectors, the same many for all texels: nearly E. Rows may run
 * ahead of the axis. */
static double nearly(double o, double r, int n) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        const Draw draw = hammersley(k, n);
        const double c = 1.0 - draw.v, s = (sqrt)(1.0 - c * c);
        sum += term(o, s, c, draw.u, d_charlie(r * r, c), HUGE_VAL);
    }
    return 8.0 * PI_DOUBLE * sum / n;
}

static double mid(int k) { return (k + 0.5) / SIDE; }

/* The table that quadrature makes, in some form. */
static WeftImage right(const char *lobe_id, const char *axes) {
    const WeftLobe lobe = lobe_of_id(lobe_id);
    const WeftBakeDesc desc = {.kind = "albedo", .lobe = &lobe, .width = SIDE, .height = SIDE, .form = form_of(axes)};
    WeftImage table;
    assert_int_equal(weft_bake(&desc, NULL, &table, NULL), WEFT_OK);
    return table;
}

/* ---- nothing is wrong ---- */

static void right_table_has_no_fault(void **state) {
    (void)state;
    WeftImage table = right("charlie-neubelt", "filament");
    WeftAudit audit = audited(&table, "charlie-neubelt", NULL, 0.0);
    assert_fault(&audit, WEFT_TABLE_NONE, "it is right");
    assert_near(audit.largest, 0.0, 0.0);
    assert_near(audit.beyond, 0.0, 0.0);
    assert_int_equal(audit.left_out, SIDE); /* roughness 0.025 */
    assert_int_equal(audit.texels, SIDE * (SIDE - 1));
    assert_string_equal(weft_table_form_name(weft_table_form_find(&audit.form)), "filament");
}

/* Each convention is told from the others by the numbers alone. */
static void form_of_a_table_is_found_from_its_numbers(void **state) {
    (void)state;
    for (int k = 0; weft_table_form_name(k); k += stride()) {
        WeftImage table = right("ashikhmin-neubelt", weft_table_form_name(k));
        WeftAudit audit = audited(&table, "ashikhmin-neubelt", NULL, 0.0);
        assert_int_equal(weft_table_form_find(&audit.form), k);
        assert_fault(&audit, WEFT_TABLE_NONE, "it is right");
    }
    WeftImage table = right("ashikhmin-neubelt", "alpha,sqrt-cos,centres,flip-x"); /* nobody's */
    WeftAudit audit = audited(&table, "ashikhmin-neubelt", NULL, 0.0);
    const WeftTableForm form = form_of("alpha,sqrt-cos,centres,flip-x");
    assert_memory_equal(&audit.form, &form, sizeof form);
    assert_near(audit.largest, 0.0, 1e-4);
}

static void quantised_table_is_right_within_its_bits(void **state) {
    (void)state;
    for (int deep = 0; deep < 2; deep++) {
        WeftImage table = right("ashikhmin-neubelt", "gltf"), whole;
        const WeftPixelType type = deep ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8;
        assert_int_equal(weft_image_create(SIDE, SIDE, 1, type, &whole, NULL), WEFT_OK);
        for (size_t n = 0; n < count_of(&table); n++) { /* a table / 2, as scale says */
            const double value = 0.5 * (double)((float *)table.pixels)[n];
            if (deep)
                ((uint16_t *)whole.pixels)[n] = (uint16_t)(65535.0 * value + 0.5);
            else
                ((uint8_t *)whole.pixels)[n] = (uint8_t)(255.0 * value + 0.5);
        }
        weft_image_free(&table);
        WeftAudit audit = audited(&whole, "ashikhmin-neubelt", NULL, 2.0);
        assert_fault(&audit, WEFT_TABLE_NONE, "what its bits can hold");
        assert_near(audit.step, deep ? 2.0 / 65535.0 : 2.0 / 255.0, 1e-9);
        assert_true(audit.largest > 0.2 * audit.step && audit.largest < 0.5 * audit.step + 1e-4);
    }
}

/* Which of the two parts of a lobe a channel holds is found too. */
static void part_that_a_channel_holds_is_found(void **state) {
    (void)state;
    const WeftLobe ggx = lobe_of_id("ggx");
    const WeftTablePart parts[2][2] = {{WEFT_TABLE_F0, WEFT_TABLE_F90}, {WEFT_TABLE_F90, WEFT_TABLE_SUM}};
    for (int total = 0; total < 2; total++)
        for (int channel = 0; channel < 2; channel++) {
            const WeftTableForm form = {.alpha = 1, .total = total};
            const WeftBakeDesc bake = {.kind = "dfg", .width = SIDE, .height = SIDE, .form = form, .tolerance = 1e-4};
            WeftImage table;
            WeftAudit audit;
            assert_int_equal(weft_bake(&bake, NULL, &table, NULL), WEFT_OK);
            const WeftAuditDesc desc = {.image = &table, .channel = channel, .lobe = &ggx, .form = &form};
            assert_int_equal(weft_audit(&desc, &audit, NULL, NULL), WEFT_OK);
            assert_int_equal(audit.part, parts[total][channel]);
            assert_near(audit.largest, 0.0, 1e-4);
            weft_image_free(&table);
        }
}

/* ---- the classic faults ---- */

static void black_table_is_named(void **state) {
    (void)state;
    WeftImage table = table_make(SIDE, SIDE);
    WeftAudit audit = audited(&table, "charlie-neubelt", NULL, 0.0);
    assert_fault(&audit, WEFT_TABLE_CONSTANT, "it is black");
    assert_true(audit.beyond > 0.5 && audit.mean < -0.2);
    table = table_make(1, 1);
    audit = audited(&table, "charlie-neubelt", NULL, 0.0);
    assert_fault(&audit, WEFT_TABLE_CONSTANT, "a single texel");
    table = table_make(4, 3);
    for (int n = 0; n < 12; n++) ((float *)table.pixels)[n] = 0.25f;
    audit = audited(&table, "charlie-neubelt", "gltf", 0.0);
    assert_fault(&audit, WEFT_TABLE_CONSTANT, "all of its texels are 0.25");
    /* but where E is the same everywhere, a table of it is right */
    table = table_make(4, 3);
    for (int n = 0; n < 12; n++) ((float *)table.pixels)[n] = 1.0f;
    audit = audited(&table, "lambert", "gltf", 0.0);
    assert_fault(&audit, WEFT_TABLE_NONE, "it is right");
}

static void table_with_exchanged_axes_is_named(void **state) {
    (void)state;
    static const struct {
        const char *made, *said, *words;
    } cases[] = {
        {"gltf", "three", "its axes are swapped"},
        {"gltf", "filament", "its rows are in reverse"},
        {"cos,roughness,centres,flip-x", "gltf", "its columns are in reverse"},
        {"materialx", "gltf", "over alpha where roughness was said"},
        {"gltf", "materialx", "over roughness where alpha was said"},
        {"zeltner", "materialx", "its outer texels are at 0 and 1"},
        {"sqrt-cos,roughness,centres", "gltf", "over the square root of cos_o"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k += (size_t)stride()) {
        WeftImage table = right("ashikhmin-neubelt", cases[k].made);
        WeftAudit audit = audited(&table, "ashikhmin-neubelt", cases[k].said, 0.0);
        assert_fault(&audit, WEFT_TABLE_FORM, cases[k].words);
        assert_non_null(strstr(audit.found[0].text, "it is right, but"));
        assert_true(audit.rms > 0.003); /* it was judged as was said */
    }
}

static void table_shifted_by_half_a_texel_is_named(void **state) {
    (void)state;
    WeftImage table = table_make(SIDE, SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) /* as cmgen has them: row j holds (j + 1.5) / n */
            ((float *)table.pixels)[y * SIDE + x] = (float)nearly(mid(x), fmin(mid(y) + 1.0 / SIDE, 1.0), 4096);
    WeftAudit audit = audited(&table, "charlie-neubelt", "gltf", 0.0);
    assert_fault(&audit, WEFT_TABLE_LATE, "the next one up");
}

static void table_scaled_by_a_factor_is_named(void **state) {
    (void)state;
    WeftImage table = right("charlie-khronos", "three");
    for (size_t n = 0; n < count_of(&table); n++) ((float *)table.pixels)[n] /= (float)(2.0 * PI_DOUBLE);
    WeftAudit audit = audited(&table, "charlie-khronos", NULL, 0.0);
    assert_fault(&audit, WEFT_TABLE_SCALED, "which is 2 pi");
    assert_string_equal(weft_table_form_name(weft_table_form_find(&audit.form)), "three");
}

static void table_encoded_as_srgb_is_named(void **state) {
    (void)state;
    WeftImage table = right("ashikhmin-neubelt", "gltf");
    for (size_t n = 0; n < count_of(&table); n++) {
        const double x = (double)((float *)table.pixels)[n];
        ((float *)table.pixels)[n] = (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * (pow)(x, 1.0 / 2.4) - 0.055);
    }
    WeftAudit audit = audited(&table, "ashikhmin-neubelt", "gltf", 0.0);
    assert_fault(&audit, WEFT_TABLE_ENCODED, "sRGB");
}

static void table_clipped_at_one_is_named(void **state) {
    (void)state;
    WeftImage table = right("charlie-neubelt", "gltf");
    for (size_t n = 0; n < count_of(&table); n++) ((float *)table.pixels)[n] = fminf(((float *)table.pixels)[n], 1.0f);
    WeftAudit audit = audited(&table, "charlie-neubelt", "gltf", 0.0);
    assert_fault(&audit, WEFT_TABLE_CLIPPED, "cut off at 1");
}

static void table_of_another_lobe_is_named(void **state) {
    (void)state;
    WeftImage table = right("ashikhmin-neubelt", "materialx");
    WeftAudit audit = audited(&table, "charlie-neubelt", "materialx", 0.0);
    assert_fault(&audit, WEFT_TABLE_OTHER_LOBE, "nearer to the E of ashikhmin-neubelt");
    assert_int_equal(audit.other, weft_lobe_find("ashikhmin-neubelt"));
    if (stride() > 1) return;
    table = right("charlie-neubelt", "three"); /* the pair that is most often mistaken, its axes unsaid */
    audit = audited(&table, "charlie-khronos", NULL, 0.0);
    assert_fault(&audit, WEFT_TABLE_OTHER_LOBE, "nearer to the E of charlie-neubelt ");
    assert_non_null(strstr(audit.found[0].text, "roughness,cos,centres"));
}

/* The generator is off by what it was measured to be, and more samples do not mend it. */
static void biased_generator_is_the_known_one(void **state) {
    (void)state;
    static const struct { double o, r, excess, tolerance; } known[] = {{0.5, 0.5, 0.70, 0.02}, {0.5, 1.0, 0.07, 0.02}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        char alpha[32];
        float e[3];
        WeftLobe lobe = lobe_of_id("charlie-khronos");
        snprintf(alpha, sizeof alpha, "%.9g", known[k].r * known[k].r);
        assert_int_equal(weft_lobe_set(&lobe, "alpha", alpha, NULL, NULL), WEFT_OK);
        weft_lobe_albedo(&lobe, (float)known[k].o, e);
        const double few = biased(known[k].o, known[k].r, 512), many = biased(known[k].o, known[k].r, 16384);
        assert_near(many / (double)e[0], 1.0 + known[k].excess, known[k].tolerance);
        assert_near(few / many, 1.0, 0.01);
    }
}

static void bias_of_a_table_is_distinguished_from_noise(void **state) {
    (void)state;
    static const char *const lobes[] = {"charlie-khronos", "charlie-neubelt"};
    for (int k = 0; k < 2; k += stride()) {
        WeftImage table = table_make(SIDE, SIDE);
        for (int n = 0; n < SIDE * SIDE; n++)
            ((float *)table.pixels)[n] = (float)biased(mid(n % SIDE), mid(n / SIDE), 512);
        WeftAudit audit = audited(&table, lobes[k], k ? "gltf" : NULL, 0.0);
        assert_fault(&audit, WEFT_TABLE_BIASED, "more samples would not cure it");
        assert_true(audit.together > 0.8 && audit.mean > 0.03 && audit.beyond > 0.5);
        assert_string_equal(weft_table_form_name(weft_table_form_find(&audit.form)), "gltf");
    }
    double deviation[2];
    for (int k = 0; k < 2; k++) {
        WeftImage table = table_make(SIDE, SIDE);
        for (int n = 0; n < SIDE * SIDE; n++)
            ((float *)table.pixels)[n] =
                (float)noisy(mid(n % SIDE), (sqrt)(mid(n / SIDE)), k ? 2048 : 512, (uint32_t)n);
        WeftAudit audit = audited(&table, "charlie-neubelt", "materialx", 0.0);
        assert_fault(&audit, WEFT_TABLE_NOISY, "four times the samples would halve");
        assert_true(fabs(audit.together) < 0.25 && audit.beyond > 0.1);
        deviation[k] = audit.rms;
    }
    assert_true(deviation[1] < 0.7 * deviation[0]); /* and so they do, but for the tail */
}

static void error_in_a_corner_is_named(void **state) {
    (void)state;
    WeftImage table = right("ashikhmin-neubelt", "gltf");
    ((float *)table.pixels)[7 * SIDE + 2] += 0.1f;
    WeftAudit audit = audited(&table, "ashikhmin-neubelt", "gltf", 0.0);
    assert_fault(&audit, WEFT_TABLE_CORNER, "in a corner");
    assert_int_equal(audit.place.x, 2);
    assert_int_equal(audit.place.y, 7);
    assert_near((double)audit.place.cos_o, mid(2), 1e-6);
    assert_near((double)audit.place.value, mid(7) * mid(7), 1e-6);
    assert_near(audit.largest, 0.1, 1e-3);
    assert_near(audit.rms, 0.1 / (sqrt)((double)audit.texels), 1e-4);
    assert_near(audit.mean, 0.1 / (double)audit.texels, 1e-5);
    assert_near(audit.beyond, 1.0 / (double)audit.texels, 1e-9);
}

static void audit_map_holds_error_table_and_albedo(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("charlie-khronos");
    const WeftTableForm form = form_of("cos,alpha,edges");
    WeftImage table = table_make(3, 5), errors;
    WeftAudit audit;
    for (int n = 0; n < 15; n++) ((float *)table.pixels)[n] = 0.01f * (float)n;
    const WeftAuditDesc desc = {.image = &table, .lobe = &lobe, .form = &form};
    assert_int_equal(weft_audit(&desc, &audit, &errors, NULL), WEFT_OK);
    assert_int_equal(audit.texels, 8); /* all but the row of alpha 0 and the column of cos_o 0 */
    assert_int_equal(errors.channels, 3);
    for (int n = 0; n < 15; n++) {
        const float *texel = (const float *)errors.pixels + 3 * n;
        float e[3] = {0};
        if (n % 3 && n / 3) {
            char alpha[16];
            WeftLobe rough = lobe;
            snprintf(alpha, sizeof alpha, "%g", (double)(n / 3) / 4.0);
            assert_int_equal(weft_lobe_set(&rough, "alpha", alpha, NULL, NULL), WEFT_OK);
            weft_lobe_albedo(&rough, (float)(n % 3) / 2.0f, e);
        }
        const double value = n % 3 && n / 3 ? 0.01 * n : 0.0;
        assert_near((double)texel[2], (double)e[0], 2e-4);
        assert_near((double)texel[1], value, 1e-6);
        assert_near((double)texel[0], (double)texel[1] - (double)texel[2], 1e-6);
    }
    weft_image_free(&errors);
    weft_image_free(&table);
}

/* ---- refusals ---- */

static int stop_at_once(void *user, double fraction) {
    (void)user;
    (void)fraction;
    return 1;
}

static void audit_of_unsuitable_tables_is_refused(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("charlie-neubelt"), none = {.lobe = -3};
    const WeftTableForm form = {0}, nothing = {.edges = 1};
    WeftImage table = table_make(4, 4), grazing = table_make(1, 4), errors;
    for (int n = 0; n < 4; n++) ((float *)grazing.pixels)[n] = 0.1f * (float)n;
    for (int n = 0; n < 16; n++) ((float *)table.pixels)[n] = 0.01f * (float)n;
    WeftImage huge = {.width = 65536, .height = 65536, .channels = 1, .pixels = table.pixels};
    const WeftAuditDesc wrong[] = {
        {.lobe = &lobe},
        {.image = &(WeftImage){0}, .lobe = &lobe},
        {.image = &table, .lobe = &none},
        {.image = &table, .lobe = &lobe, .channel = 1},
        {.image = &table, .lobe = &lobe, .channel = -1},
        {.image = &table, .lobe = &lobe, .threads = 1000},
        {.image = &huge, .lobe = &lobe},
        {.image = &grazing, .lobe = &lobe, .form = &nothing}, /* one column, at cos_o 0 */
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        WeftAudit audit;
        WeftError error = {0};
        assert_int_equal(weft_audit(&wrong[k], &audit, &errors, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_null(errors.pixels);
    }
    WeftAudit audit;
    const WeftAuditDesc stopped = {.image = &table, .lobe = &lobe, .form = &form, .progress = stop_at_once};
    assert_int_equal(weft_audit(&stopped, &audit, &errors, NULL), WEFT_INTERRUPTED);
    assert_null(errors.pixels);
    weft_image_free(&table);
    weft_image_free(&grazing);
}

static WeftImage baked(const char *lobe_id, const char *axes) {
    const WeftLobe lobe = lobe_of_id(lobe_id);
    const WeftBakeDesc desc = {.kind = "albedo", .lobe = &lobe, .width = SIDE, .height = SIDE, .form = form_of(axes)};
    WeftImage table;
    assert_int_equal(weft_bake(&desc, NULL, &table, NULL), WEFT_OK);
    return table;
}

static WeftAudit audited_as_any(WeftImage *table) {
    WeftAudit audit;
    WeftError error = {0};
    const WeftAuditDesc desc = {.image = table};
    if (weft_audit(&desc, &audit, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(table);
    return audit;
}

/* Without a word of what it holds: the lobe, the axes however they are turned, and sRGB if it is that. */
static void a_table_of_an_unknown_lobe_is_recognised(void **state) {
    (void)state;
    static const char *const lobes[] = {"charlie-neubelt", "charlie-conty-kulla", "ashikhmin-neubelt"},
                             *const axes[] = {"gltf", "filament", "cos,roughness,centres"};
    for (int k = 0; k < 3; k++)
        for (int encoded = 0; encoded < 2; encoded++) {
            WeftImage table = baked(lobes[k], axes[k]);
            float *values = table.pixels;
            for (size_t n = 0; encoded && n < count_of(&table); n++)
                values[n] =
                    values[n] <= 0.0031308f ? 12.92f * values[n] : 1.055f * powf(values[n], 1.0f / 2.4f) - 0.055f;
            const WeftTableForm form = form_of(axes[k]);
            const WeftAudit audit = audited_as_any(&table);
            assert_string_equal(weft_lobe_info(audit.lobe)->id, lobes[k]);
            assert_int_equal(weft_table_form_find(&audit.form), weft_table_form_find(&form));
            assert_string_equal(weft_table_fault_name(audit.found[0].fault),
                                weft_table_fault_name(encoded ? WEFT_TABLE_ENCODED : WEFT_TABLE_NONE));
        }
}

/* Nothing is like it: the nearest is named all the same, and how far off that is. */
static void table_of_no_lobe_has_a_nearest_one(void **state) {
    (void)state;
    WeftImage table = table_make(SIDE, SIDE);
    for (int n = 0; n < SIDE * SIDE; n++) ((float *)table.pixels)[n] = 0.5f + 0.4f * (float)((n % SIDE + n / SIDE) % 2);
    const WeftAudit audit = audited_as_any(&table);
    assert_non_null(weft_lobe_info(audit.lobe));
    assert_int_equal(audit.fits, 0);
    assert_true(audit.rms > 0.05 && audit.largest > 0.1);
}

/* A part of a lobe of two colours, as most tables of engines are of ggx. */
static void a_part_of_an_unknown_lobe_is_recognised(void **state) {
    (void)state;
    static const char *const axes[] = {"three", "hdrp"};
    for (int k = 0; k < 2; k++)
        for (int part = 0; part < 2; part++) {
            const WeftLobe lobe = lobe_of_id("ggx");
            WeftTableForm form = form_of(axes[k]);
            form.total = 0;
            const WeftBakeDesc desc = {.kind = "albedo", .lobe = &lobe, .width = SIDE, .height = SIDE, .form = form};
            WeftImage both, table = table_make(SIDE, SIDE);
            assert_int_equal(weft_bake(&desc, NULL, &both, NULL), WEFT_OK);
            assert_int_equal(both.channels, 2);
            for (int n = 0; n < SIDE * SIDE; n++)
                ((float *)table.pixels)[n] = ((const float *)both.pixels)[2 * n + part];
            weft_image_free(&both);
            const WeftAudit audit = audited_as_any(&table);
            assert_string_equal(weft_lobe_info(audit.lobe)->id, "ggx");
            assert_int_equal(audit.part, part ? WEFT_TABLE_F90 : WEFT_TABLE_F0);
            assert_int_equal(weft_table_form_find(&audit.form), weft_table_form_find(&form));
            assert_string_equal(weft_table_fault_name(audit.found[0].fault), "none");
        }
}

/* What hides lobe and axes: a shift by a texel, or a factor. */
static void a_cause_is_found_in_a_table_of_an_unknown_lobe(void **state) {
    (void)state;
    static const char *const axes[] = {"filament", "three"};
    for (int k = 0; k < 2; k++) {
        const WeftTableForm form = form_of(axes[k]);
        WeftImage table = baked("charlie-neubelt", axes[k]);
        float *values = table.pixels;
        for (size_t n = 0; n < count_of(&table); n++) values[n] *= 0.31830989f;
        const WeftAudit scaled = audited_as_any(&table);
        assert_string_equal(weft_lobe_info(scaled.lobe)->id, "charlie-neubelt");
        assert_int_equal(weft_table_form_find(&scaled.form), weft_table_form_find(&form));
        assert_string_equal(weft_table_fault_name(scaled.found[0].fault), "scaled");
        assert_non_null(strstr(scaled.found[0].text, "which is pi"));
        assert_true(scaled.fits);

        WeftImage shifted = table_make(SIDE, SIDE);
        const WeftLobe lobe = lobe_of_id("charlie-neubelt");
        const int step = form.flip_x || form.flip_y ? -1 : 1; /* towards more roughness */
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                float cos_o, value, e[3];
                const int at_x = x + (form.transposed ? step : 0), at_y = y + (form.transposed ? 0 : step);
                WeftLobe here = lobe;
                weft_table_form_texel(&form, lobe.lobe, SIDE, SIDE, at_x, at_y, &cos_o, &value);
                here.params[0] = fminf(value, 1.0f);
                weft_lobe_albedo(&here, cos_o, e);
                ((float *)shifted.pixels)[y * SIDE + x] = e[0];
            }
        const WeftAudit late = audited_as_any(&shifted);
        assert_string_equal(weft_lobe_info(late.lobe)->id, "charlie-neubelt");
        assert_int_equal(weft_table_form_find(&late.form), weft_table_form_find(&form));
        assert_string_equal(weft_table_fault_name(late.found[0].fault), "shifted");
    }
}

/* A smooth table that is E of nothing, and one of a single value. */
static void where_no_lobe_fits_that_is_said(void **state) {
    (void)state;
    WeftImage table = table_make(SIDE, SIDE);
    for (int n = 0; n < SIDE * SIDE; n++)
        ((float *)table.pixels)[n] = 0.5f + 0.4f * sinf(0.9f * (float)(n % SIDE)) * cosf(0.7f * (float)(n / SIDE));
    WeftAudit audit = audited_as_any(&table);
    assert_int_equal(audit.fits, 0);
    assert_int_equal(audit.other, -1);
    assert_string_equal(weft_table_fault_name(audit.found[0].fault), "lobe");
    assert_non_null(strstr(audit.found[0].text, "no lobe fits it"));
    table = table_make(SIDE, SIDE);
    for (int n = 0; n < SIDE * SIDE; n++) ((float *)table.pixels)[n] = 0.37f;
    audit = audited_as_any(&table);
    assert_string_equal(weft_table_fault_name(audit.found[0].fault), "constant");
}

static bool is_judged(const WeftImage *errors, int x, int y) {
    return ((const float *)errors->pixels)[3 * ((size_t)y * (size_t)errors->width + (size_t)x) + 2] > 0.0f;
}

/* A random texel, or the first that is judged in its column, or in its row. */
static void place_asked(const WeftImage *errors, int k, int *x, int *y) {
    *x = (int)(hash32(2 * (uint32_t)k + 1) % (uint32_t)errors->width);
    *y = (int)(hash32(2 * (uint32_t)k + 2) % (uint32_t)errors->height);
    if (k % 3 == 1)
        for (*y = 0; *y + 1 < errors->height && !is_judged(errors, *x, *y);) ++*y;
    if (k % 3 == 2)
        for (*x = 0; *x + 1 < errors->width && !is_judged(errors, *x, *y);) ++*x;
}

/* That E of a lobe in a table of that size is as near as the audit says. */
static void assert_stated_error(const char *lobe_id, const char *axes, int width, int height) {
    enum { ASKED = 180 };
    WeftImage table = table_make(width, height), errors;
    WeftError error;
    WeftAudit audit;
    const WeftLobe lobe = lobe_of_id(lobe_id);
    const WeftTableForm form = form_of(axes);
    const WeftAuditDesc desc = {.image = &table, .lobe = &lobe, .form = &form};
    if (weft_audit(&desc, &audit, &errors, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(audit.error < 5e-4);
    for (int k = 0; k < ASKED; k++) {
        int x, y;
        place_asked(&errors, k, &x, &y);
        const float *texel = (const float *)errors.pixels + 3 * ((size_t)y * (size_t)width + (size_t)x);
        WeftLobe there = lobe;
        float cos_o, e[3];
        weft_table_form_texel(&form, lobe.lobe, width, height, x, y, &cos_o, &there.params[0]);
        if (!(cos_o > 0.0f) || !(texel[2] > 0.0f)) continue;
        weft_lobe_albedo(&there, cos_o, e);
        assert_near((double)texel[2], (double)e[0], audit.error + 1e-4);
    }
    weft_image_free(&table);
    weft_image_free(&errors);
}

/* E of a large table is measured where it bends; between, it is as near as is said. */
static void albedo_of_a_large_table_has_the_stated_error(void **state) {
    (void)state;
    assert_stated_error("charlie-neubelt", "gltf", 200, 200);
    assert_stated_error("charlie-neubelt", "gltf", 1024, 1024);
    assert_stated_error("fibre-table", "sqrt-cos,alpha,edges", 150, 130);
    assert_stated_error("ashikhmin-conty-kulla", "alpha,sqrt-cos,centres", 700, 520);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right_table_has_no_fault),
        cmocka_unit_test(form_of_a_table_is_found_from_its_numbers),
        cmocka_unit_test(quantised_table_is_right_within_its_bits),
        cmocka_unit_test(part_that_a_channel_holds_is_found),
        cmocka_unit_test(black_table_is_named),
        cmocka_unit_test(table_with_exchanged_axes_is_named),
        cmocka_unit_test(table_shifted_by_half_a_texel_is_named),
        cmocka_unit_test(table_scaled_by_a_factor_is_named),
        cmocka_unit_test(table_encoded_as_srgb_is_named),
        cmocka_unit_test(table_clipped_at_one_is_named),
        cmocka_unit_test(table_of_another_lobe_is_named),
        cmocka_unit_test(biased_generator_is_the_known_one),
        cmocka_unit_test(bias_of_a_table_is_distinguished_from_noise),
        cmocka_unit_test(error_in_a_corner_is_named),
        cmocka_unit_test(audit_map_holds_error_table_and_albedo),
        cmocka_unit_test(audit_of_unsuitable_tables_is_refused),
        cmocka_unit_test(a_table_of_an_unknown_lobe_is_recognised),
        cmocka_unit_test(table_of_no_lobe_has_a_nearest_one),
        cmocka_unit_test(a_part_of_an_unknown_lobe_is_recognised),
        cmocka_unit_test(a_cause_is_found_in_a_table_of_an_unknown_lobe),
        cmocka_unit_test(where_no_lobe_fits_that_is_said),
        cmocka_unit_test(albedo_of_a_large_table_has_the_stated_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
