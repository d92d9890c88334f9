/* The catalogue as data: files, ids, tables, headers, and the public calls that take names */
#include <ctype.h>
#include <dirent.h>

#include "cases.h"

/* The opening comment of a file of src/shading, or of all the file (whole). */
static char *read_text(const char *folder, const char *file, bool whole) {
    char path[512];
    snprintf(path, sizeof path, "%s/src/shading/%s/%s", WEFT_SOURCE_DIR, folder, file);
    FILE *stream = fopen(path, "rb");
    if (!stream) fail_msg("%s cannot be opened", path);
    char *text = calloc(1, 1 << 16);
    size_t size = fread(text, 1, (1 << 16) - 1, stream);
    fclose(stream);
    text[size] = 0;
    char *end = strstr(text, "*/");
    if (!whole && end) *end = 0;
    return text;
}

/* The id that a file name means: "charlie_neubelt.h" is "charlie-neubelt"; false for what is no header. */
static bool id_of_file(const char *file, char id[64]) {
    size_t n = strlen(file);
    if (n < 3 || n > 63 || strcmp(file + n - 2, ".h") != 0) return false;
    memcpy(id, file, n - 2);
    id[n - 2] = 0;
    for (char *c = id; *c; c++)
        if (*c == '_') *c = '-';
    return true;
}

static DIR *open_folder(const char *folder) {
    char path[512];
    snprintf(path, sizeof path, "%s/src/shading/%s", WEFT_SOURCE_DIR, folder);
    DIR *open = opendir(path);
    assert_non_null(open);
    return open;
}

static bool is_kebab(const char *id) {
    if (!islower((unsigned char)id[0])) return false;
    for (const char *c = id; *c; c++)
        if (!islower((unsigned char)*c) && !isdigit((unsigned char)*c) && *c != '-') return false;
    return true;
}

static void every_lobe_file_is_registered(void **state) {
    (void)state;
    DIR *folder = open_folder("lobes");
    int files = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        char id[64];
        if (!id_of_file(entry->d_name, id)) continue;
        files++;
        if (weft_lobe_find(id) < 0) fail_msg("lobes/%s has no row in lobes.list", entry->d_name);
    }
    closedir(folder);
    assert_int_equal(files, weft_lobe_count());
}

static void every_layer_file_is_listed(void **state) {
    (void)state;
    DIR *folder = open_folder("layers");
    int files = 0, layers = 0;
    while (weft_layer_name(layers)) layers++;
    for (struct dirent *entry; (entry = readdir(folder));) {
        char id[64];
        if (!id_of_file(entry->d_name, id)) continue;
        files++;
        int k = 0;
        while (k < layers && strcmp(weft_layer_name(k), id) != 0) k++;
        if (k == layers) fail_msg("layers/%s has no line in layer.h", entry->d_name);
    }
    closedir(folder);
    assert_int_equal(files, layers);
    assert_int_equal(layers, LAYER_COUNT);
    for (int k = 0; k < layers; k++) {
        assert_true(is_kebab(weft_layer_name(k)));
        assert_true(strlen(weft_layer_help(k)) > 10);
        for (int j = 0; j < k; j++) assert_string_not_equal(weft_layer_name(k), weft_layer_name(j));
    }
    assert_null(weft_layer_name(-1));
    assert_null(weft_layer_help(layers));
}

static void lobe_ids_are_unique_and_kebab_case(void **state) {
    (void)state;
    for (int k = 0; k < weft_lobe_count(); k++) {
        const char *id = weft_lobe_info(k)->id;
        assert_true(is_kebab(id));
        assert_int_equal(weft_lobe_find(id), k);
    }
    assert_int_equal(weft_lobe_find("charlie"), -1);
    assert_int_equal(weft_lobe_find(""), -1);
    assert_null(weft_lobe_info(-1));
    assert_null(weft_lobe_info(weft_lobe_count()));
}

static void parameter_tables_have_ordered_ranges(void **state) {
    (void)state;
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        assert_in_range(info->param_count, 0, WEFT_LOBE_PARAMS_MAX);
        for (int p = 0; p < info->param_count; p++) {
            const WeftParamInfo *param = &info->params[p];
            if (!(param->hard_low <= param->low && param->low <= param->def && param->def <= param->high &&
                  param->high <= param->hard_high && param->low < param->high))
                fail_msg("%s %s: the ranges do not nest", info->id, param->name);
            assert_true(strlen(param->help) > 10);
            assert_true(islower((unsigned char)param->name[0]));
            for (int j = 0; j < p; j++) assert_string_not_equal(param->name, info->params[j].name);
            assert_string_not_equal(param->name, "color");
            assert_string_not_equal(param->name, "f0");
            assert_string_not_equal(param->name, "f90");
        }
    }
}

/* A year from 1700 on, as a citation has it. */
static bool has_year(const char *text) {
    for (const char *c = text; *c; c++)
        if ((strncmp(c, "17", 2) == 0 || strncmp(c, "18", 2) == 0 || strncmp(c, "19", 2) == 0 ||
             strncmp(c, "20", 2) == 0) &&
            isdigit((unsigned char)c[2]) && isdigit((unsigned char)c[3]) && !isdigit((unsigned char)c[4]))
            return true;
    return false;
}

static void lobe_headers_have_the_required_lines(void **state) {
    (void)state;
    static const char *const phrases[] = {"f = ", "reciprocal: ", "energy: ", "sampling: ", "[1/sr]"};
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        char file[80], opening[80];
        snprintf(file, sizeof file, "%s.h", info->id);
        for (char *c = file; *c; c++)
            if (*c == '-') *c = '_';
        char *text = read_text("lobes", file, false);
        snprintf(opening, sizeof opening, "/* %s - ", info->id);
        if (strncmp(text, opening, strlen(opening)) != 0) fail_msg("%s does not begin with its id", file);
        for (int p = 0; p < 5; p++)
            if (!strstr(text, phrases[p])) fail_msg("%s has no \"%s\" in its opening comment", file, phrases[p]);
        if (info->param_count && !strstr(text, "roughness: ")) fail_msg("%s has no \"roughness: \"", file);
        if (!has_year(text)) fail_msg("%s cites nothing with a year", file);
        bool reciprocal = strstr(text, "reciprocal: yes") != NULL, gains = strstr(text, "energy: no") != NULL;
        assert_int_equal(reciprocal, (info->traits & TRAIT_RECIPROCAL) != 0);
        assert_int_equal(gains, !(info->traits & TRAIT_CONSERVES));
        free(text);
    }
}

/* Shading text is one language: no C that GLSL does not have, outside comments. */
static void shading_text_keeps_to_the_dialect(void **state) {
    (void)state;
    static const char *const folders[] = {"terms", "lobes", "layers"};
    static const char *const foreign[] = {"double ", "##", "sizeof", "static ", "const float ", "printf"};
    for (int f = 0; f < 3; f++) {
        DIR *folder = open_folder(folders[f]);
        for (struct dirent *entry; (entry = readdir(folder));) {
            char id[64];
            if (!id_of_file(entry->d_name, id)) continue;
            char *text = read_text(folders[f], entry->d_name, true);
            assert_true(has_year(text));
            const char *body = strstr(text, "*/");
            assert_non_null(body);
            for (size_t k = 0; k < sizeof foreign / sizeof foreign[0]; k++)
                if (strstr(body, foreign[k])) fail_msg("%s/%s has \"%s\"", folders[f], entry->d_name, foreign[k]);
            free(text);
        }
        closedir(folder);
    }
}

typedef struct Seen {
    int count;
    WeftMessage message;
} Seen;

static void see(void *user, WeftMessage message, const char *text) {
    Seen *seen = user;
    seen->count++;
    seen->message = message;
    assert_non_null(text);
}

static void unknown_parameter_name_is_refused(void **state) {
    (void)state;
    WeftLobe lobe;
    WeftError error;
    assert_int_equal(weft_lobe_init("velvet", &lobe, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_NAME);
    assert_int_equal(weft_lobe_init("ggx", &lobe, &error), WEFT_OK);
    assert_int_equal(weft_lobe_set(&lobe, "shininess", "0.5", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_NAME);
    assert_int_equal(weft_lobe_init("lambert", &lobe, &error), WEFT_OK);
    assert_int_equal(weft_lobe_set(&lobe, "f90", "1", NULL, &error), WEFT_USAGE); /* it has no Fresnel term */
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_NAME);
}

static void malformed_parameter_value_is_refused(void **state) {
    (void)state;
    static const char *const values[] = {"", "x", "0.5x", "nan", "inf", "-inf", "1e99", "1,2", "0.1,0.2,0.3"};
    for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
        WeftLobe lobe;
        WeftError error;
        weft_lobe_init("ggx", &lobe, NULL);
        float before = lobe.params[0];
        assert_int_equal(weft_lobe_set(&lobe, "alpha", values[k], NULL, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
        assert_true(!(lobe.params[0] != before));
        if (strcmp(values[k], "0.1,0.2,0.3") == 0) continue;
        assert_int_equal(weft_lobe_set(&lobe, "color", values[k], NULL, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
        assert_true(!(lobe.f0[0] != 1.0f));
    }
}

static void values_outside_the_plausible_range_are_a_warning(void **state) {
    (void)state;
    Seen seen = {0};
    WeftLog log = {see, &seen};
    WeftLobe lobe;
    weft_lobe_init("ggx", &lobe, NULL);
    assert_int_equal(weft_lobe_set(&lobe, "alpha", "0.5", &log, NULL), WEFT_OK);
    assert_int_equal(seen.count, 0);
    assert_int_equal(weft_lobe_set(&lobe, "alpha", "2", &log, NULL), WEFT_OK); /* beyond the slider */
    assert_int_equal(seen.count, 1);
    assert_int_equal(seen.message, WEFT_MESSAGE_PARAM_RANGE);
    assert_true(!(lobe.params[0] != 2.0f));
    assert_int_equal(weft_lobe_set(&lobe, "alpha", "1e6", &log, NULL), WEFT_OK); /* beyond the hard range */
    assert_int_equal(seen.count, 2);
    assert_true(!(lobe.params[0] != weft_lobe_info(lobe.lobe)->params[0].hard_high));
    assert_int_equal(weft_lobe_set(&lobe, "color", "-1,0.5,2", &log, NULL), WEFT_OK);
    assert_int_equal(seen.count, 4);
    assert_true(!(lobe.f0[0] != 0.0f) && !(lobe.f0[1] != 0.5f) && !(lobe.f0[2] != 2.0f));
    assert_int_equal(weft_lobe_set(&lobe, "f90", "0.25", &log, NULL), WEFT_OK);
    assert_true(!(lobe.f90[1] != 0.25f) && !(lobe.f0[1] != 0.5f));
    assert_int_equal(seen.count, 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lobe_file_is_registered),
        cmocka_unit_test(every_layer_file_is_listed),
        cmocka_unit_test(lobe_ids_are_unique_and_kebab_case),
        cmocka_unit_test(parameter_tables_have_ordered_ranges),
        cmocka_unit_test(lobe_headers_have_the_required_lines),
        cmocka_unit_test(shading_text_keeps_to_the_dialect),
        cmocka_unit_test(unknown_parameter_name_is_refused),
        cmocka_unit_test(malformed_parameter_value_is_refused),
        cmocka_unit_test(values_outside_the_plausible_range_are_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
