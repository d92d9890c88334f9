#include "cli/operands/each_asset.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/path.h"
#include "cli/console/report.h"

/* Returns the name of an asset without its folder and suffix, and its length. */
static const char *stem_of(const char *asset, int *length) {
    const char *builtin = path_builtin(asset);
    if (builtin) asset = builtin;
    const char *slash = strrchr(asset, '/'), *name = slash ? slash + 1 : asset, *dot = strrchr(name, '.');
    *length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    return name;
}

static bool is_folder(const char *value) {
    struct stat status;
    return value[strlen(value) - 1] == '/' || (stat(value, &status) == 0 && S_ISDIR(status.st_mode));
}

static const EachOutput *output_of(const EachOutput *outputs, const Given *given) {
    while (outputs->option && strcmp(outputs->option, given->option->name) != 0) outputs++;
    return outputs->option ? outputs : NULL;
}

/* Returns true if the value names a file for each of several assets. */
static bool is_of_each(const char *value) { return is_folder(value) || strstr(value, "{}") != NULL; }

/* Returns the file that a value names for an asset. Release with free; NULL if memory is short. */
static char *file_of(const EachOutput *output, const char *value, const char *asset) {
    int length;
    const char *stem = stem_of(asset, &length), *hole = strstr(value, "{}"), *end = stem + length;
    if (!is_of_each(value)) return strdup(value);
    const char *suffix = output->suffix ? output->suffix : *end ? end : ".glb", *behind = hole ? hole + 2 : suffix;
    size_t before = hole ? (size_t)(hole - value) : strlen(value);
    const char *slash = hole || value[before - 1] == '/' ? "" : "/";
    size_t size = before + 1 + (size_t)length + strlen(behind) + 1;
    char *file = malloc(size);
    if (file) snprintf(file, size, "%.*s%s%.*s%s", (int)before, value, slash, length, stem, behind);
    return file;
}

/* Checks that no two assets have one file. */
static int names_check(const Options *options, const EachOutput *output, const Given *given) {
    const int count = options->operand_count;
    int result = 0;
    char **files = calloc((size_t)count, sizeof *files);
    if (!files) return report(WEFT_RESOURCES, "out of memory");
    for (int a = 0; a < count && result == 0; a++) {
        files[a] = file_of(output, given->value, options->operands[a]);
        if (!files[a]) {
            result = report(WEFT_RESOURCES, "out of memory");
            break;
        }
        for (int b = 0; b < a && result == 0; b++)
            if (strcmp(files[a], files[b]) == 0)
                result = report(WEFT_USAGE, "%s: \"%.200s\" would be written for %.200s and for %.200s",
                                given->option->name, files[a], options->operands[b], options->operands[a]);
    }
    for (int a = 0; a < count; a++) free(files[a]);
    free(files);
    return result;
}

/* Checks the outputs of several assets: each has a file of its own. */
static int outputs_check(const Options *options, const EachOutput *outputs) {
    for (int g = 0; g < options->given_count; g++) {
        const Given *given = &options->given[g];
        const EachOutput *output = output_of(outputs, given);
        if (!output) continue;
        if (!is_of_each(given->value))
            return report(WEFT_USAGE,
                          "%s: \"%.200s\" is one file for %d assets; name a folder, or write {} for the "
                          "name of each, as in %s 'new/{}%s'",
                          given->option->name, given->value, options->operand_count, given->option->name,
                          output->suffix ? output->suffix : ".glb");
        const int result = names_check(options, output, given);
        if (result != 0) return result;
    }
    return 0;
}

/* Runs the verb for one operand, with its own files. */
static int one_run(const Options *options, int operand, const EachOutput *outputs, int (*run)(const Options *)) {
    Options one = *options;
    const size_t count = (size_t)options->given_count;
    Given *given = calloc(count + 1, sizeof *given);
    char **files = calloc(count + 1, sizeof *files);
    bool good = given && files;
    one.operands = &options->operands[operand];
    one.operand_count = 1;
    one.given = given;
    for (size_t k = 0; good && k < count; k++) {
        const EachOutput *output = output_of(outputs, &options->given[k]);
        given[k] = options->given[k];
        if (!output) continue;
        good = (files[k] = file_of(output, given[k].value, options->operands[operand])) != NULL;
        given[k].value = files[k];
    }
    const int result = good ? run(&one) : report(WEFT_RESOURCES, "out of memory");
    for (size_t k = 0; files && k < count; k++) free(files[k]);
    free(files);
    free(given);
    return result;
}

int each_run(const Options *options, const EachOutput *outputs, int (*run)(const Options *options)) {
    int worst = options->operand_count > 1 ? outputs_check(options, outputs) : 0;
    if (worst != 0) return worst;
    if (options->operand_count == 0) return run(options);
    for (int k = 0; k < options->operand_count && worst != WEFT_INTERRUPTED; k++) {
        const int result = one_run(options, k, outputs, run);
        if (result > worst) worst = result;
    }
    return worst;
}
