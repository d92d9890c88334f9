/* The doctor of U3M: each finding on a file that has that fault alone, and none on a sound one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "u3m_text.h"
#include "weft/weft.h"

enum { SIDE = 32 };

/* A picture: grey and the colours of its texels, or normals of a wavy relief. */
typedef enum Picture { GREY, COLORED, RELIEF, DENTED, ENCODED } Picture;

static float encode(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f; }

/* Writes the texel of a normal map whose green points up, or down; y grows downwards. */
static void normal_write(uint8_t *p, int x, int y, Picture picture) {
    const float px = 0.5f * cosf(0.6f * (float)x + 0.35f * (float)y), py = 0.5833f * px, /* of sin(.6 x + .35 y) */
        green = picture == DENTED ? 0.0f - py : py, n = 1.0f / sqrtf(1.0f + px * px + py * py);
    const float c[3] = {0.5f - 0.5f * px * n, 0.5f + 0.5f * green * n, 0.5f + 0.5f * n};
    for (int k = 0; k < 3; k++) p[k] = (uint8_t)(255.0f * (picture == ENCODED ? encode(c[k]) : c[k]) + 0.5f);
}

static void picture_write(const char *path, Picture picture) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(SIDE, SIDE, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    uint8_t *p = image.pixels;
    for (int k = 0; k < SIDE * SIDE; k++, p += 3) {
        if (picture >= RELIEF)
            normal_write(p, k % SIDE, k / SIDE, picture);
        else
            p[0] = 128, p[1] = picture == GREY ? 128 : 20, p[2] = 128;
    }
    assert_int_equal(weft_image_write(path, &image, &error), WEFT_OK);
    weft_image_free(&image);
}

#define IMAGE(width, dpi, mode, path)                                                                                  \
    "\"image\":{\"dpi\":{\"x\":" dpi ",\"y\":81.28},\"width\":" width ",\"height\":10,\"path\":\"" path                \
    "\",\"repeat\":{\"mode\":\"" mode "\",\"rotation\":0}}"
#define PLAIN                   IMAGE("10", "81.28", "normal", "p.png")
#define NUMBER(constant, image) "{\"constant\":" constant ",\"texture\":{\"factor\":1,\"offset\":0," image "}}"
#define NORMALS(path)                                                                                                  \
    "{\"constant\":{\"x\":0,\"y\":0,\"z\":1},\"texture\":{\"scale\":1," IMAGE("10", "81.28", "normal", path) "}}"

typedef struct Case {
    WeftFindingKind kind; /* WEFT_FINDING_COUNT: none */
    const char *member, *value, *place;
    Picture picture;
    const char *second, *second_value;
} Case;

static const Case cases[] = {
    {WEFT_FINDING_COUNT, "\"roughness\"", NUMBER("0.5", PLAIN), NULL, GREY, NULL, NULL},
    {WEFT_FINDING_COUNT, "\"normal\"", NORMALS("p.png"), NULL, RELIEF, NULL, NULL},
    {WEFT_FINDING_U3M_SIZE, "\"roughness\"", NUMBER("0.5", IMAGE("0", "81.28", "normal", "p.png")),
     "/material/front/roughness", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_DPI, "\"roughness\"", NUMBER("0.5", IMAGE("10", "300", "normal", "p.png")),
     "/material/front/roughness", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_REPEAT, "\"roughness\"", NUMBER("0.5", IMAGE("10", "81.28", "mirror_x", "p.png")),
     "/material/front/roughness", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_CONSTANT, "\"roughness\"", NUMBER("0.9", PLAIN), "/material/front/roughness", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_CHANNELS, "\"roughness\"", NUMBER("0.36", PLAIN), "/material/front/roughness", COLORED, NULL,
     NULL},
    {WEFT_FINDING_U3M_MODE, "\"basecolor\"",
     "{\"constant\":{\"r\":1,\"g\":1,\"b\":1},\"texture\":{\"mode\":\"add\",\"factor\":{\"r\":1,\"g\":1,\"b\":1}," PLAIN
     "}}",
     "/material/front/basecolor", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_GLOSS, "\"roughness\"", NUMBER("0.5", IMAGE("10", "81.28", "normal", "my_Gloss.png")),
     "/material/front/roughness", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_SPECULAR, "\"specular_value\"", U3M_NUMBER_OF("0.04"), "/material/front/specular_value", GREY,
     NULL, NULL},
    {WEFT_FINDING_U3M_SPECULAR, "\"specular_value\"", U3M_NUMBER_OF("1.5"), "/material/front/specular_value", GREY,
     NULL, NULL},
    {WEFT_FINDING_U3M_TINT, "\"sheen_value\"", U3M_NUMBER_OF("0.5"), "/material/front/sheen_tint", GREY, NULL, NULL},
    {WEFT_FINDING_U3M_COAT_NORMAL, "\"normal\"", NORMALS("p.png"), "/material/front/clearcoat_normal", RELIEF,
     "\"clearcoat_value\"", U3M_NUMBER_OF("1")},
    {WEFT_FINDING_U3M_GREEN, "\"normal\"", NORMALS("p.png"), "/material/front/normal", DENTED, NULL, NULL},
    {WEFT_FINDING_U3M_NORMAL_SPACE, "\"normal\"", NORMALS("p.png"), "/material/front/normal", ENCODED, NULL, NULL},
    {WEFT_FINDING_IMAGE_UNREAD, "\"roughness\"", NUMBER("0.5", IMAGE("10", "81.28", "normal", "none.png")), "/material",
     GREY, NULL, NULL},
};

static WeftDoctor *examine(const char *text) {
    WeftDoctor *doctor;
    WeftError error;
    FILE *f = fopen("x.u3m", "w");
    assert_true(f && fputs(text, f) >= 0 && fclose(f) == 0);
    if (weft_doctor_open("x.u3m", &doctor, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return doctor;
}

static void each_fault_is_found_alone(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT];
    assert_true(scratch_enter(folder));
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Case *c = &cases[k];
        picture_write("p.png", c->picture);
        picture_write("my_Gloss.png", c->picture);
        u3m_text(text, c->member, c->value);
        if (c->second) u3m_put(text, c->second, c->second_value);
        WeftDoctor *doctor = examine(text);
        bool found = c->kind == WEFT_FINDING_COUNT;
        for (int n = 0; n < weft_doctor_count(doctor); n++) {
            const WeftFinding *finding = weft_doctor_finding(doctor, n);
            if (finding->kind == WEFT_FINDING_VALUE_RANGE) continue; /* the reader says so too */
            if (finding->kind != c->kind) fail_msg("case %zu: %s", k, finding->words);
            assert_string_equal(finding->place, c->place);
            assert_true(finding->fix[0] && !finding->fixable);
            found = true;
        }
        if (!found) fail_msg("case %zu: no %s", k, weft_finding_name((int)c->kind));
        weft_doctor_close(doctor);
    }
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void a_member_that_is_lacking_is_an_error(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT];
    WeftError error;
    assert_true(scratch_enter(folder));
    u3m_text(text, "\"roughness\"", U3M_NUMBER_OF("0.5"));
    char *tint = strstr(text, "\"sheen_tint\"");
    assert_non_null(tint);
    memcpy(tint, "\"other_tint\"", strlen("\"other_tint\""));
    WeftDoctor *doctor = examine(text);
    assert_int_equal(weft_doctor_count(doctor), 2);
    const WeftFinding *lacking = weft_doctor_finding(doctor, 0), *strange = weft_doctor_finding(doctor, 1);
    assert_int_equal(lacking->kind, WEFT_FINDING_U3M_MEMBER);
    assert_string_equal(lacking->place, "/material/front/sheen_tint");
    assert_string_equal(lacking->words,
                        "front.sheen_tint: it is lacking: readers take their own default, or refuse the file");
    assert_int_equal(strange->kind, WEFT_FINDING_PART_IGNORED);
    assert_non_null(strstr(strange->words, "other_tint"));
    assert_int_not_equal(weft_doctor_fix(doctor, "y.glb", &error), WEFT_OK);
    assert_non_null(strstr(error.text, "a U3M is not repaired"));
    weft_doctor_close(doctor);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_fault_is_found_alone),
        cmocka_unit_test(a_member_that_is_lacking_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
