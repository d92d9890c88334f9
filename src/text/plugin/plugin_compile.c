#include <dirent.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "text/plugin/plugin_compile.h"

#include "base/cache.h"
#include "base/fail.h"
#include "base/file.h"
#include "base/process.h"
#include "text/assemble/catalogue.h"
#include "text/source/buffer.h"

/* The text of C. */

enum { INCLUDED_MAX = 128 };
typedef struct Flat {
    Buffer text;
    const char *included[INCLUDED_MAX];
    int count;
} Flat;

static void put_file(Flat *flat, const char *file, const char *bytes);

/* Appends a file of the catalogue, unless the text has it. */
static void put_included(Flat *flat, const char *file) {
    CatalogueFile found;
    if (!catalogue_find(file, &found) || flat->count == INCLUDED_MAX) {
        buffer_print(&flat->text, "#error includes %s, which does not exist\n", file);
        return;
    }
    for (int k = 0; k < flat->count; k++)
        if (flat->included[k] == found.name) return;
    flat->included[flat->count++] = found.name;
    put_file(flat, found.name, found.bytes);
}

/* Appends a file, with included files in place of their #include. */
static void put_file(Flat *flat, const char *file, const char *bytes) {
    int line = 1;
    buffer_print(&flat->text, "#line 1 \"%s\"\n", file);
    for (const char *c = bytes; *c; line++) {
        size_t size = strcspn(c, "\n");
        char name[128];
        if (sscanf(c, "#include \"%127[^\"\n]\"", name) == 1) {
            put_included(flat, name);
            buffer_print(&flat->text, "#line %d \"%s\"\n", line + 1, file);
        } else {
            buffer_put(&flat->text, c, size);
            buffer_put_text(&flat->text, "\n");
        }
        c += size + (c[size] == '\n');
    }
}

static bool has_function(const LobeNames *names, const char *bytes, const char *type, const char *name) {
    char head[160];
    snprintf(head, sizeof head, "%s %s_%s(", type, names->prefix, name);
    return strstr(bytes, head) != NULL;
}

/* Appends both halves of a plugin: its loops, which are compiled with PLUGIN_LOOPS, and the rest. */
static void put_plugin(Flat *flat, const LobeNames *names, const char *bytes) {
    const char *name = names->prefix, *record = names->record, *macros = names->macros;
    bool second = has_function(names, bytes, "float", "second");
    bool strip = has_function(names, bytes, "Strip", "strip"), proxy = has_function(names, bytes, "Proxy", "proxy");
    char file[128];
    snprintf(file, sizeof file, "%s.h", name);
    put_file(flat, file, bytes);
    put_included(flat, "shading/catalogue/plugin_lobe.h");
    buffer_print(&flat->text, "PLUGIN_RECORD(%s, %s, %s)\n", name, record, macros);
    buffer_print(&flat->text, "#ifdef PLUGIN_LOOPS\nPLUGIN_LOOPS_OF(%s, %s, %s, %s%s)\n#else\n", name, record, macros,
                 second ? name : "EACH_F90", second ? "_second" : "");
    if (second) buffer_print(&flat->text, "PLUGIN_SECOND(%s)\n", name);
    if (strip) buffer_print(&flat->text, "PLUGIN_STRIP(%s)\n", name);
    if (proxy) buffer_print(&flat->text, "PLUGIN_PROXY(%s)\n", name);
    buffer_print(&flat->text, "PLUGIN_OF(%s, %s, %s, %s, %s, %s)\n#endif\n", name, record, macros,
                 second ? "plugin_second" : "NULL", strip ? "plugin_strip" : "NULL", proxy ? "plugin_proxy" : "NULL");
}

/* Compiling it. */

/* The options of the library itself; CMakeLists.txt explains them. */
#if defined(__AVX2__) && defined(__FMA__)
#define ARCH "-march=x86-64-v3",
#else
#define ARCH
#endif
#define COMMON                                                                                                         \
    "-std=c11", "-O3", "-fPIC", "-fvisibility=hidden", "-Werror=implicit-function-declaration", "-fno-math-errno",     \
        "-fno-trapping-math", "-fno-signed-zeros", "-ffinite-math-only"
#ifdef WEFT_ONE_ISA
#define ISA_TEXT(set)   "-DWEFT_ONE_ISA=" #set,
#define ISA_OPTION(set) ISA_TEXT(set)
#else
#define ISA_OPTION(set)
#endif
static const char *const half_flags[2][20] = {{COMMON, "-fopenmp-simd", "-ffp-contract=fast", "-DPLUGIN_LOOPS",
                                               "-DFN_NOINLINE=FN", ISA_OPTION(WEFT_ONE_ISA) "-c"},
                                              {COMMON, ARCH "-ffp-contract=off", "-shared"}};

enum { COMPILER_SIZE = 256, COMPILER_WORDS = 8, PATH_SIZE = CACHE_PATH_SIZE + 32 };

/* A folder of a compilation and what is in it. */
typedef struct CompileWork {
    char folder[CACHE_PATH_SIZE];
    char text[PATH_SIZE], loops[PATH_SIZE], library[PATH_SIZE], log[PATH_SIZE];
} CompileWork;

static void work_name(CompileWork *work) {
    snprintf(work->text, sizeof work->text, "%s/lobe.c", work->folder);
    snprintf(work->loops, sizeof work->loops, "%s/loops.o", work->folder);
    snprintf(work->library, sizeof work->library, "%s/lobe.so", work->folder);
    snprintf(work->log, sizeof work->log, "%s/log", work->folder);
}

/* Makes the folder of a compilation, beside the cache's file, so that the library can be renamed to it; without one in
 * /tmp. Returns false on failure. */
static bool work_begin(CompileWork *work, const char *cached) {
    const char *slash = cached ? strrchr(cached, '/') : NULL;
    snprintf(work->folder, sizeof work->folder, "%.*s/lobe-XXXXXX", slash ? (int)(slash - cached) : 4,
             slash ? cached : "/tmp");
    if (!mkdtemp(work->folder)) return false;
    work_name(work);
    return true;
}

static void work_end(const CompileWork *work) {
    unlink(work->text);
    unlink(work->loops);
    unlink(work->library);
    unlink(work->log);
    rmdir(work->folder);
}

/* Removes what compilations have left that were interrupted more than an hour ago. */
static void sweep(const char *folder) {
    DIR *entries = opendir(folder);
    CompileWork work;
    struct stat status;
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (strncmp(entry->d_name, "lobe-", 5) != 0) continue;
        if ((size_t)snprintf(work.folder, sizeof work.folder, "%s/%s", folder, entry->d_name) >= sizeof work.folder ||
            lstat(work.folder, &status) != 0 || status.st_mtime > time(NULL) - 3600)
            continue;
        work_name(&work);
        work_end(&work);
    }
    if (entries) closedir(entries);
}

typedef struct Compiler {
    char text[COMPILER_SIZE];
    const char *words[COMPILER_WORDS];
    int count;
} Compiler;

/* Splits $CC, or "cc" without it, into words. Returns false if it is too long. */
static bool compiler_choose(Compiler *compiler) {
    const char *chosen = getenv("CC");
    char *rest = NULL;
    if (!chosen || !chosen[strspn(chosen, " ")]) chosen = "cc";
    compiler->count = 0;
    if ((size_t)snprintf(compiler->text, COMPILER_SIZE, "%s", chosen) >= COMPILER_SIZE) return false;
    for (char *word = strtok_r(compiler->text, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        if (compiler->count == COMPILER_WORDS) return false;
        compiler->words[compiler->count++] = word;
    }
    return true;
}

/* Compiles half 0, the loops, or half 1, the rest, and links it with the loops. Returns the compiler's exit status. */
static int compile_half(const CompileWork *work, const Compiler *compiler, int half) {
    const char *arguments[40] = {0};
    int count = compiler->count;
    memcpy(arguments, compiler->words, (size_t)count * sizeof *arguments);
    for (int k = 0; half_flags[half][k]; k++) arguments[count++] = half_flags[half][k];
    arguments[count++] = work->text;
    if (half) arguments[count++] = work->loops;
    arguments[count++] = "-o";
    arguments[count++] = half ? work->library : work->loops;
    return process_run(arguments, work->log);
}

/* Errors. */

/* Fails with a compiler's error: "toy.h:12:5: error: WORDS" becomes "PATH:12: does not compile: WORDS". */
static WeftResult fail_line(const char *line, const char *path, const char *file, int more, WeftError *error) {
    char place[400], others[40] = "", words[300];
    int number = 0;
    size_t size = strlen(file);
    const char *message = strstr(line, "error: ") + strlen("error: ");
    const char *option = strstr(message, " [-W"); /* an option that the user has not typed */
    int length = (int)(option ? (size_t)(option - message) : strlen(message));
    snprintf(words, sizeof words, "%.*s", length, message);
    if (more) snprintf(others, sizeof others, "; and %d more error%s", more, more > 1 ? "s" : "");
    if (strncmp(line, file, size) != 0 || sscanf(line + size, ":%d", &number) != 1)
        return fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "%.*s: %s%s", (int)strcspn(line, ":"), line, words, others);
    snprintf(place, sizeof place, "%.380s:%d", path, number);
    return fail(error, WEFT_MESSAGE_LOBE_COMPILE, place, "%s%s", words, others);
}

/* Fails with the compiler's first error, else its last line. */
static WeftResult fail_compile(const CompileWork *work, const char *path, const char *file, WeftError *error) {
    FileBytes log;
    const char *first = NULL, *last = NULL;
    int count = 0;
    if (file_read(work->log, 1 << 20, &log, NULL) != WEFT_OK) return fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, NULL);
    char *rest = NULL;
    for (char *line = strtok_r((char *)log.data, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        last = line;
        if (!strstr(line, "error: ")) continue;
        if (!count++) first = line;
    }
    WeftResult result = first ? fail_line(first, path, file, count - 1, error)
                              : fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "the compiler fails%s%s", last ? ": " : "",
                                     last ? last : "");
    free(log.data);
    return result;
}

static WeftResult compile(const CompileWork *work, const Compiler *compiler, const Buffer *text, const char *path,
                          const char *file, WeftError *error) {
    FILE *stream = fopen(work->text, "wb");
    bool written = stream && fwrite(text->bytes, 1, text->size, stream) == text->size;
    if (stream) written = fclose(stream) == 0 && written;
    if (!written) return fail(error, WEFT_MESSAGE_FILE_WRITE, work->text, NULL);
    for (int half = 0; half < 2; half++) {
        int code = compile_half(work, compiler, half);
        if (code == PROCESS_MISSING) return fail(error, WEFT_MESSAGE_COMPILER, path, "install one, or name it by $CC");
        if (code == PROCESS_LOST)
            return fail(error, WEFT_MESSAGE_LOBE_COMPILE, path,
                        "the compiler cannot be waited for; is SIGCHLD ignored?");
        if (code != 0) return fail_compile(work, path, file, error);
    }
    return WEFT_OK;
}

/* Loading it. */

/* Loads a library. Returns NULL on failure, with the reason in dlerror. */
static const Plugin *load(const char *library) {
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL); /* never closed: stacks contain its functions */
    void *symbol = handle ? dlsym(handle, PLUGIN_ENTRY) : NULL;
    PluginEntry *entry;
    memcpy(&entry, &symbol, sizeof entry);
    return symbol ? entry(&isa_used) : NULL;
}

static uint64_t key_of(const Buffer *text, const Compiler *compiler) {
    uint64_t hash = cache_hash(CACHE_HASH, text->bytes, text->size);
    for (int k = 0; k < compiler->count; k++)
        hash = cache_hash(hash, compiler->words[k], strlen(compiler->words[k]) + 1);
    for (int half = 0; half < 2; half++)
        for (int k = 0; half_flags[half][k]; k++)
            hash = cache_hash(hash, half_flags[half][k], strlen(half_flags[half][k]) + 1);
    return hash;
}

/* Sets the library's path in the cache. Returns false if there is no cache, or others can write to it, since a loaded
 * file is run. */
static bool find_place(char cached[CACHE_PATH_SIZE], uint64_t key) {
    if (!cache_folder_make() || !cache_path(cached, key, "so")) return false;
    char *slash = strrchr(cached, '/');
    *slash = 0;
    bool is_private = cache_is_private(cached);
    if (is_private) sweep(cached);
    *slash = '/';
    return is_private;
}

/* Moves a library to the cache; warns on failure, since it is then compiled again each time. */
static void keep(const char *library, const char *cached, const WeftLog *log) {
    if (chmod(library, 0700) != 0 || rename(library, cached) != 0)
        warn(log, WEFT_MESSAGE_CACHE_IGNORED, cached, "it cannot be written; the lobe is compiled at each start");
}

static WeftResult make(const Compiler *compiler, const Buffer *text, const char *path, const char *file,
                       const char *cached, const Plugin **out, const WeftLog *log, WeftError *error) {
    CompileWork work;
    if (!work_begin(&work, cached)) return fail(error, WEFT_MESSAGE_FILE_WRITE, work.folder, NULL);
    WeftResult result = compile(&work, compiler, text, path, file, error);
    if (result == WEFT_OK) {
        *out = load(work.library);
        const char *why = *out ? NULL : dlerror();
        if (!*out)
            result = fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "it cannot be loaded%s%s", why ? ": " : "",
                          why ? why : "");
        if (*out && cached) keep(work.library, cached, log);
    }
    work_end(&work);
    return result;
}

WeftResult plugin_make(const LobeNames *names, const char *path, const char *bytes, const Plugin **out,
                       const WeftLog *log, WeftError *error) {
    Flat flat = {0};
    Compiler compiler;
    char cached[CACHE_PATH_SIZE], file[128];
    if (!compiler_choose(&compiler))
        return fail(error, WEFT_MESSAGE_COMPILER, path, "$CC has more than %d characters or %d words",
                    COMPILER_SIZE - 1, COMPILER_WORDS);
    put_plugin(&flat, names, bytes);
    if (flat.text.failed) {
        buffer_free(&flat.text);
        return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    }
    snprintf(file, sizeof file, "%s.h", names->prefix);
    bool caches = find_place(cached, key_of(&flat.text, &compiler));
    if (!caches) warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "there is no folder of the user's own to keep it in");
    WeftResult result = WEFT_OK;
    *out = caches && cache_is_private(cached) ? load(cached) : NULL;
    if (!*out) result = make(&compiler, &flat.text, path, file, caches ? cached : NULL, out, log, error);
    buffer_free(&flat.text);
    return result;
}
