/* doctor_energy.c - what a sheen does with light under each engine that reads glTF, measured on what renders
 * there
 *
 * The material is taken with the means of its textures. E is the share of light that comes back, all of it
 * towards one cosine: weft_reflection_albedo of the whole material; and of its sheen alone, white, by
 * quadrature. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measure/doctor.h"
#include "scene/shade.h"
#include "shading/albedo.h"
#include "shading/choice.h"
#include "shading/frame.h"
#include "weft/material.h"
#include "weft/reflection.h"

/* From the face to 87 degrees; beyond, a pixel of cloth is a sliver. */
static const float cosines[] = {0.8f, 0.5f, 0.3f, 0.2f, 0.1f, 0.05f};
enum { COSINES = sizeof cosines / sizeof *cosines, READERS = 5 };

/* What an engine makes of a material, with its sheen and without: E of the strongest channel, and luminance.
 */
typedef struct Answer {
    float with[COSINES], without[COSINES];
    float light_with[COSINES], light_without[COSINES];
} Answer;

static int input_of(const char *name) {
    int k = 0;
    while (weft_material_input_name(k) && strcmp(weft_material_input_name(k), name) != 0) k++;
    return k;
}

static void set_input(WeftMaterial *material, const char *name, const float *value, int count) {
    WeftInput *input = &material->inputs[input_of(name)];
    for (int c = 0; c < 3; c++) input->value[c] = value[count == 1 ? 0 : c];
    input->texture = 0;
}

/* The material as numbers; color: of the sheen. */
static bool numbers_of(const WeftDoctor *doctor, const Cloth *cloth, const float color[3], float roughness,
                       const char *profile, WeftMaterial *out) {
    WeftError error;
    if (weft_scene_material(doctor->scene, cloth->index, out, &error) != WEFT_OK) return false;
    set_input(out, "base_color", cloth->base, 3);
    set_input(out, "metallic", &cloth->metallic, 1);
    set_input(out, "sheen_color", color, 3);
    set_input(out, "sheen_roughness", &roughness, 1);
    out->choices[CHOICE_profile] = choice_find(CHOICE_profile, profile);
    return true;
}

static void measure_all(const WeftMaterial *material, float most[COSINES], float light[COSINES]) {
    WeftReflection *reflection;
    WeftError error;
    for (int k = 0; k < COSINES; k++) most[k] = light[k] = 0.0f;
    if (weft_reflection_create(material, &reflection, &error) != WEFT_OK) return;
    for (int k = 0; k < COSINES; k++) {
        float e[3];
        weft_reflection_albedo(reflection, WEFT_PART_ALL, cosines[k], e);
        most[k] = fmaxf(e[0], fmaxf(e[1], e[2]));
        light[k] = 0.2126f * e[0] + 0.7152f * e[1] + 0.0722f * e[2];
    }
    weft_reflection_free(reflection);
}

/* known: another answer of the same engine, whose part without the sheen holds here too; NULL: there is none.
 */
static Answer ask(const WeftDoctor *doctor, const Cloth *cloth, float roughness, int reader,
                  const Answer *known) {
    static const float black[3] = {0.0f, 0.0f, 0.0f};
    const char *profile = doctor_readers[reader];
    Answer answer = {{0.0f}, {0.0f}, {0.0f}, {0.0f}};
    WeftMaterial material;
    if (known) answer = *known;
    if (numbers_of(doctor, cloth, cloth->color, roughness, profile, &material))
        measure_all(&material, answer.with, answer.light_with);
    if (!known && numbers_of(doctor, cloth, black, roughness, profile, &material))
        measure_all(&material, answer.without, answer.light_without);
    return answer;
}

/* How much more than everything comes back because of the sheen, and where; what an engine's base gains
 * without any is not the sheen's. 1e-2 is what weft_reflection_albedo may err. */
static float gain(const Answer *answer, int *where) {
    const float slack = 0.02f;
    float most = 0.0f;
    for (int k = 0; k < COSINES; k++) {
        float over = answer->with[k] - fmaxf(1.0f, answer->without[k]) - slack;
        if (over <= most) continue;
        most = over;
        *where = k;
    }
    return most;
}

static bool gains_anywhere(const WeftDoctor *doctor, const Cloth *cloth, float roughness,
                           const Answer answers[READERS]) {
    bool gains = false;
    int where;
    for (int r = 0; r < READERS && !gains; r++) {
        Answer answer = ask(doctor, cloth, roughness, r, &answers[r]);
        gains = gain(&answer, &where) > 0.0f;
    }
    return gains;
}

/* The least roughness, in hundredths, from which no engine gains; 0 where even 1 does. */
static float least_roughness(const WeftDoctor *doctor, const Cloth *cloth, const Answer answers[READERS]) {
    int low = (int)(cloth->roughness * 100.0f), high = 100;
    if (gains_anywhere(doctor, cloth, 1.0f, answers)) return 0.0f;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (gains_anywhere(doctor, cloth, (float)middle / 100.0f, answers))
            low = middle;
        else
            high = middle;
    }
    return (float)high / 100.0f;
}

/* E of the white sheen by itself under a profile: the slot's lobe, to 1e-4, times what the profile puts on
 * it. */
static float sheen_albedo(const char *profile, float roughness, float cosine) {
    Material material = material_default("");
    for (int c = 0; c < 3; c++) {
        material.inputs[INPUT_sheen_color].value[c] = 1.0f;
        material.inputs[INPUT_base_color].value[c] = 0.0f;
    }
    material.inputs[INPUT_sheen_roughness].value[0] = roughness;
    material.choices[CHOICE_profile] = choice_find(CHOICE_profile, profile);
    Surface surface = frame_surface(material_plain(&material));
    Choices choices = material_choices(&material);
    Stack stack;
    const Dir o = dir(sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
    stack_make(&stack, &surface, &choices, (TableRef){.kind = TABLE_NONE}, o);
    return albedo_quadrature(&stack.sheen.lobe, o, 1e-4).f0 * stack.sheen.f0.r;
}

/* The engines of a mask by name, "three, babylon". */
static const char *engine_names(unsigned engines, char text[128]) {
    text[0] = 0;
    for (int r = 0; doctor_readers[r]; r++)
        if (engines & doctor_engine(doctor_readers[r]))
            snprintf(text + strlen(text), 128 - strlen(text), "%s%s", text[0] ? ", " : "", doctor_readers[r]);
    return text;
}

static double degrees(float cosine) { return 57.2957795 * acos((double)cosine); }

static void tell_gain(WeftDoctor *doctor, const Cloth *cloth, unsigned engines, int worst,
                      const Answer answers[READERS], int where) {
    static const char path[] = "extensions/KHR_materials_sheen/sheenRoughnessFactor";
    bool textured = json_object_get(cloth->sheen, "sheenRoughnessTexture") != NULL;
    float least = least_roughness(doctor, cloth, answers);
    bool mends = least > 0.0f && !textured, given = json_object_get(cloth->sheen, "sheenRoughnessFactor");
    const Repair repair = {.act = REPAIR_NUMBER, .numbers = {(double)least}, .count = 1};
    float alone = sheen_albedo(doctor_readers[worst], cloth->roughness, cosines[where]);
    doctor_found(doctor, WEFT_FINDING_SHEEN_GAINS, (Place){WEFT_OF_MATERIAL, cloth->index, path}, engines,
                 (double)answers[worst].with[where], mends ? &repair : NULL,
                 "at sheen roughness %.2g%s the material returns %.3g times the light it receives, seen at "
                 "%.0f degrees in %s "
                 "(without the sheen %.3g; its white sheen alone returns %.3g): rims glow",
                 (double)cloth->roughness, given ? "" : " (it is left out, and then is 0)",
                 (double)answers[worst].with[where], degrees(cosines[where]), doctor_readers[worst],
                 (double)answers[worst].without[where], (double)alone);
    if (mends)
        doctor_advise(
            doctor,
            "raise sheenRoughnessFactor to %.2g, or darken the colour: from there on no engine returns more "
            "than it receives",
            (double)least);
    else if (textured && least > 0.0f)
        doctor_advise(doctor,
                      "brighten the alpha of sheenRoughnessTexture, to a mean of %.2g times its factor",
                      (double)least);
    else
        doctor_advise(doctor, "darken sheenColorFactor: no roughness helps a sheen this bright on this base");
}

static void check_gain(WeftDoctor *doctor, const Cloth *cloth, const Answer answers[READERS]) {
    unsigned engines = 0;
    int worst = -1, where = 0;
    float most = 0.0f;
    for (int r = 0; r < READERS; r++) {
        int at = 0;
        float over = gain(&answers[r], &at);
        if (over > 0.0f) engines |= doctor_engine(doctor_readers[r]);
        if (over <= most) continue;
        most = over;
        worst = r;
        where = at;
    }
    if (worst >= 0) tell_gain(doctor, cloth, engines, worst, answers, where);
}

/* Where the cloth is less than half as bright as it would be without a sheen. */
static void check_dark(WeftDoctor *doctor, const Cloth *cloth, const Answer answers[READERS]) {
    unsigned engines = 0;
    float least = 0.5f;
    int worst = -1, where = 0;
    for (int r = 0; r < READERS; r++)
        for (int k = 0; k < COSINES; k++) {
            float ratio = answers[r].light_with[k] / fmaxf(answers[r].light_without[k], 1e-6f);
            if (!(ratio < 0.5f) || answers[r].light_without[k] < 0.01f) continue;
            engines |= doctor_engine(doctor_readers[r]);
            if (ratio >= least) continue;
            least = ratio;
            worst = r;
            where = k;
        }
    if (worst < 0) return;
    char names[128];
    doctor_found(
        doctor, WEFT_FINDING_SHEEN_DARKENS,
        (Place){WEFT_OF_MATERIAL, cloth->index, "extensions/KHR_materials_sheen"}, engines, (double)least,
        NULL,
        "seen at %.0f degrees in %s the cloth has %.2g of the light it would have without its sheen: what is "
        "taken "
        "from the base for the sheen, in every channel alike, is more than the sheen gives (so in %s)",
        degrees(cosines[where]), doctor_readers[worst], (double)least, engine_names(engines, names));
    doctor_advise(
        doctor,
        "make the sheen's colour less saturated, or its roughness larger, if a dark rim is not meant");
}

/* The same sheen by itself, at 60 degrees. */
static void check_differ(WeftDoctor *doctor, const Cloth *cloth) {
    const float cosine = 0.5f, limit = 1.5f;
    float e[READERS], low = INFINITY, high = 0.0f;
    int lowest = 0, highest = 0;
    for (int r = 0; r < READERS; r++) {
        e[r] = sheen_albedo(doctor_readers[r], cloth->roughness, cosine);
        if (e[r] < low) low = e[lowest = r];
        if (e[r] > high) high = e[highest = r];
    }
    if (!(high > limit * low)) return;
    doctor_found(
        doctor, WEFT_FINDING_ENGINES_DIFFER,
        (Place){WEFT_OF_MATERIAL, cloth->index, "extensions/KHR_materials_sheen"},
        doctor_engine(doctor_readers[lowest]) | doctor_engine(doctor_readers[highest]), (double)(high / low),
        NULL, "at sheen roughness %.2g the sheen is %.2g times as bright in %s as in %s, seen at 60 degrees",
        (double)cloth->roughness, (double)(high / low), doctor_readers[highest], doctor_readers[lowest]);
    doctor_advise(
        doctor,
        "take a roughness of 0.5 or more, where the engines' lobes are near each other, or look at it in "
        "each: --profile %s, --profile %s",
        doctor_readers[highest], doctor_readers[lowest]);
}

void check_energy(WeftDoctor *doctor, const Cloth *cloth) {
    Answer answers[READERS];
    if (!cloth_shows(cloth) || doctor_part(cloth->json, "extensions/KHR_materials_unlit")) return;
    for (int r = 0; r < READERS; r++) answers[r] = ask(doctor, cloth, cloth->roughness, r, NULL);
    check_gain(doctor, cloth, answers);
    check_dark(doctor, cloth, answers);
    check_differ(doctor, cloth);
}
