#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
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
#include "base/stream_reason.h"
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
        static const char include[] = "#include \"";
        size_t size = strcspn(c, "\n"), start = sizeof include - 1;
        char name[128];
        if (size > start && memcmp(c, include, start) == 0) {
            size_t end = strcspn(c + start, "\"\n");
            snprintf(name, sizeof name, "%.*s", (int)(end < sizeof name ? end : sizeof name - 1), c + start);
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

/* The bounds of a compiler. The lobes of the catalogue take seconds and 300 MiB. */
static const ProcessBounds bounds = {.seconds = 60, .cpu_seconds = 30, .mebibytes = 4096};

/* A folder of a compilation and what is in it, beside the compiler's own files. */
typedef struct CompileWork {
    char folder[CACHE_PATH_SIZE];
    char text[PATH_SIZE], loops[PATH_SIZE], library[PATH_SIZE], log[PATH_SIZE];
} CompileWork;

#define WORK_NAME "weft-lobe-"

/* Makes the folder of a compilation in another. Returns false on failure, with errno. */
static bool work_begin(CompileWork *work, const char *folder) {
    snprintf(work->folder, sizeof work->folder, "%.*s/" WORK_NAME "XXXXXX", CACHE_PATH_SIZE - 64, folder);
    if (!mkdtemp(work->folder)) return false;
    snprintf(work->text, sizeof work->text, "%s/lobe.c", work->folder);
    snprintf(work->loops, sizeof work->loops, "%s/loops.o", work->folder);
    snprintf(work->library, sizeof work->library, "%s/lobe.so", work->folder);
    snprintf(work->log, sizeof work->log, "%s/log", work->folder);
    return true;
}

/* Removes a folder and the files in it. */
static void remove_folder(const char *folder) {
    DIR *entries = opendir(folder);
    char path[PATH_SIZE + 256];
    for (struct dirent *entry; entries && (entry = readdir(entries));)
        if ((size_t)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) < sizeof path) unlink(path);
    if (entries) closedir(entries);
    rmdir(folder);
}

/* Removes what the user's compilations have left that were killed more than an hour ago. */
static void sweep(const char *folder) {
    DIR *entries = opendir(folder);
    char path[CACHE_PATH_SIZE];
    struct stat status;
    for (struct dirent *entry; entries && (entry = readdir(entries));)
        if (strncmp(entry->d_name, WORK_NAME, sizeof WORK_NAME - 1) == 0 &&
            (size_t)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) < sizeof path &&
            cache_is_private(path) && lstat(path, &status) == 0 && status.st_mtime < time(NULL) - 3600)
            remove_folder(path);
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
    return process_run(arguments, bounds, work->folder, work->log);
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

/* Returns true if a linker wrote a line: it begins with the linker's name or that of an object file. */
static bool is_linkers(const char *line) {
    size_t size = strcspn(line, ":");
    const char *base = line;
    for (const char *c = line; c < line + size; c++)
        if (*c == '/') base = c + 1;
    bool object = size > 2 && memcmp(line + size - 2, ".o", 2) == 0;
    return object || (line[size] && memcmp(base, "ld", 2) == 0);
}

/* Fails with the part of a linker's line that names a symbol or a file. */
static WeftResult fail_link(const char *line, const char *path, WeftError *error) {
    static const char *const beginnings[] = {"undefined ", "hidden symbol", "multiple definition", "cannot find"};
    const char *words = line;
    for (size_t k = 0; k < sizeof beginnings / sizeof *beginnings; k++) {
        const char *found = strstr(line, beginnings[k]);
        if (found) words = found;
    }
    return fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "%s", words);
}

/* Returns the reason why a disk takes no more, if a line gives one; else NULL. */
static const char *disk_reason(const char *line) {
    static const int reasons[] = {ENOSPC, EDQUOT, EFBIG, EROFS};
    for (size_t k = 0; k < sizeof reasons / sizeof *reasons; k++)
        if (strstr(line, strerror(reasons[k]))) return strerror(reasons[k]);
    return NULL;
}

/* Fails with the compiler's first error, or the linker's, else its last line. */
static WeftResult fail_compile(const CompileWork *work, const char *path, const char *file, WeftError *error) {
    FileBytes log;
    const char *first = NULL, *link = NULL, *last = NULL, *disk = NULL;
    int count = 0;
    if (file_read_start(work->log, 1 << 20, &log, NULL) != WEFT_OK)
        return fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, NULL);
    char *rest = NULL;
    for (char *line = strtok_r((char *)log.data, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        last = line;
        if (!disk) disk = disk_reason(line);
        bool linkers = is_linkers(line) || strstr(line, "undefined reference to ");
        if (!link && linkers && !strstr(line, "in function") && !strstr(line, "follow")) link = line;
        if (strstr(line, "error: ") && !count++) first = line;
    }
    WeftResult result = disk    ? fail(error, WEFT_MESSAGE_FILE_WRITE, work->folder, "%s", disk)
                        : link  ? fail_link(link, path, error)
                        : first ? fail_line(first, path, file, count - 1, error)
                                : fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "the compiler fails%s%s",
                                       last ? ": " : "", last ? last : "");
    free(log.data);
    return result;
}

static WeftResult interrupted(const char *path, WeftError *error) {
    if (!error) return WEFT_INTERRUPTED;
    error->result = WEFT_INTERRUPTED;
    error->message = WEFT_MESSAGE_NONE;
    snprintf(error->text, sizeof error->text, "%.200s: interrupted while it was compiled", path);
    return WEFT_INTERRUPTED;
}

static WeftResult write_text(const CompileWork *work, const Buffer *text, WeftError *error) {
    FILE *stream = fopen(work->text, "wb");
    if (!stream) return fail(error, WEFT_MESSAGE_FILE_WRITE, work->text, "%s", strerror(errno));
    fwrite(text->bytes, 1, text->size, stream);
    const char *earlier = ferror(stream) ? stream_reason(stream) : NULL;
    if (fclose(stream) == 0 && !earlier) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_FILE_WRITE, work->text, "%s", earlier ? earlier : strerror(errno));
}

static WeftResult compile(const CompileWork *work, const Compiler *compiler, const Buffer *text, const char *path,
                          const char *file, WeftError *error) {
    WeftResult result = write_text(work, text, error);
    for (int half = 0; half < 2 && result == WEFT_OK; half++) {
        int code = compile_half(work, compiler, half);
        if (code == PROCESS_MISSING)
            result = fail(error, WEFT_MESSAGE_COMPILER, path, "install one, or name it by $CC");
        else if (code == PROCESS_LOST)
            result =
                fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "the compiler cannot be waited for; is SIGCHLD ignored?");
        else if (code == PROCESS_LATE)
            result = fail(error, WEFT_MESSAGE_LOBE_COMPILE, path,
                          "the compiler takes more than %d s, or %d s of processor time", bounds.seconds,
                          bounds.cpu_seconds);
        else if (code == PROCESS_STOPPED)
            result = interrupted(path, error);
        else if (code != 0)
            result = fail_compile(work, path, file, error);
    }
    return result;
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
    static const char form[] = "sealed"; /* of the file; another form needs another word here */
    uint64_t hash = cache_hash(cache_hash(CACHE_HASH, form, sizeof form), text->bytes, text->size);
    for (int k = 0; k < compiler->count; k++)
        hash = cache_hash(hash, compiler->words[k], strlen(compiler->words[k]) + 1);
    for (int half = 0; half < 2; half++)
        for (int k = 0; half_flags[half][k]; k++)
            hash = cache_hash(hash, half_flags[half][k], strlen(half_flags[half][k]) + 1);
    return hash;
}

/* Returns true if there is a cache in which nobody else can write, since a loaded file is run. Sets its folder. */
static bool find_cache(char folder[CACHE_PATH_SIZE]) {
    if (!cache_folder_make() || !cache_path(folder, 0, "")) return false;
    *strrchr(folder, '/') = 0;
    return cache_is_private(folder);
}

/* Copies a compiled library to the cache. Returns true if it is there. */
static bool keep(const char *library, uint64_t key, const WeftLog *log) {
    FileBytes bytes;
    if (file_read(library, 1 << 28, &bytes, NULL) != WEFT_OK) return false;
    bool kept = cache_seal(key, "so", bytes.data, bytes.size, log);
    free(bytes.data);
    return kept;
}

/* A library that is made. */
typedef struct Compiling {
    const Compiler *compiler;
    const Buffer *text;
    const char *path, *file; /* of the lobe, and its name in the text */
    const char *cache;       /* the folder of the cache, or NULL */
    uint64_t key;
    const WeftLog *log;
} Compiling;

/* Fails with dlerror's reason, without the name of a file that is gone when it is read. */
static WeftResult fail_load(const CompileWork *work, const char *path, WeftError *error) {
    const char *why = dlerror();
    size_t size = strlen(work->library);
    if (why && strncmp(why, work->library, size) == 0 && strncmp(why + size, ": ", 2) == 0) why += size + 2;
    return fail(error, WEFT_MESSAGE_LOBE_COMPILE, path, "it cannot be loaded%s%s", why ? ": " : "", why ? why : "");
}

/* Makes and loads a library in a folder of its own inside `folder`. */
static WeftResult make_in(const Compiling *making, const char *folder, const Plugin **out, WeftError *error) {
    CompileWork work;
    char cached[CACHE_PATH_SIZE];
    if (!work_begin(&work, folder)) return fail(error, WEFT_MESSAGE_FILE_WRITE, folder, "%s", strerror(errno));
    WeftResult result = compile(&work, making->compiler, making->text, making->path, making->file, error);
    if (result == WEFT_OK) {
        if (making->cache && keep(work.library, making->key, making->log) && cache_path(cached, making->key, "so"))
            *out = load(cached);
        if (!*out) *out = load(work.library);
        if (!*out) result = fail_load(&work, making->path, error);
    }
    remove_folder(work.folder);
    if (result == WEFT_INTERRUPTED) process_signal_pass();
    return result;
}

/* Makes a library in the folder for temporary files, or in the cache where that folder takes none. */
static WeftResult make(const Compiling *making, const Plugin **out, WeftError *error) {
    const char *temporary = getenv("TMPDIR");
    if (!temporary || temporary[0] != '/') temporary = "/tmp";
    const char *const folders[] = {temporary, making->cache};
    WeftResult result = WEFT_OK;
    for (int k = 0; k < 2 && folders[k]; k++) {
        WeftError failure = {0};
        sweep(folders[k]);
        WeftResult made = make_in(making, folders[k], out, &failure);
        if (k == 0 || made == WEFT_OK || failure.message != WEFT_MESSAGE_FILE_WRITE) {
            result = made;
            if (error) *error = failure;
        }
        if (failure.message != WEFT_MESSAGE_FILE_WRITE || made == WEFT_OK) break;
    }
    return result;
}

WeftResult plugin_make(const LobeNames *names, const char *path, const char *bytes, const Plugin **out,
                       const WeftLog *log, WeftError *error) {
    Flat flat = {0};
    Compiler compiler;
    char cache[CACHE_PATH_SIZE], cached[CACHE_PATH_SIZE], file[128];
    if (!compiler_choose(&compiler))
        return fail(error, WEFT_MESSAGE_COMPILER, path, "$CC has more than %d characters or %d words",
                    COMPILER_SIZE - 1, COMPILER_WORDS);
    put_plugin(&flat, names, bytes);
    if (flat.text.failed) {
        buffer_free(&flat.text);
        return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    }
    snprintf(file, sizeof file, "%s.h", names->prefix);
    bool caches = find_cache(cache);
    if (!caches) warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "there is no folder of the user's own to keep it in");
    const Compiling making = {&compiler, &flat.text, path, file, caches ? cache : NULL, key_of(&flat.text, &compiler),
                              log};
    WeftResult result = WEFT_OK;
    bool kept = caches && cache_is_sealed(making.key, "so", log) && cache_path(cached, making.key, "so");
    *out = kept ? load(cached) : NULL;
    if (!*out) result = make(&making, out, error);
    buffer_free(&flat.text);
    return result;
}
