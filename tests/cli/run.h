/* run.h - running the real program: its output, its complaints, its exit code
 *
 * A test program calls work_begin first and work_end last: between them there is a folder for files, of which
 * run() makes the current one. */
#ifndef WEFT_TESTS_CLI_RUN_H
#define WEFT_TESTS_CLI_RUN_H

#include <dirent.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/steady_clock.h"
#include "scratch.h"

extern char **environ;

static char work_folder[SCRATCH_SIZE];

static inline int work_begin(void **state) {
    (void)state;
    return scratch_enter(work_folder) ? 0 : -1;
}

static inline int work_end(void **state) {
    (void)state;
    DIR *folder = opendir(work_folder);
    if (!folder) return -1;
    for (struct dirent *entry; (entry = readdir(folder));) unlink(entry->d_name);
    closedir(folder);
    return scratch_remove_empty(work_folder) ? 0 : -1;
}

/* The bytes of a file, a zero after them; NULL where there is no file. Release with free. */
static inline char *file_bytes(const char *path, size_t *size) {
    FILE *stream = fopen(path, "rb");
    *size = 0;
    if (!stream) return NULL;
    fseek(stream, 0, SEEK_END);
    *size = (size_t)ftell(stream);
    rewind(stream);
    char *bytes = calloc(*size + 1, 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, stream), *size);
    fclose(stream);
    return bytes;
}

static inline void file_make(const char *path, const void *bytes, size_t size) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static inline bool same_bytes(const char *path, const char *bytes, size_t size) {
    size_t found;
    char *own = file_bytes(path, &found);
    bool same = own && found == size && memcmp(own, bytes, size) == 0;
    free(own);
    return same;
}

/* What a program that has ended left. */
typedef struct Ran {
    int code;        /* exit code, or 128 + the signal that ended it */
    char *out, *err; /* what it printed */
} Ran;

/* Starts a program with its output in the files "stdout" and "stderr" and input (may be NULL) from "stdin".
 */
static inline pid_t program_start(const char *program, const char *input, const char *const *arguments) {
    char *vector[64] = {(char *)(uintptr_t)program};
    for (int k = 0; arguments[k] && k < 62; k++) vector[k + 1] = (char *)(uintptr_t)arguments[k];
    file_make("stdin", input ? input : "", input ? strlen(input) : 0);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "stdin", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, "stdout", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&files, 2, "stderr", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    sigset_t usual; /* whoever started the tests may ignore these */
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    sigaddset(&usual, SIGINT);
    sigaddset(&usual, SIGHUP);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t child;
    assert_int_equal(posix_spawn(&child, program, &files, &attributes, vector, environ), 0);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    return child;
}

static inline Ran program_end(pid_t child) {
    int status;
    size_t size;
    assert_int_equal(waitpid(child, &status, 0), child);
    return (Ran){.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                 .out = file_bytes("stdout", &size),
                 .err = file_bytes("stderr", &size)};
}

static inline void ran_free(Ran *ran) {
    free(ran->out);
    free(ran->err);
    *ran = (Ran){0};
}

/* weft ARGUMENTS, with input on its standard input. */
static inline Ran run_with(const char *input, const char *const *arguments) {
    return program_end(program_start(WEFT_PROGRAM, input, arguments));
}
#define LIST(...) ((const char *const[]){__VA_ARGS__, NULL})
#define RUN(...)  run_with(NULL, LIST(__VA_ARGS__))

/* A shell line in which $0 is the program. */
static inline Ran run_shell(const char *line) {
    return program_end(program_start("/bin/sh", NULL, LIST("-c", line, WEFT_PROGRAM)));
}

/* Whether text is exactly one line that starts with "weft: ". */
static inline bool one_complaint(const char *text) {
    const char *end = strchr(text, '\n');
    return strncmp(text, "weft: ", 6) == 0 && end && end[1] == '\0';
}

/* The program must end with code and one line that holds `part`, and print nothing else. */
static inline void assert_complaint(const char *input, const char *const *arguments, int code, const char *part) {
    Ran ran = run_with(input, arguments);
    if (ran.code != code || !one_complaint(ran.err) || !strstr(ran.err, part) || ran.out[0])
        fail_msg("expected %d and \"%s\", got %d, \"%s\", and on standard output \"%.200s\"", code, part, ran.code,
                 ran.err, ran.out);
    ran_free(&ran);
}

static inline void sleep_seconds(double seconds) {
    struct timespec pause = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&pause, NULL);
}

/* Writes "scene.gltf": one triangle that fills most of the view, a material "cloth", a camera "front". */
static inline void scene_make(void) {
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0},{\"camera\":0,\"translation\":[0,0,3]}],"
        "\"cameras\":[{\"name\":\"front\",\"type\":\"perspective\",\"perspective\":{\"yfov\":0.6,\"znear\":0."
        "1}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
        "\"materials\":[{\"name\":\"cloth\",\"doubleSided\":true,\"extensions\":{\"KHR_materials_sheen\":"
        "{\"sheenColorFactor\":[1,0.5,0.2],\"sheenRoughnessFactor\":0.5}}}],"
        "\"extensionsUsed\":[\"KHR_materials_sheen\"],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[-1,-1,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}]}";
    file_make("scene.gltf", text, sizeof text - 1);
}

/* work_begin, with the scene. */
static inline int scene_begin(void **state) {
    if (work_begin(state) != 0) return -1;
    scene_make();
    return 0;
}

/* Waits until a program handles SIGINT: the bit of SigCgt in /proc/PID/status, proc(5). */
static inline void await_handler(pid_t child) {
    char path[64], text[4096];
    unsigned long long caught = 0;
    snprintf(path, sizeof path, "/proc/%d/status", (int)child);
    for (double start = clock_now(); !(caught >> (SIGINT - 1) & 1u) && clock_now() < start + 60.0;) {
        FILE *stream = fopen(path, "r");
        size_t size = stream ? fread(text, 1, sizeof text - 1, stream) : 0;
        if (stream) fclose(stream);
        text[size] = '\0';
        const char *line = strstr(text, "SigCgt:");
        caught = line ? strtoull(line + strlen("SigCgt:"), NULL, 16) : 0;
    }
}

#endif
