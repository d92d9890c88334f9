/* doctor_energy.c - the energy that a sheen adds or removes in each engine that reads it, by the engine's profile
 *
 * A texture counts as its mean. E(wo) is the directional albedo of the material. The layer rules of these engines
 * dim the base by a factor, keep, that depends on the cosines of wo and wi alone. Hence
 *
 *   E(wo) = over + sum_z keep(wo, z) base(wo, z) + c E_sheen(wo),  z: slices of cos_i
 *
 * where `over` is the light of the coat and c the colour of the sheen. The base is sampled once for a material and an
 * engine, slot by slot, and serves every roughness of the sheen. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/bsdf/halton.h"
#include "measure/bsdf/material_key.h"
#include "measure/doctor/doctor.h"
#include "scene/material/material_numbers.h"
#include "scene/record/material_at.h"
#include "shading/catalogue/albedo.h"
#include "shading/material/choice.h"
#include "shading/stack/frame.h"
#include "weft/material.h"

/* From 37 to 87 degrees off the normal; steeper cloth covers next to no pixels. */
static const float cosines[] = {0.8f, 0.5f, 0.3f, 0.2f, 0.1f, 0.05f};
/* AT_60: index of 60 degrees. READERS: length of doctor_readers. */
enum { COSINES = sizeof cosines / sizeof *cosines, AT_60 = 1, READERS = 5 };

/* The measured albedo E of a material in one engine at each of `cosines`, with its sheen and without. */
typedef struct Answer {
    float with[COSINES], without[COSINES]; /* of the strongest channel */
    float luminance_with[COSINES], luminance_without[COSINES];
    float alone[COSINES]; /* E of the white sheen by itself */
} Answer;

/* The measured energy of a material. It holds for all materials with the same numbers. */
struct Energy {
    MaterialKey key;
    Answer answers[READERS];
    float least; /* roughness at and above which no engine gains energy (least_roughness) */
};

/* Makes the material of a cloth, with textures replaced by their means, this sheen and a profile. Returns false if the
 * material cannot be read. */
static bool mean_material(const WeftDoctor *doctor, const Cloth *cloth, const float color[3], float roughness,
                          const char *profile, WeftMaterial *out) {
    WeftError error;
    if (weft_scene_material(doctor->scene, cloth->index, out, &error) != WEFT_OK) return false;
    weft_material_set_number(out, INPUT_base_color, cloth->base, NULL);
    weft_material_set_number(out, INPUT_metallic, &cloth->metallic, NULL);
    weft_material_set_number(out, INPUT_sheen_color, color, NULL);
    weft_material_set_number(out, INPUT_sheen_roughness, &roughness, NULL);
    out->choices[CHOICE_profile] = choice_find(CHOICE_profile, profile);
    return true;
}

enum { SLICES = 24, DRAWS = 128 }; /* slices of cos_i; samples of a slot */

/* The albedo of a material without its sheen, seen at one cosine. */
typedef struct Base {
    float over[3];          /* of the coat */
    float below[SLICES][3]; /* of the slots below the sheen, by slices of cos_i */
    float z[SLICES];        /* mean cos_i of a slice */
} Base;

/* A material in one engine. */
typedef struct Case {
    Surface bare; /* without its sheen */
    Choices choices;
    Dir along; /* x of the shading frame, in tangent space */
    Base base[COSINES];
} Case;

/* Tables that all materials share: E of white sheens at steps of 0.01 in roughness, and the last table of E that a
 * layer rule has read. */
struct EnergyTables {
    float white[READERS][101][COSINES]; /* 0: not computed yet */
    AlbedoTable layer_table;
};

/* Returns, in the shading frame, the direction to the viewer at the k-th cosine, in the plane of normal and tangent. */
static Dir viewer_at(Dir along, int k) {
    const float z = cosines[k], s = sqrtf(1.0f - z * z);
    return dir(s * along.x, -s * along.y, z);
}

/* Returns the surface of a case with a sheen, as an input of stack_make. */
static Surface surface_of(const Case *self, const float color[3], float roughness) {
    Surface surface = self->bare;
    surface.sheen_color = (Rgb){color[0], color[1], color[2]};
    surface.sheen_roughness = roughness;
    return surface;
}

/* Prepares the case with a sheen, seen from o. */
static void case_view(const Case *self, const float color[3], float roughness, TableRef table, Dir o, SeenStack *seen) {
    const Surface surface = surface_of(self, color, roughness);
    seen_make(seen, &surface, &self->choices, table, o);
}

/* Adds the light that one slot of the bare material reflects, by importance sampling of that slot. */
static void base_add(const SeenStack *whole, int slot, Base *base) {
    SeenStack one = *whole;
    float *const picks[] = {&one.view.select_p.diffuse, &one.view.select_p.specular, &one.view.select_p.coat};
    const Slots only[] = {slots_of(true, false, false, false, false), slots_of(false, true, false, false, false),
                          slots_of(false, false, false, true, false)};
    if (!(*picks[slot] > 0.0f)) return;
    one.view.select_p = (Scales){0};
    *picks[slot] = 1.0f;
    int counts[SLICES] = {0};
    double z_sums[SLICES] = {0.0};
    for (int d = 0; d < DRAWS; d++) {
        const Dir i = seen_sample(&one, ((float)d + 0.5f) / DRAWS, (float)halton(d, 2));
        if (!(i.z > 0.0f)) continue;
        const StackValue value = stack_eval_of(&one.stack, &one.view, only[slot], i);
        if (!(value.pdf > 0.0f)) continue;
        const int slice = (int)fminf(i.z * SLICES, SLICES - 1);
        float *to = slot == 2 ? base->over : base->below[slice];
        const float weight = 1.0f / (value.pdf * DRAWS);
        to[0] += value.f_cos.r * weight, to[1] += value.f_cos.g * weight, to[2] += value.f_cos.b * weight;
        counts[slice]++;
        z_sums[slice] += (double)i.z;
    }
    for (int k = 0; k < SLICES; k++)
        if (counts[k]) base->z[k] = (float)(z_sums[k] / counts[k]);
}

/* Makes the case of a material under an engine. Choices in glTF's extras do not count, since engines do not read them.
 * Returns false if a number is not finite. */
static bool case_make(const WeftDoctor *doctor, const Cloth *cloth, int reader, Case *self) {
    static const float black[3] = {0.0f, 0.0f, 0.0f};
    WeftMaterial numbers, defaults;
    WeftError error;
    if (!mean_material(doctor, cloth, black, 0.0f, doctor_readers[reader], &numbers)) return false;
    weft_material_default(&defaults);
    defaults.choices[CHOICE_profile] = numbers.choices[CHOICE_profile];
    memcpy(numbers.choices, defaults.choices, sizeof numbers.choices);
    if (numbers_sound(&numbers, &error) != WEFT_OK) return false;
    const Material material = material_sound(&numbers);
    const Surface surface = material_plain(&material);
    *self = (Case){.bare = frame_surface(surface),
                   .choices = material_choices(&material),
                   .along = surface.anisotropy > 0.0f ? surface.anisotropy_direction : dir(1.0f, 0.0f, 0.0f)};
    for (int k = 0; k < COSINES; k++) {
        const Dir o = viewer_at(self->along, k);
        SeenStack bare;
        seen_make(&bare, &self->bare, &self->choices, (TableRef){.kind = TABLE_NONE}, o);
        for (int slot = 0; slot < 3; slot++) base_add(&bare, slot, &self->base[k]);
    }
    return true;
}

/* Returns the table of E that the layer rule reads, over all roughnesses; TABLE_NONE if the engine has a formula. */
static TableRef layer_table_of(EnergyTables *tables, const Case *self) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    const Dir n = dir(0.0f, 0.0f, 1.0f);
    SeenStack most, end;
    const Stack *stack = &most.stack;
    case_view(self, white, 1.0f, (TableRef){.kind = TABLE_NONE}, n, &most);
    if (!albedo_is_own(stack->albedo)) return (TableRef){.kind = TABLE_NONE};
    case_view(self, white, 0.0f, (TableRef){.kind = TABLE_NONE}, n, &end);
    const float low = fminf(end.stack.albedo_coord, stack->albedo_coord),
                high = fmaxf(end.stack.albedo_coord, stack->albedo_coord);
    if (!tables->layer_table.rows || !albedo_table_serves(&tables->layer_table, &stack->sheen.lobe, low, high, false))
        albedo_table_fill(&tables->layer_table, &stack->sheen.lobe, low, high, 0);
    return albedo_table_ref(&tables->layer_table);
}

/* Returns E of the white lobe at a roughness, interpolated between steps of 0.01, each integrated when first needed. */
static float white_albedo(EnergyTables *tables, const Case *self, int reader, float roughness, int k) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    const float at = fminf(fmaxf(roughness, 0.0f), 1.0f) * 100.0f;
    const int low = (int)fminf(at, 99.0f);
    float *memory[2] = {&tables->white[reader][low][k], &tables->white[reader][low + 1][k]};
    for (int end = 0; end < 2; end++) {
        if (*memory[end] > 0.0f) continue;
        const Dir o = viewer_at(self->along, k);
        SeenStack seen;
        case_view(self, white, (float)(low + end) / 100.0f, (TableRef){.kind = TABLE_NONE}, o, &seen);
        *memory[end] = albedo_quadrature(&seen.stack.sheen.lobe, o, 1e-4).f0;
    }
    return mix(*memory[0], *memory[1], at - (float)low);
}

/* Returns E of the white sheen alone under an engine: that of the lobe times the engine's own factors. */
static float sheen_albedo(EnergyTables *tables, const Case *self, int reader, float roughness, int k) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    SeenStack seen;
    case_view(self, white, roughness, (TableRef){.kind = TABLE_NONE}, viewer_at(self->along, k), &seen);
    return white_albedo(tables, self, reader, roughness, k) * seen.view.scale.sheen * seen.stack.sheen.f0.r;
}

static float luminance_of(const float e[3]) { return 0.2126f * e[0] + 0.7152f * e[1] + 0.0722f * e[2]; }

static float most_of(const float e[3]) { return fmaxf(e[0], fmaxf(e[1], e[2])); }

/* Computes the albedos of a case with a sheen of that colour and roughness. */
static Answer answer_of(EnergyTables *tables, const Case *self, int reader, const float color[3], float roughness) {
    const TableRef table = layer_table_of(tables, self);
    Answer answer;
    for (int k = 0; k < COSINES; k++) {
        const Base *base = &self->base[k];
        const Dir o = viewer_at(self->along, k);
        SeenStack seen;
        case_view(self, color, roughness, table, o, &seen);
        const Stack *stack = &seen.stack;
        const float e = white_albedo(tables, self, reader, roughness, k) * seen.view.scale.sheen;
        float with[3] = {base->over[0] + e * stack->sheen.f0.r, base->over[1] + e * stack->sheen.f0.g,
                         base->over[2] + e * stack->sheen.f0.b},
              without[3] = {base->over[0], base->over[1], base->over[2]};
        for (int slice = 0; slice < SLICES; slice++) {
            const float z = base->z[slice], *below = base->below[slice];
            if (!(z > 0.0f)) continue;
            const Rgb keep =
                stack_base_scale(stack, &seen.view, stack_albedo(stack, dir(sqrtf(1.0f - z * z), 0.0f, z)));
            with[0] += keep.r * below[0], with[1] += keep.g * below[1], with[2] += keep.b * below[2];
            for (int c = 0; c < 3; c++) without[c] += below[c];
        }
        answer.alone[k] = sheen_albedo(tables, self, reader, roughness, k);
        answer.with[k] = most_of(with), answer.without[k] = most_of(without);
        answer.luminance_with[k] = luminance_of(with), answer.luminance_without[k] = luminance_of(without);
    }
    return answer;
}

/* Returns the gain beyond 1 that the sheen causes, and where. Gain that an engine's base has without a sheen
 * does not count. `slack` allows for the error of the sampled base. */
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

static bool gains(const Answer *answer) {
    int where;
    return gain(answer, &where) > 0.0f;
}

/* Returns the least roughness, a multiple of 0.01, at and above which no engine gains energy. If none gains now, it is
 * the sheen's own, rounded down; if one gains even at roughness 1, it is 0. Gain falls with roughness, so the
 * bisection for each engine starts at the result for the engines before it. */
static float least_roughness(EnergyTables *tables, const Cloth *cloth, const Case cases[READERS],
                             const Answer answers[READERS]) {
    const int start = (int)(cloth->roughness * 100.0f);
    int least = start;
    for (int r = 0; r < READERS; r++) {
        if (least == start && !gains(&answers[r])) continue;
        const Answer first = answer_of(tables, &cases[r], r, cloth->color, (float)least / 100.0f);
        if (least != start && !gains(&first)) continue;
        int low = least, high = 101;
        while (high - low > 1) {
            const int middle = high > 100 ? 100 : (low + high) / 2;
            const Answer answer = answer_of(tables, &cases[r], r, cloth->color, (float)middle / 100.0f);
            if (!gains(&answer))
                high = middle;
            else if (middle == 100)
                return 0.0f;
            else
                low = middle;
        }
        least = high;
    }
    return (float)least / 100.0f;
}

/* Writes the names of the engines in a mask to text, as "three, babylon", and returns it. */
static const char *engine_names(unsigned engines, char text[128]) {
    text[0] = 0;
    for (int r = 0; doctor_readers[r]; r++)
        if (engines & doctor_engine(doctor_readers[r]))
            snprintf(text + strlen(text), 128 - strlen(text), "%s%s", text[0] ? ", " : "", doctor_readers[r]);
    return text;
}

static double degrees(float cosine) { return 57.2957795 * acos((double)cosine); }

static void report_gain(WeftDoctor *doctor, const Cloth *cloth, unsigned engines, int worst, const Energy *energy,
                        int where) {
    static const char path[] = "extensions/KHR_materials_sheen/sheenRoughnessFactor";
    bool textured = json_object_get(cloth->sheen, "sheenRoughnessTexture") != NULL;
    const Answer *answers = energy->answers;
    const float least = energy->least;
    bool helps = least > 0.0f && !textured, given = json_object_get(cloth->sheen, "sheenRoughnessFactor");
    const Repair repair = {.act = REPAIR_NUMBER, .numbers = {(double)least}, .count = 1};
    doctor_found(doctor, WEFT_FINDING_SHEEN_GAINS, (Place){WEFT_OF_MATERIAL, cloth->index, path}, engines,
                 (double)answers[worst].with[where], helps ? &repair : NULL,
                 "at sheen roughness %.2g%s the material returns %.3g times the light it receives, seen at "
                 "%.0f degrees in %s "
                 "(without the sheen %.3g; its white sheen alone returns %.3g): rims glow",
                 (double)cloth->roughness, given ? "" : " (it is left out, and then is 0)",
                 (double)answers[worst].with[where], degrees(cosines[where]), doctor_readers[worst],
                 (double)answers[worst].without[where], (double)answers[worst].alone[where]);
    if (helps)
        doctor_advise(doctor,
                      "raise sheenRoughnessFactor to %.2g, or darken the colour: from there on no engine returns more "
                      "than it receives",
                      (double)least);
    else if (textured && least > 0.0f)
        doctor_advise(doctor, "brighten the alpha of sheenRoughnessTexture, to a mean of %.2g times its factor",
                      (double)least);
    else
        doctor_advise(doctor, "darken sheenColorFactor: no roughness helps a sheen this bright on this base");
}

static void check_gain(WeftDoctor *doctor, const Cloth *cloth, const Energy *energy) {
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
    if (worst >= 0) report_gain(doctor, cloth, engines, worst, energy, where);
}

/* Finds cloth that is less than half as bright as it would be without its sheen. */
static void check_dark(WeftDoctor *doctor, const Cloth *cloth, const Answer *answers) {
    unsigned engines = 0;
    float least = 0.5f;
    int worst = -1, where = 0;
    for (int r = 0; r < READERS; r++)
        for (int k = 0; k < COSINES; k++) {
            float ratio = answers[r].luminance_with[k] / fmaxf(answers[r].luminance_without[k], 1e-6f);
            if (!(ratio < 0.5f) || answers[r].luminance_without[k] < 0.01f) continue;
            engines |= doctor_engine(doctor_readers[r]);
            if (ratio >= least) continue;
            least = ratio;
            worst = r;
            where = k;
        }
    if (worst < 0) return;
    char names[128];
    doctor_found(doctor, WEFT_FINDING_SHEEN_DARKENS,
                 (Place){WEFT_OF_MATERIAL, cloth->index, "extensions/KHR_materials_sheen"}, engines, (double)least,
                 NULL,
                 "seen at %.0f degrees in %s the cloth has %.2g of the light it would have without its sheen: what is "
                 "taken "
                 "from the base for the sheen, in every channel alike, is more than the sheen gives (so in %s)",
                 degrees(cosines[where]), doctor_readers[worst], (double)least, engine_names(engines, names));
    doctor_advise(doctor,
                  "make the sheen's colour less saturated, or its roughness larger, if a dark rim is not meant");
}

/* Compares the sheen alone in the engines, at 60 degrees. */
static void check_differ(WeftDoctor *doctor, const Cloth *cloth, const Answer answers[READERS]) {
    const float limit = 1.5f;
    float low = INFINITY, high = 0.0f;
    int lowest = 0, highest = 0;
    for (int r = 0; r < READERS; r++) {
        const float e = answers[r].alone[AT_60];
        if (e < low) low = e, lowest = r;
        if (e > high) high = e, highest = r;
    }
    if (!(high > limit * low)) return;
    doctor_found(doctor, WEFT_FINDING_ENGINES_DIFFER,
                 (Place){WEFT_OF_MATERIAL, cloth->index, "extensions/KHR_materials_sheen"},
                 doctor_engine(doctor_readers[lowest]) | doctor_engine(doctor_readers[highest]), (double)(high / low),
                 NULL, "at sheen roughness %.2g the sheen is %.2g times as bright in %s as in %s, seen at 60 degrees",
                 (double)cloth->roughness, (double)(high / low), doctor_readers[highest], doctor_readers[lowest]);
    doctor_advise(doctor,
                  "take a roughness of 0.5 or more, where the engines' lobes are near each other, or look at it in "
                  "each: --profile %s, --profile %s",
                  doctor_readers[highest], doctor_readers[lowest]);
}

static bool key_of(const WeftDoctor *doctor, const Cloth *cloth, MaterialKey *key) {
    WeftMaterial material;
    if (!mean_material(doctor, cloth, cloth->color, cloth->roughness, doctor_readers[0], &material)) return false;
    *key = material_key(&material);
    return true;
}

/* Returns the measured energy of a material with these numbers, or NULL if it is not measured yet. */
static const Energy *energy_find(const WeftDoctor *doctor, const MaterialKey *key) {
    for (int k = 0; k < doctor->energy_count; k++)
        if (material_key_same(&doctor->energies[k].key, key)) return &doctor->energies[k];
    return NULL;
}

/* Adds an Energy to the list of the doctor; returns NULL if memory is short. */
static Energy *energy_add(WeftDoctor *doctor) {
    if (doctor->energy_count == doctor->energy_capacity) {
        size_t capacity = doctor->energy_capacity ? 2 * (size_t)doctor->energy_capacity : 8;
        Energy *energies = realloc_array(doctor->energies, capacity, sizeof *energies);
        doctor->failed |= !energies;
        if (!energies) return NULL;
        doctor->energies = energies;
        doctor->energy_capacity = (int)capacity;
    }
    return &doctor->energies[doctor->energy_count++];
}

/* Measures a material in all engines; returns false if a number is not finite. */
static bool energy_measure(const WeftDoctor *doctor, const Cloth *cloth, Energy *energy) {
    EnergyTables *tables = doctor->energy_tables;
    Case cases[READERS];
    for (int r = 0; r < READERS; r++) {
        if (!case_make(doctor, cloth, r, &cases[r])) return false;
        energy->answers[r] = answer_of(tables, &cases[r], r, cloth->color, cloth->roughness);
    }
    energy->least = least_roughness(tables, cloth, cases, energy->answers);
    return true;
}

/* Returns the energy of a material, measured once for all with the same numbers; NULL if that fails. */
static const Energy *energy_of(WeftDoctor *doctor, const Cloth *cloth) {
    MaterialKey key;
    if (!key_of(doctor, cloth, &key)) return NULL;
    const Energy *measured = energy_find(doctor, &key);
    if (measured) return measured;
    if (!doctor->energy_tables) doctor->energy_tables = alloc_array(1, sizeof *doctor->energy_tables);
    doctor->failed |= !doctor->energy_tables;
    Energy energy = {.key = key};
    if (!doctor->energy_tables || !energy_measure(doctor, cloth, &energy)) return NULL;
    Energy *kept = energy_add(doctor);
    if (kept) *kept = energy;
    return kept;
}

float doctor_albedo(WeftDoctor *doctor, const Cloth *cloth, int reader, float cosine) {
    const Energy *energy = energy_of(doctor, cloth);
    for (int k = 0; energy && k < COSINES; k++)
        if (fabsf(cosines[k] - cosine) < 1e-6f) return energy->answers[reader].with[k];
    return -1.0f;
}

void check_energy(WeftDoctor *doctor, const Cloth *cloth) {
    if (!cloth_shows(cloth) || doctor_part(cloth->json, "extensions/KHR_materials_unlit")) return;
    const Energy *energy = energy_of(doctor, cloth);
    if (!energy) return;
    check_gain(doctor, cloth, energy);
    check_dark(doctor, cloth, energy->answers);
    check_differ(doctor, cloth, energy->answers);
}
