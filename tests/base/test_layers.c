/* A folder of src/ includes only folders before it; the programs stand on the public headers alone; only the
 * files of lobes ask which lobe it is */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char *const folders[] = {"base",   "shading", "image", "weave", "fibre",  "brdf",
                                      "scene",  "gltf",    "text",  "trace", "raster", "measure",
                                      "export", "plot",    "view",  "cli"};
enum { FOLDERS = sizeof folders / sizeof folders[0] };

static int folder_index(const char *path) {
    for (int k = 0; k < FOLDERS; k++) {
        size_t n = strlen(folders[k]);
        if (strncmp(path, folders[k], n) == 0 && path[n] == '/') return k;
    }
    return -1;
}

static bool is_program(int folder) {
    return strcmp(folders[folder], "view") == 0 || strcmp(folders[folder], "cli") == 0;
}

/* Whether a file of that folder may include "path". */
static bool may_include(int folder, const char *path) {
    if (strncmp(path, "weft/", 5) == 0) return true;
    if (strcmp(path, "base/steady_clock.h") == 0 || strcmp(path, "base/pi.h") == 0) return true;
    if (strncmp(path, "half/", 5) == 0) return strcmp(folders[folder], "measure") == 0; /* generated */
    if (!strchr(path, '/')) return true;                                                /* beside the file */
    int target = folder_index(path);
    if (target < 0) return false;
    return target <= folder &&
           (!is_program(folder) || is_program(target)); /* programs use include/weft/ alone */
}

static bool next_line(const char **cursor, char line[512]) {
    if (!**cursor) return false;
    size_t n = strcspn(*cursor, "\n");
    snprintf(line, 512, "%.*s", (int)(n < 511 ? n : 511), *cursor);
    *cursor += n + ((*cursor)[n] == '\n');
    return true;
}

/* The first include of text that a file of that folder must not have, in `bad`; false where there is none. */
static bool wrong_include(int folder, const char *text, char bad[512]) {
    char line[512];
    while (next_line(&text, line)) {
        const char *c = line + strspn(line, " \t");
        if (*c != '#') continue;
        c += 1 + strspn(c + 1, " \t");
        if (strncmp(c, "include", 7) != 0) continue;
        c += 7 + strspn(c + 7, " \t");
        if (*c != '"') continue;
        snprintf(bad, 512, "%.*s", (int)strcspn(c + 1, "\""), c + 1);
        if (!may_include(folder, bad)) return true;
    }
    return false;
}

static bool ends_with(const char *text, const char *end, const char *word) {
    size_t n = strlen(word);
    while (end > text && end[-1] == ' ') end--;
    return (size_t)(end - text) >= n && strncmp(end - n, word, n) == 0;
}

/* Returns true if a line compares with the number of one lobe: what holds of a lobe belongs in its file. */
static bool asks_for_a_lobe(const char *line) {
    static const char *const others[] = {"LOBE_COUNT", "LOBE_MOST", "LOBE_PARAMS_MAX"};
    for (const char *c = line; (c = strstr(c, "LOBE_")); c += strlen("LOBE_")) {
        size_t n = strspn(c, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789");
        bool other = c > line && (c[-1] == '_' || (c[-1] >= 'A' && c[-1] <= 'Z'));
        for (size_t k = 0; k < sizeof others / sizeof others[0]; k++)
            other |= n == strlen(others[k]) && strncmp(c, others[k], n) == 0;
        const char *after = c + n + strspn(c + n, " ");
        if (other || n == strlen("LOBE_")) continue; /* the latter of a format */
        if (ends_with(line, c, "==") || ends_with(line, c, "!=") || ends_with(line, c, "case") ||
            strncmp(after, "==", 2) == 0 || strncmp(after, "!=", 2) == 0)
            return true;
    }
    return false;
}

static char *read_source(const char *path) {
    FILE *stream = fopen(path, "rb");
    if (!stream) return NULL;
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    size_t size = fread(text, 1, (1 << 20) - 1, stream);
    text[size] = 0;
    fclose(stream);
    return text;
}

static bool is_source(const char *name) {
    const char *dot = strrchr(name, '.');
    return dot && (strcmp(dot, ".c") == 0 || strcmp(dot, ".h") == 0 || strcmp(dot, ".cpp") == 0 ||
                   strcmp(dot, ".inc") == 0);
}

/* Checks all sources below src/`relative`; returns how many there are. */
static int check_folder(int folder, const char *relative, bool *failed) {
    char path[1024], bad[512];
    snprintf(path, sizeof path, "%s/src/%s", WEFT_SOURCE_DIR, relative);
    DIR *open = opendir(path);
    if (!open) return 0;
    int files = 0;
    for (struct dirent *entry; (entry = readdir(open));) {
        if (entry->d_name[0] == '.') continue;
        char inner[512];
        snprintf(inner, sizeof inner, "%.255s/%.255s", relative, entry->d_name);
        if (!is_source(entry->d_name)) {
            files += check_folder(folder, inner, failed);
            continue;
        }
        snprintf(path, sizeof path, "%s/src/%s", WEFT_SOURCE_DIR, inner);
        char *text = read_source(path);
        assert_non_null(text);
        files++;
        if (wrong_include(folder, text, bad)) {
            print_error("src/%s includes %s\n", inner, bad);
            *failed = true;
        }
        const char *cursor = text ? text : "";
        char line[512];
        while (strncmp(inner, "shading/lobes/", 14) != 0 && next_line(&cursor, line))
            if (asks_for_a_lobe(line)) {
                print_error("src/%s asks for a lobe by its number: %s\n", inner, line);
                *failed = true;
            }
        free(text);
    }
    closedir(open);
    return files;
}

static void sources_include_only_folders_above_their_own(void **state) {
    (void)state;
    bool failed = false;
    int files = 0;
    for (int k = 0; k < FOLDERS; k++) files += check_folder(k, folders[k], &failed);
    assert_true(files > 50);
    assert_false(failed);
}

/* A folder that the list does not know would not be looked at. */
static void every_folder_is_in_the_list(void **state) {
    (void)state;
    DIR *open = opendir(WEFT_SOURCE_DIR "/src");
    assert_non_null(open);
    for (struct dirent *entry; (entry = readdir(open));) {
        if (entry->d_name[0] == '.') continue;
        char name[300];
        snprintf(name, sizeof name, "%s/", entry->d_name);
        if (folder_index(name) < 0) fail_msg("src/%s is not in the order of the folders", entry->d_name);
    }
    closedir(open);
}

static void an_upward_include_is_found(void **state) {
    (void)state;
    char bad[512];
    int image = folder_index("image/"), shading = folder_index("shading/"), cli = folder_index("cli/");
    int view = folder_index("view/"), base = folder_index("base/");
    assert_false(wrong_include(image, "#include \"base/fail.h\"\n#include <math.h>\n", bad));
    assert_true(
        wrong_include(image, "int x;\n#include \"base/fail.h\"\n#  include \"scene/scene.h\"\n", bad));
    assert_string_equal(bad, "scene/scene.h");
    assert_true(wrong_include(base, " #include \"image/codec.h\"", bad));
    assert_false(wrong_include(shading, "#include \"base/random.h\"\n", bad));
    assert_false(wrong_include(image, "#include \"codec.h\"\n", bad));
    assert_true(wrong_include(image, "#include \"../scene/scene.h\"\n", bad));
    assert_true(wrong_include(image, "#include \"nowhere/x.h\"\n", bad));
    assert_false(wrong_include(cli, "#include \"cli/options.h\"\n#include \"weft/weft.h\"\n", bad));
    assert_true(wrong_include(cli, "#include \"base/fail.h\"\n", bad));
    assert_false(wrong_include(cli, "#include \"view/view.h\"\n", bad));
    assert_true(wrong_include(view, "#include \"cli/options.h\"\n", bad));
    assert_true(wrong_include(view, "#include \"shading/registry.h\"\n", bad));
}

static void a_question_for_a_lobe_is_found(void **state) {
    (void)state;
    assert_true(asks_for_a_lobe("    if (id == LOBE_GGX) return;"));
    assert_true(asks_for_a_lobe("    if (LOBE_GGX != id) return;"));
    assert_true(asks_for_a_lobe("    case LOBE_LTC_FIBRE:"));
    assert_false(asks_for_a_lobe("    Lobe lobe = lobe_default(LOBE_GGX);"));
    assert_false(asks_for_a_lobe("    return id == LOBE_COUNT || m == WEFT_MESSAGE_LOBE_NAME;"));
}

/* Public headers include public headers only. */
static void public_headers_stand_alone(void **state) {
    (void)state;
    DIR *open = opendir(WEFT_SOURCE_DIR "/include/weft");
    assert_non_null(open);
    for (struct dirent *entry; (entry = readdir(open));) {
        if (!is_source(entry->d_name)) continue;
        char path[1024], line[512];
        snprintf(path, sizeof path, "%s/include/weft/%s", WEFT_SOURCE_DIR, entry->d_name);
        char *text = read_source(path);
        assert_non_null(text);
        const char *cursor = text;
        while (next_line(&cursor, line))
            if (strncmp(line, "#include \"", 10) == 0 && strncmp(line, "#include \"weft/", 15) != 0)
                fail_msg("%s: %s", entry->d_name, line);
        free(text);
    }
    closedir(open);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sources_include_only_folders_above_their_own),
        cmocka_unit_test(a_question_for_a_lobe_is_found),
        cmocka_unit_test(every_folder_is_in_the_list),
        cmocka_unit_test(an_upward_include_is_found),
        cmocka_unit_test(public_headers_stand_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
