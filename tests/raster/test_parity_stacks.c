/* All that a renderer asks of a surface, over random directions and over all that its numbers may be: layer
 * rules, stacks of every workflow and profile, dust
 *
 * Labels: slow unsanitized */
#include "raster/parity.h"

#include "shading/catalogue/engine_tables.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/material/choice.h"
#include "shading/material/dust.h"

static void put_layer(Text *text, int which) {
    text_include(text, "shading/stack/layer.h");
    text_line(text, "\nconst int LAYER = %d;", which);
}

/* A colour, and E of a lobe that may reflect three times what it receives. */
static void fill_layer(Random *random, int which, float *row) {
    row[0] = any_value(random, 0.0f, 1.0f, 0.0f, 1000.0f);
    for (int k = 1; k < 4; k++) row[k] = any_value(random, 0.0f, 1.0f, 0.0f, 3.0f);
}

static void answer_layer(int which, const float *row, float *answers) {
    answers[0] = layer_base(which, row[0], row[1], row[2], row[3]);
}

static void layer_rules_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    out0.x = layer_base(LAYER, in0.x, in0.y, in0.z, in0.w);\n",
        .inputs = 1,
        .answers = "n",
        .put = put_layer,
        .fill = fill_layer,
        .answer = answer_layer,
    };
    need_gpu();
    bool good = true;
    for (int k = 0; weft_layer_name(k); k++) good &= agree(&model, k, weft_layer_name(k));
    assert_true(good);
}

/* A surface and its choices are numbers in a row behind the pair of directions. */
enum { SURFACE_AT = 8, CHOICES_AT = SURFACE_AT + sizeof(Surface) / sizeof(float) };
enum { STACK_INPUTS = (CHOICES_AT + CHOICE_COUNT + 3) / 4 };
_Static_assert((int)STACK_INPUTS == 29, "the body of stacks_agree reads as many");

/* Functions that make a Surface and Choices of the row. */
static void put_readers(Text *text) {
    int at = SURFACE_AT;
    text_line(text, "\nfloat row[%d];\n\nSurface row_surface() {\n    Surface s;", 4 * STACK_INPUTS);
#define READ_SCALAR(name) text_line(text, "    s.%s = row[%d];", name, at), at += 1
#define READ_THREE(name, make)                                                                                         \
    text_line(text, "    s.%s = %s(row[%d], row[%d], row[%d]);", name, make, at, at + 1, at + 2), at += 3
#define READ_COLOR(name)                                                                   READ_THREE(name, "rgb")
#define READ_ANGLE(name)                                                                   READ_SCALAR(name)
#define READ_NORMAL(name)                                                                  READ_THREE(name, "dir")
#define READ_DIRECTION(name)                                                               READ_THREE(name, "dir")
#define READ_INPUT(kind, name, label, initial, low, high, hard_low, hard_high, role, help) READ_##kind(#name);
    SURFACE_INPUTS(READ_INPUT)
    text_line(text, "    return s;\n}\n\nChoices row_choices() {\n    Choices c;");
#define READ_CHOICE(name, help) text_line(text, "    c." #name " = int(row[%d]);", at++);
    SURFACE_CHOICES(READ_CHOICE)
    text_line(text, "    return c;\n}");
}

static int workflow_count(void) {
    int count = 0;
    while (weft_workflow_name(count)) count++;
    return count;
}

/* The choice that is made for stacks of that number: a workflow, behind them a profile, behind them any. */
static const char *stack_name(int which) {
    int workflows = workflow_count();
    if (which < workflows) return weft_workflow_name(which);
    return weft_profile_name(which - workflows + 1); /* profile 0 is none */
}

static void put_stack(Text *text, int which) {
    static const int engines[] = {ENGINE_FILAMENT_SHEEN, ENGINE_FILAMENT_GGX, ENGINE_BABYLON_SHEEN, ENGINE_BABYLON_GGX,
                                  ENGINE_THREE_GGX};
    put_all_lobes(text, which);
    text_lobe_tables(text);
    text_engine_tables(text, engines, ENGINE_COUNT);
    text_include(text, "shading/material/stack_value.h");
    put_readers(text);
}

static float *fill_scalar(Random *random, const float range[4], float *at) {
    *at = any_value(random, range[0], range[1], range[2], range[3]);
    return at + 1;
}
static float *fill_angle(Random *random, const float degrees[4], float *at) {
    at = fill_scalar(random, degrees, at);
    at[-1] *= PI_FLOAT / 180.0f;
    return at;
}
static float *fill_color(Random *random, const float range[4], float *at) {
    for (int c = 0; c < 3; c++) at = fill_scalar(random, range, at);
    return at;
}
static float *fill_normal(Random *random, const float range[4], float *at) {
    Dir n = random_unit(random) < 0.5f ? dir(0.0f, 0.0f, 1.0f) : any_direction(random);
    at[0] = n.x, at[1] = n.y, at[2] = n.z;
    return at + 3;
}
static float *fill_direction(Random *random, const float range[4], float *at) {
    Dir d = direction(0.5 * PI_DOUBLE, 2.0 * PI_DOUBLE * (double)random_unit(random));
    at[0] = d.x, at[1] = d.y, at[2] = 0.0f;
    return at + 3;
}

static int any_choice(Random *random, ChoiceId choice) {
    int count = 0;
    while (choice_id(choice, count)) count++;
    int k = (int)(random_bits(random) % (uint32_t)(count + 1)) - 1;
    bool lobe = choice == CHOICE_diffuse || choice == CHOICE_sheen_lobe;
    return k >= 0 && lobe && !(choice_fits(choice, k) && on_gpu(k)) ? CHOICE_AUTO : k;
}

/* Inputs that came later have random numbers of their own, so that all before keep theirs. */
static bool came_later(InputId input) {
    return input == INPUT_diffuse_roughness || input == INPUT_retroreflection || input == INPUT_fuzz ||
           input == INPUT_fuzz_color || input == INPUT_fuzz_roughness || input == INPUT_coat_ior ||
           input == INPUT_coat_color || input == INPUT_coat_darkening || input == INPUT_coat_anisotropy ||
           input == INPUT_coat_anisotropy_direction || input == INPUT_transmission || input == INPUT_thickness ||
           input == INPUT_attenuation_color || input == INPUT_attenuation_distance;
}

static void fill_stack(Random *random, int which, float *row) {
    fill_pair(random, row);
    Random later;
    memcpy(&later.state, row, sizeof later.state); /* of two numbers of this row */
    float *at = row + SURFACE_AT;
#define fill_SCALAR    fill_scalar
#define fill_ANGLE     fill_angle
#define fill_COLOR     fill_color
#define fill_NORMAL    fill_normal
#define fill_DIRECTION fill_direction
#define FILL_INPUT(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                             \
    at = fill_##kind(came_later(INPUT_##name) ? &later : random, (const float[]){low, high, hard_low, hard_high}, at);
    SURFACE_INPUTS(FILL_INPUT)
    for (int choice = 0; choice < CHOICE_COUNT; choice++)
        at[choice] = (float)(stack_name(which) ? CHOICE_AUTO : any_choice(random, (ChoiceId)choice));
    int workflows = workflow_count();
    if (which < workflows)
        at[CHOICE_workflow] = (float)which;
    else if (stack_name(which))
        at[CHOICE_profile] = (float)(which - workflows + 1);
}

static void answer_stack(int which, const float *row, float *answers) {
    Surface s;
    Choices c;
    SeenStack seen;
    memcpy(&s, row + SURFACE_AT, sizeof s);
    const float *at = row + CHOICES_AT;
#define ANSWER_CHOICE(name, help) c.name = (int)*at++;
    SURFACE_CHOICES(ANSWER_CHOICE)
    Angles a = row_angles(row);
    seen_make(&seen, &s, &c, lobe_table_charlie_neubelt(), a.o);
    const StackView *w = &seen.view;
    Angles coat = angles_between(w->coat_o, stack_to_coat(&seen.stack, a.i));
    StackValue v = stack_value(&seen.stack, w, &a, &coat), t = stack_transmitted(&seen.stack, w, &a);
    v.f_cos = rgb_add(v.f_cos, t.f_cos);
    v.pdf += t.pdf;
    const float all[ANSWERS] = {
        v.f_cos.r,         v.f_cos.g,       v.f_cos.b, v.pdf, w->select_p.diffuse, w->select_p.specular,
        w->select_p.sheen, w->select_p.coat};
    memcpy(answers, all, sizeof all);
}

#define ROW(k) "        row[4 * " #k " + c] = in" #k "[c];\n"

/* All that a renderer asks of a surface: with each workflow and each profile, and with choices of all kinds
 * mixed. */
static void stacks_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    for (int c = 0; c < 4; c++) {\n" ROW(2) ROW(3) ROW(4) ROW(5) ROW(6) ROW(7) ROW(8) ROW(9) ROW(10)
            ROW(11) ROW(12) ROW(13) ROW(14) ROW(15) ROW(16) ROW(17) ROW(18) ROW(19) ROW(20) ROW(21) ROW(22) ROW(23)
                ROW(24) ROW(25) ROW(26) ROW(27)
                    ROW(28) "    }\n" ANGLES "    Stack m;\n    surface_stack(m, row_surface(), row_choices(), "
                            "lobe_table_charlie_neubelt());\n    StackView w;\n    stack_view(m, o, w);\n"
                            "    Angles coat = angles_between(w.coat_o, stack_to_coat(m, a.i));\n"
                            "    StackValue v = stack_value(m, w, a, coat), t = stack_transmitted(m, w, a);\n"
                            "    v.f_cos = rgb_add(v.f_cos, t.f_cos);\n    v.pdf += t.pdf;\n"
                            "    out0 = vec4(v.f_cos.r, v.f_cos.g, v.f_cos.b, v.pdf);\n"
                            "    out1 = vec4(w.select_p.diffuse, w.select_p.specular, w.select_p.sheen, "
                            "w.select_p.coat);\n",
        .inputs = STACK_INPUTS,
        .answers = "nnnnnnnn",
        .put = put_stack,
        .fill = fill_stack,
        .answer = answer_stack,
    };
    need_gpu();
    Programs programs = make_programs(&model, 0, "stacks", NULL);
    bool good = true;
    int which = 0;
    for (; stack_name(which); which++) good &= programs_agree(&programs, which, stack_name(which), 0.0);
    good &= programs_agree(&programs, which, "any choices", MIXED_SHARE);
    free_programs(&programs);
    assert_true(good);
}

static void put_dust(Text *text, int which) { text_include(text, "shading/material/dust.h"); }

/* in0: normal, tilt.  in1: place, scale.  in2: direction, falloff, amount.  in3: strength of the noise. */
static void fill_dust(Random *random, int which, float *row) {
    Dir n = any_direction(random), to = any_direction(random);
    float r = 1.0f / sqrtf(max(to.x * to.x + to.y * to.y, 1e-12f));
    row[0] = n.x, row[1] = random_unit(random) < 0.25f ? -n.z : n.z, row[2] = n.y;
    row[3] = any_value(random, 0.0f, 1.5f, 0.0f, PI);
    for (int k = 4; k < 7; k++) row[k] = 2.0f * random_unit(random) - 1.0f;
    row[7] = any_value(random, 0.02f, 0.1f, 0.02f, 10.0f);
    row[8] = to.x * r, row[9] = to.y * r;
    row[10] = any_value(random, 0.5f, 8.0f, 0.1f, 64.0f);
    row[11] = any_value(random, 0.0f, 1.0f, 0.0f, 1.0f);
    row[12] = any_value(random, 0.0f, 1.0f, 0.0f, 1.0f);
}

static void answer_dust(int which, const float *row, float *answers) {
    Surface s = {.dust = row[11],
                 .sheen = 1.0f,
                 .sheen_upward = row[12],
                 .dust_tilt = row[3],
                 .dust_direction = {row[8], row[9], 0.0f},
                 .dust_falloff = row[10],
                 .dust_noise = row[12],
                 .dust_scale = row[7]};
    Dir p = dir(row[4], row[5], row[6]);
    answers[0] = dust_accumulate(s, dir(row[0], row[1], row[2]), p).dust;
    answers[1] = dust_noise(p, row[7]);
    answers[2] = dust_hash(floorf(289.0f * row[12]));
    answers[3] = dust_accumulate(s, dir(row[0], row[1], row[2]), p).sheen;
}

/* The noise has the same patches to 1e-4, and so have dust and a sheen that lies as it does; the hash below it the same whole numbers. */
static void dust_in_glsl_agrees_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    Surface s;\n    s.sheen = 1.0;\n    s.sheen_upward = in3.x;\n    s.dust = in2.w;\n    s.dust_tilt "
                "= in0.w;\n"
                "    s.dust_direction = dir(in2.x, in2.y, 0.0);\n    s.dust_falloff = in2.z;\n"
                "    s.dust_noise = in3.x;\n    s.dust_scale = in1.w;\n    Dir p = dir(in1.x, in1.y, in1.z);\n"
                "    out0.x = dust_accumulate(s, dir(in0.x, in0.y, in0.z), p).dust;\n"
                "    out0.y = dust_noise(p, in1.w);\n"
                "    out0.z = dust_hash(floor(289.0 * in3.x));\n"
                "    out0.w = dust_accumulate(s, dir(in0.x, in0.y, in0.z), p).sheen;\n",
        .inputs = 4,
        .answers = "ppnp",
        .put = put_dust,
        .fill = fill_dust,
        .answer = answer_dust,
    };
    need_gpu();
    assert_true(agree(&model, 0, "dust"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stacks_in_glsl_agree_with_c),
        cmocka_unit_test(layer_rules_in_glsl_agree_with_c),
        cmocka_unit_test(dust_in_glsl_agrees_with_c),
    };
    return cmocka_run_group_tests(tests, parity_begin, parity_end);
}
