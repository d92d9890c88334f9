/* drive.h - driving the window by a script, and reading what it says of itself
 *
 * As in cli/run.h there is a folder for files between drive_begin and drive_end; scripts are run in it. */
#ifndef WEFT_TESTS_VIEW_DRIVE_H
#define WEFT_TESTS_VIEW_DRIVE_H

#define _XOPEN_SOURCE 700
#include "cli/run.h"

#include <jansson.h>
#include <math.h>
#include <sys/stat.h>

#include "base/folder.h"
#include "raster/gl.h"
#include "weft/weft.h"

/* A piece of cloth under a sun alone: drawn and traced at once. */
#define CHEAP                                                                                                          \
    "builtin:cloth", "--set", "Softbox.emission=0", "--env", "0,0,0", "--light", "sun;-1,-2,-1;3,3,3", "--occlusion",  \
        "0"
#define UNSEEN "view", "--windowless", "--forget", "--json", "--width", "640", "--height", "420"

static inline int drive_begin(void **state) { return work_begin(state) || gl_begin(state) ? -1 : 0; }

static inline int drive_end(void **state) {
    (void)state;
    return chdir("/") == 0 && folder_remove_all(work_folder) ? 0 : -1;
}

/* A window that is being driven. */
typedef struct Drive {
    pid_t child;
    long read; /* bytes of what it said */
} Drive;

static inline Drive drive_start(const char *script, const char *const *arguments) {
    const char *vector[48] = {NULL};
    int count = 0;
    while (arguments[count]) vector[count] = arguments[count], count++;
    if (script) {
        file_make("script", script, strlen(script));
        vector[count++] = "--script";
        vector[count++] = "script";
    }
    return (Drive){.child = program_start(WEFT_PROGRAM, NULL, vector)};
}

static inline bool drive_ended(const Drive *drive) {
    siginfo_t info = {0};
    return waitid(P_PID, (id_t)drive->child, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
}

static inline void drive_give_up(Drive *drive, const char *why) {
    size_t size;
    int status = 0;
    if (!drive_ended(drive)) kill(drive->child, SIGKILL);
    waitpid(drive->child, &status, 0);
    char *out = file_bytes("stdout", &size), *err = file_bytes("stderr", &size);
    char *last = out ? strstr(out, "\"message\"") : NULL;
    for (char *p = last; p; p = strstr(p + 1, "\"message\"")) last = p;
    print_message("%s: ended with %d by signal %d, said \"%s\", last %.200s\n", why, WEXITSTATUS(status),
                  WIFSIGNALED(status) ? WTERMSIG(status) : 0, err ? err : "", last ? last : "nothing");
    free(out);
    free(err);
    fail_msg("%s", why);
}

/* The next line that was not read yet; NULL where there is none so far. */
static inline json_t *drive_next(Drive *drive) {
    FILE *stream = fopen("stdout", "rb");
    char *line = NULL;
    size_t room = 0;
    json_t *state = NULL;
    assert_non_null(stream);
    fseek(stream, drive->read, SEEK_SET);
    ssize_t length = getline(&line, &room, stream);
    if (length > 0 && line[length - 1] == '\n') {
        drive->read += length;
        state = json_loads(line, 0, NULL);
        assert_non_null(state);
        const json_t *untold = json_object_get(state, "untold"); /* every control tells what it is for */
        if (json_array_size(untold)) fail_msg("%s says nothing", json_string_value(json_array_get(untold, 0)));
    }
    free(line);
    fclose(stream);
    return state;
}

static inline const char *word_of(const json_t *state, const char *key) {
    const char *text = json_string_value(json_object_get(state, key));
    return text ? text : "";
}
static inline double number_of(const json_t *state, const char *key) {
    return json_number_value(json_object_get(state, key));
}
static inline bool is_true(const json_t *state, const char *key) { return json_is_true(json_object_get(state, key)); }

/* The next state whose text `key` holds `part`. Release with json_decref. */
static inline json_t *drive_until(Drive *drive, const char *key, const char *part) {
    double start = clock_now();
    char why[256];
    for (;;) {
        bool ended = drive_ended(drive);
        json_t *state = drive_next(drive);
        if (state && strstr(word_of(state, key), part)) return state;
        if (!state && (ended || clock_now() - start > 100.0)) {
            snprintf(why, sizeof why, "%s never was \"%s\"", key, part);
            drive_give_up(drive, why);
        }
        if (!state) sleep_seconds(0.02);
        json_decref(state);
    }
}

/* The last state so far, after one was waited for that is at rest. */
static inline json_t *drive_rest(Drive *drive) {
    double start = clock_now();
    for (json_t *rest = NULL;;) {
        bool ended = drive_ended(drive);
        json_t *state = drive_next(drive);
        if (state && is_true(state, "rest")) {
            json_decref(rest);
            rest = state;
            continue;
        }
        if (state) json_decref(rest), json_decref(state), rest = NULL;
        if (rest && !state) return rest;
        if (!state && (ended || clock_now() - start > 100.0)) drive_give_up(drive, "it never came to rest");
        if (!state) sleep_seconds(0.05);
    }
}

/* It must end by itself, well, and without a word on standard error. */
static inline void drive_finish_within(Drive *drive, double seconds) {
    double start = clock_now();
    while (!drive_ended(drive) && clock_now() - start < seconds) sleep_seconds(0.02);
    if (!drive_ended(drive)) drive_give_up(drive, "it did not end");
    Ran ran = program_end(drive->child);
    if (ran.code != 0 || ran.err[0]) fail_msg("ended with %d: \"%s\"", ran.code, ran.err);
    ran_free(&ran);
}

static inline void drive_finish(Drive *drive) { drive_finish_within(drive, 200.0); }

/* Runs a script to its end. */
static inline void drive_through(const char *script, const char *const *arguments) {
    Drive drive = drive_start(script, arguments);
    drive_finish(&drive);
}

static inline json_t *material_of(const json_t *state, int index) {
    return json_array_get(json_object_get(state, "materials"), (size_t)index);
}

/* Number k of a material's input; 3 is above 0 where the input has a map. */
static inline double input_of(const json_t *state, int material, const char *input, int k) {
    return json_number_value(json_array_get(json_object_get(material_of(state, material), input), (size_t)k));
}

/* The state that tells of a picture of that name. Release with json_decref. */
static inline json_t *drive_picture(Drive *drive, const char *picture) {
    char wrote[80];
    snprintf(wrote, sizeof wrote, "wrote %s", picture);
    return drive_until(drive, "message", wrote);
}

static inline WeftImage picture_read(const char *path) {
    WeftImage image;
    WeftError error;
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

/* A script that is being written; empty it with script_begin. */
static char script[65536];

static inline void script_begin(void) { script[0] = '\0'; }

static inline void say(const char *format, ...) {
    size_t used = strlen(script);
    va_list list;
    va_start(list, format);
    int more = vsnprintf(script + used, sizeof script - used, format, list);
    va_end(list);
    assert_true(more >= 0 && (size_t)more < sizeof script - used);
}

/* A picture, which is waited for. */
static inline void say_picture(const char *path) { say("wait rest\npicture %s\nwait message wrote %s\n", path, path); }

/* The same, and a rest behind it in which the window tells its state. */
static inline void say_rested_picture(const char *path) {
    say_picture(path);
    say("wait rest\n");
}

/* relMSE of two pictures on disk. */
static inline double pictures_differ(const char *a, const char *b) {
    WeftImage x = picture_read(a), y = picture_read(b);
    WeftDifference difference;
    WeftError error = {0};
    if (weft_difference(&x, &y, &difference, &error) != WEFT_OK) fail_msg("%s %s: %s", a, b, error.text);
    weft_image_free(&x);
    weft_image_free(&y);
    return difference.relmse;
}

/* The greatest difference of two pictures' numbers. */
static inline double pictures_most(const char *a, const char *b) {
    WeftImage x = picture_read(a), y = picture_read(b);
    double most = 0.0;
    assert_true(x.width == y.width && x.height == y.height && x.channels == y.channels && x.type == y.type);
    for (int k = 0; k < x.width * x.height * x.channels; k++) {
        double d = x.type == WEFT_PIXEL_U8
                       ? ((const unsigned char *)x.pixels)[k] - ((const unsigned char *)y.pixels)[k]
                       : (double)((const float *)x.pixels)[k] - (double)((const float *)y.pixels)[k];
        most = fmax(most, fabs(d) / (x.type == WEFT_PIXEL_U8 ? 255.0 : 1.0));
    }
    weft_image_free(&x);
    weft_image_free(&y);
    return most;
}

#endif
