/* doctor_energy.c - what a sheen does with light under each engine that reads glTF, measured on what renders
 * there
 *
 * The material is taken with the means of its textures. E is the share of light that comes back, all of it
 * towards one cosine: weft_reflection_albedo of the whole material; and of its sheen alone, white, by
 * quadrature. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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

/* What a material is to a reflection: its numbers, without its textures. */
typedef struct Key {
    float values[WEFT_INPUTS_MAX][3];
    int choices[WEFT_CHOICES_MAX];
} Key;

/* What was measured of a material: it holds for all that have the same numbers. */
struct Energy {
    Key key;
    Answer answers[READERS];
    float at_60[READERS]; /* E of the white sheen alone, at 60 degrees */
    float least; /* the roughness from which no engine gains, as least_roughness has it; < 0: not asked */
    float alone; /* E of the white sheen alone in the engine that gains most, where it does; set with least */
};

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

/* Whether an engine gains at a roughness in hundredths. */
static bool gains_at(const WeftDoctor *doctor, const Cloth *cloth, int hundredths, int reader,
                     const Answer *known) {
    Answer answer = ask(doctor, cloth, (float)hundredths / 100.0f, reader, known);
    int where;
    return gain(&answer, &where) > 0.0f;
}

/* The least roughness, in hundredths, from which no engine gains; 0 where even 1 does. An engine gains less
 * the rougher a sheen is, so that each is halved only above where those before it end. */
static float least_roughness(const WeftDoctor *doctor, const Cloth *cloth, const Answer answers[READERS]) {
    const int start = (int)(cloth->roughness * 100.0f);
    int least = start, where;
    for (int r = 0; r < READERS; r++) {
        int low = least, high = 100;
        bool gains = least == start ? gain(&answers[r], &where) > 0.0f
                                    : gains_at(doctor, cloth, least, r, &answers[r]);
        if (!gains) continue;
        if (gains_at(doctor, cloth, high, r, &answers[r])) return 0.0f;
        while (high - low > 1) {
            int middle = (low + high) / 2;
            if (gains_at(doctor, cloth, middle, r, &answers[r]))
                low = middle;
            else
                high = middle;
        }
        least = high;
    }
    return (float)least / 100.0f;
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

static void tell_gain(WeftDoctor *doctor, const Cloth *cloth, unsigned engines, int worst, Energy *energy,
                      int where) {
    static const char path[] = "extensions/KHR_materials_sheen/sheenRoughnessFactor";
    bool textured = json_object_get(cloth->sheen, "sheenRoughnessTexture") != NULL;
    const Answer *answers = energy->answers;
    if (energy->least < 0.0f) {
        energy->least = least_roughness(doctor, cloth, answers);
        energy->alone = sheen_albedo(doctor_readers[worst], cloth->roughness, cosines[where]);
    }
    float least = energy->least;
    bool mends = least > 0.0f && !textured, given = json_object_get(cloth->sheen, "sheenRoughnessFactor");
    const Repair repair = {.act = REPAIR_NUMBER, .numbers = {(double)least}, .count = 1};
    doctor_found(doctor, WEFT_FINDING_SHEEN_GAINS, (Place){WEFT_OF_MATERIAL, cloth->index, path}, engines,
                 (double)answers[worst].with[where], mends ? &repair : NULL,
                 "at sheen roughness %.2g%s the material returns %.3g times the light it receives, seen at "
                 "%.0f degrees in %s "
                 "(without the sheen %.3g; its white sheen alone returns %.3g): rims glow",
                 (double)cloth->roughness, given ? "" : " (it is left out, and then is 0)",
                 (double)answers[worst].with[where], degrees(cosines[where]), doctor_readers[worst],
                 (double)answers[worst].without[where], (double)energy->alone);
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

static void check_gain(WeftDoctor *doctor, const Cloth *cloth, Energy *energy) {
    const Answer *answers = energy->answers;
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
    if (worst >= 0) tell_gain(doctor, cloth, engines, worst, energy, where);
}

/* Where the cloth is less than half as bright as it would be without a sheen. */
static void check_dark(WeftDoctor *doctor, const Cloth *cloth, const Answer *answers) {
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
static void check_differ(WeftDoctor *doctor, const Cloth *cloth, const float e[READERS]) {
    const float limit = 1.5f;
    float low = INFINITY, high = 0.0f;
    int lowest = 0, highest = 0;
    for (int r = 0; r < READERS; r++) {
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

static bool key_of(const WeftDoctor *doctor, const Cloth *cloth, Key *key) {
    WeftMaterial material;
    if (!numbers_of(doctor, cloth, cloth->color, cloth->roughness, doctor_readers[0], &material))
        return false;
    memset(key, 0, sizeof *key);
    for (int k = 0; k < WEFT_INPUTS_MAX; k++)
        memcpy(key->values[k], material.inputs[k].value, sizeof key->values[k]);
    memcpy(key->choices, material.choices, sizeof key->choices);
    return true;
}

/* What is known of a material with these numbers; NULL: nothing yet. */
static Energy *energy_find(const WeftDoctor *doctor, const Key *key) {
    for (int k = 0; k < doctor->energy_count; k++)
        if (memcmp((const char *)&doctor->energies[k].key, (const char *)key, sizeof *key) == 0)
            return &doctor->energies[k];
    return NULL;
}

/* Room for one more, in the list; NULL where memory is short. */
static Energy *energy_add(WeftDoctor *doctor) {
    if (doctor->energy_count == doctor->energy_room) {
        size_t room = doctor->energy_room ? 2 * (size_t)doctor->energy_room : 8;
        Energy *energies = realloc_array(doctor->energies, room, sizeof *energies);
        doctor->failed |= !energies;
        if (!energies) return NULL;
        doctor->energies = energies;
        doctor->energy_room = (int)room;
    }
    return &doctor->energies[doctor->energy_count++];
}

/* Measured once for all that have the same numbers: some sixty quadratures of the whole material. */
static Energy *energy_of(WeftDoctor *doctor, const Cloth *cloth) {
    Key key;
    if (!key_of(doctor, cloth, &key)) return NULL;
    Energy *energy = energy_find(doctor, &key);
    if (energy) return energy;
    energy = energy_add(doctor);
    if (!energy) return NULL;
    *energy = (Energy){.key = key, .least = -1.0f};
    for (int r = 0; r < READERS; r++) {
        energy->answers[r] = ask(doctor, cloth, cloth->roughness, r, NULL);
        energy->at_60[r] = sheen_albedo(doctor_readers[r], cloth->roughness, 0.5f);
    }
    return energy;
}

void check_energy(WeftDoctor *doctor, const Cloth *cloth) {
    if (!cloth_shows(cloth) || doctor_part(cloth->json, "extensions/KHR_materials_unlit")) return;
    Energy *energy = energy_of(doctor, cloth);
    if (!energy) return;
    check_gain(doctor, cloth, energy);
    check_dark(doctor, cloth, energy->answers);
    check_differ(doctor, cloth, energy->at_60);
}
