/* A folder of src/, and a folder within it, includes only those before it; the programs use the public headers alone;
 * only the files of lobes compare with the number of one lobe */
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

/* Every folder that holds sources, in the order of includes: a file includes headers of its own folder and of those above. */
static const char *const folders[] = {
    "base",
    "shading/dialect",
    "shading/tables",
    "shading/terms",
    "shading/lobe",
    "shading/ltc",
    "shading/media",
    "shading/lobes",
    "shading/catalogue",
    "shading/layers",
    "shading/stack",
    "shading/weave",
    "shading/workflows",
    "shading/profiles",
    "shading/material",
    "shading/kinds",
    "shading/ambient",
    "shading/area",
    "shading/api",
    "image",
    "image/ktx2",
    "weave",
    "fibre",
    "brdf",
    "scene/record",
    "scene/u3m",
    "scene/mtlx",
    "scene/material",
    "scene/save",
    "scene/light",
    "scene/builtin",
    "scene",
    "gltf/asset",
    "gltf/read",
    "gltf/save",
    "text/source",
    "text/assemble",
    "text/passes",
    "text/flat",
    "text/plugin",
    "trace/geometry",
    "trace/light",
    "trace/path",
    "trace/frame",
    "raster/glsl", /* picture_uniforms.h */
    "raster/gl",
    "raster/geometry",
    "raster/light",
    "raster/material",
    "raster/frame",
    "measure/bsdf",
    "measure/ltc",
    "measure/bake",
    "measure/audit",
    "measure/check",
    "measure/fit",
    "measure/cloth",
    "measure/match",
    "measure/doctor",
    "measure/judge",
    "export",
    "plot",
    "view/files",
    "view/ui",
    "view/render",
    "view/state",
    "view/panels",
    "view",
    "cli/console",
    "cli/operands",
    "cli/files",
    "cli/pages",
    "cli/render",
    "cli/match",
    "cli/judge",
    "cli/deliver",
    "cli/bake",
    "cli/passport",
    "cli/fit",
    "cli/verbs",
    "cli",
    "mpi",
};
enum { FOLDERS = sizeof folders / sizeof folders[0], FILES_MOST = 40 };

/* Returns the place in the list of the folder that a path below src/ is directly in, or -1. */
static int folder_index(const char *path) {
    const char *slash = strrchr(path, '/');
    if (!slash) return -1;
    size_t n = (size_t)(slash - path);
    for (int k = 0; k < FOLDERS; k++)
        if (strlen(folders[k]) == n && strncmp(folders[k], path, n) == 0) return k;
    return -1;
}

static bool is_within(int at, const char *folder) {
    size_t n = strlen(folder);
    return strncmp(folders[at], folder, n) == 0 && (folders[at][n] == 0 || folders[at][n] == '/');
}

/* Returns true if a file of that folder may include "path". */
static bool may_include(int at, const char *path) {
    if (strncmp(path, "weft/", 5) == 0) return true;
    static const char *const alone[] = {"base/steady_clock.h",  "base/pi.h",        "base/path.h",
                                        "base/stream_reason.h", "base/printable.h", "base/folder.h"};
    for (size_t k = 0; k < sizeof alone / sizeof *alone; k++)
        if (strcmp(path, alone[k]) == 0) return true;
    if (strncmp(path, "half/", 5) == 0) return is_within(at, "measure");  /* generated */
    if (!strchr(path, '/')) return true;                                  /* beside the file */
    if (strstr(path, ".gen.h")) return strncmp(path, "shading/", 8) == 0; /* generated */
    int target = folder_index(path);
    if (target < 0 || target > at) return false;
    if (is_within(at, "view")) return is_within(target, "view"); /* programs use include/weft/ alone */
    return !(is_within(at, "cli") || is_within(at, "mpi")) || is_within(target, "mpi") || is_within(target, "cli") ||
           strcmp(path, "view/render/view.h") == 0;
}

static bool next_line(const char **cursor, char line[512]) {
    if (!**cursor) return false;
    size_t n = strcspn(*cursor, "\n");
    snprintf(line, 512, "%.*s", (int)(n < 511 ? n : 511), *cursor);
    *cursor += n + ((*cursor)[n] == '\n');
    return true;
}

/* Finds the first include of text that a file of that folder must not have, in `bad`; false where there is none. */
static bool wrong_include(int at, const char *text, char bad[512]) {
    char line[512];
    while (next_line(&text, line)) {
        const char *c = line + strspn(line, " \t");
        if (*c != '#') continue;
        c += 1 + strspn(c + 1, " \t");
        if (strncmp(c, "include", 7) != 0) continue;
        c += 7 + strspn(c + 7, " \t");
        if (*c != '"') continue;
        snprintf(bad, 512, "%.*s", (int)strcspn(c + 1, "\""), c + 1);
        if (!may_include(at, bad)) return true;
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
    return dot &&
           (strcmp(dot, ".c") == 0 || strcmp(dot, ".h") == 0 || strcmp(dot, ".cpp") == 0 || strcmp(dot, ".inc") == 0);
}

/* Checks the sources that are directly in src/`folder`; returns how many there are. */
static int check_folder(int at, const char *folder, bool *failed) {
    char path[1024], bad[512];
    snprintf(path, sizeof path, "%s/src/%s", WEFT_SOURCE_DIR, folder);
    DIR *open = opendir(path);
    assert_non_null(open);
    int files = 0;
    for (struct dirent *entry; (entry = readdir(open));) {
        if (!is_source(entry->d_name)) continue;
        snprintf(path, sizeof path, "%s/src/%s/%.255s", WEFT_SOURCE_DIR, folder, entry->d_name);
        char *text = read_source(path);
        assert_non_null(text);
        files++;
        if (wrong_include(at, text, bad)) {
            print_error("src/%s/%s includes %s\n", folder, entry->d_name, bad);
            *failed = true;
        }
        const char *cursor = text;
        char line[512];
        while (strcmp(folder, "shading/lobes") != 0 && next_line(&cursor, line))
            if (asks_for_a_lobe(line)) {
                print_error("src/%s/%s asks for a lobe by its number: %s\n", folder, entry->d_name, line);
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
    for (int k = 0; k < FOLDERS; k++) {
        int files = check_folder(k, folders[k], &failed);
        if (files > FILES_MOST || files == 0) fail_msg("src/%s holds %d files", folders[k], files);
    }
    assert_false(failed);
}

/* Fails where a folder below src/`relative` holds sources and is not in the list: nobody would look at it. */
static void find_unlisted(const char *relative) {
    char path[1024];
    snprintf(path, sizeof path, "%s/src/%s", WEFT_SOURCE_DIR, relative);
    DIR *open = opendir(path);
    if (!open) return;
    for (struct dirent *entry; (entry = readdir(open));) {
        if (entry->d_name[0] == '.') continue;
        char inner[512];
        snprintf(inner, sizeof inner, "%.200s%s%.255s", relative, *relative ? "/" : "", entry->d_name);
        if (is_source(entry->d_name) && folder_index(inner) < 0) fail_msg("src/%s is in no listed folder", inner);
        if (!strchr(entry->d_name, '.')) find_unlisted(inner);
    }
    closedir(open);
}

static void every_folder_is_in_the_list(void **state) {
    (void)state;
    find_unlisted("");
}

static void an_upward_include_is_found(void **state) {
    (void)state;
    char bad[512];
    int image = folder_index("image/x.c"), catalogue = folder_index("shading/catalogue/x.c");
    int verbs = folder_index("cli/verbs/x.c"), state_folder = folder_index("view/state/x.c"),
        base = folder_index("base/x.c");
    assert_false(wrong_include(image, "#include \"base/fail.h\"\n#include <math.h>\n", bad));
    assert_true(wrong_include(image, "int x;\n#include \"base/fail.h\"\n#  include \"scene/record/scene.h\"\n", bad));
    assert_string_equal(bad, "scene/record/scene.h");
    assert_true(wrong_include(base, " #include \"image/codec.h\"", bad));
    assert_false(wrong_include(catalogue, "#include \"base/random.h\"\n", bad));
    assert_false(wrong_include(catalogue, "#include \"shading/lobes.gen.h\"\n", bad));
    assert_true(wrong_include(catalogue, "#include \"shading/material/compose.h\"\n", bad));
    assert_false(wrong_include(image, "#include \"codec.h\"\n", bad));
    assert_true(wrong_include(image, "#include \"../scene/record/scene.h\"\n", bad));
    assert_true(wrong_include(image, "#include \"nowhere/x.h\"\n", bad));
    assert_false(wrong_include(verbs, "#include \"cli/console/options.h\"\n#include \"weft/weft.h\"\n", bad));
    assert_true(wrong_include(verbs, "#include \"base/fail.h\"\n", bad));
    assert_false(wrong_include(verbs, "#include \"view/render/view.h\"\n", bad));
    assert_true(wrong_include(verbs, "#include \"view/state/viewer.h\"\n", bad));
    assert_true(wrong_include(state_folder, "#include \"cli/console/options.h\"\n", bad));
    assert_true(wrong_include(state_folder, "#include \"view/panels/x.h\"\n", bad));
    assert_true(wrong_include(state_folder, "#include \"shading/catalogue/registry.h\"\n", bad));
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
