/* IETF, RFC 8259 "The JavaScript Object Notation (JSON) Data Interchange Format", 2017. The text has been
 * parsed before, so that only the ends of values are sought here, never errors. */
#include "base/patch.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"

/* The text, read from its start to its end, and the stream that the result is written to. */
typedef struct JsonPatch {
    const char *at, *end;
    FILE *out;
    bool failed;
} JsonPatch;

static void put(JsonPatch *patch, const char *from, const char *to) {
    if (to > from) fwrite(from, 1, (size_t)(to - from), patch->out);
}

static const char *skip_blank(const JsonPatch *patch, const char *at) {
    while (at < patch->end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) at++;
    return at;
}

/* Returns the end of the string that begins at `at`. */
static const char *skip_string(const JsonPatch *patch, const char *at) {
    for (at++; at < patch->end && *at != '"'; at++)
        if (*at == '\\') at++;
    return at < patch->end ? at + 1 : patch->end;
}

/* Returns the end of the value that begins at `at`. */
static const char *skip_value(const JsonPatch *patch, const char *at) {
    int depth = 0;
    while (at < patch->end) {
        char c = *at;
        if (c == '"') {
            at = skip_string(patch, at);
        } else if (c == '{' || c == '[') {
            depth++;
            at++;
        } else if (c == '}' || c == ']') {
            if (--depth >= 0) at++;
        } else if (depth == 0) { /* a number or a word */
            while (at < patch->end && !strchr(" \t\r\n,]}", *at)) at++;
        } else {
            at++;
        }
        if (depth <= 0) break;
    }
    return at;
}

/* Writes a value in the fewest digits that read back as the same numbers. */
static void put_value(JsonPatch *patch, const json_t *value) {
    for (size_t digits = 6; digits <= 17; digits++) {
        const size_t flags = JSON_ENCODE_ANY | JSON_REAL_PRECISION(digits);
        char *text = json_dumps(value, flags);
        json_t *back = text && digits < 17 ? json_loads(text, JSON_DECODE_ANY, NULL) : NULL;
        bool same = back && json_equal(back, value);
        json_decref(back);
        if (text && (same || digits == 17)) fputs(text, patch->out);
        if (!text) patch->failed = true;
        free(text);
        if (!text || same) return;
    }
}

static void put_key(JsonPatch *patch, const char *key) {
    json_t *text = json_string(key);
    if (text)
        put_value(patch, text);
    else
        patch->failed = true;
    json_decref(text);
}

/* The white space of an object or array: from open to first, before its first part, and from last to close. */
typedef struct JsonSetting {
    const char *open, *first, *last, *close;
} JsonSetting;

/* Counts the parts of the object or array at `at`, and finds its white space. */
static size_t survey(const JsonPatch *patch, const char *at, bool object, JsonSetting *setting) {
    size_t count = 0;
    setting->open = at + 1;
    at = setting->first = setting->last = skip_blank(patch, at + 1);
    while (at < patch->end && *at != '}' && *at != ']') {
        if (object) {
            at = skip_blank(patch, skip_string(patch, at)); /* on the colon */
            at = skip_blank(patch, at + 1);
        }
        at = setting->last = skip_value(patch, at);
        count++;
        at = skip_blank(patch, at);
        if (at < patch->end && *at == ',') at = skip_blank(patch, at + 1);
    }
    setting->close = at;
    return count;
}

static void put_changed(JsonPatch *patch, json_t *was, json_t *now);

/* Writes the separator before a new part that is not the first. */
static void put_gap(JsonPatch *patch, const JsonSetting *setting) {
    fputc(',', patch->out);
    put(patch, setting->open, setting->first);
}

/* Returns the value of a key from the text of its string. */
static json_t *key_read(JsonPatch *patch, const char *from, const char *to) {
    bool starved;
    json_t *key = json_parse(from, (size_t)(to - from), JSON_DECODE_ANY, NULL, &starved);
    if (!key) patch->failed = true;
    return key;
}

/* Writes the member at patch->at, copied or changed, after the text from `gap` on. Leaves it out if `now`
 * lacks it. Returns true if it was written. */
static bool put_member(JsonPatch *patch, const char *gap, json_t *was, json_t *now) {
    const char *start = patch->at, *key_end = skip_string(patch, start);
    const char *value = skip_blank(patch, skip_blank(patch, key_end) + 1);
    json_t *key = key_read(patch, start, key_end);
    const char *name = key ? json_string_value(key) : "";
    json_t *after = json_object_get(now, name);
    patch->at = value;
    if (after) {
        put(patch, gap, value);
        put_changed(patch, json_object_get(was, name), after);
    } else {
        patch->at = skip_value(patch, value);
    }
    json_decref(key);
    return after != NULL;
}

/* Moves patch->at past the comma to the next part, if there is one. */
static void step(JsonPatch *patch, const JsonSetting *setting) {
    patch->at = skip_blank(patch, patch->at);
    if (patch->at < setting->close) patch->at = skip_blank(patch, patch->at + 1);
}

static void put_object(JsonPatch *patch, const JsonSetting *setting, json_t *was, json_t *now) {
    size_t written = 0;
    const char *gap = NULL, *key;
    json_t *value;
    fputc('{', patch->out);
    put(patch, setting->open, setting->first);
    patch->at = setting->first;
    while (patch->at < setting->close && !patch->failed) {
        written += put_member(patch, written ? gap : patch->at, was, now);
        gap = patch->at;
        step(patch, setting);
    }
    json_object_foreach(now, key, value) {
        if (json_object_get(was, key)) continue;
        if (written++) put_gap(patch, setting);
        put_key(patch, key);
        fputs(": ", patch->out);
        put_value(patch, value);
    }
    put(patch, setting->last, setting->close + 1);
    patch->at = setting->close + 1;
}

static void put_array(JsonPatch *patch, const JsonSetting *setting, json_t *was, json_t *now) {
    size_t count = json_array_size(was), left = json_array_size(now);
    const char *gap = setting->first;
    fputc('[', patch->out);
    put(patch, setting->open, setting->first);
    patch->at = setting->first;
    for (size_t k = 0; k < count && !patch->failed; k++) {
        if (k < left) {
            put(patch, gap, patch->at);
            put_changed(patch, json_array_get(was, k), json_array_get(now, k));
        } else {
            patch->at = skip_value(patch, patch->at);
        }
        gap = patch->at;
        step(patch, setting);
    }
    for (size_t k = count; k < left; k++) {
        if (k) put_gap(patch, setting);
        put_value(patch, json_array_get(now, k));
    }
    put(patch, setting->last, setting->close + 1);
    patch->at = setting->close + 1;
}

/* Writes the value at patch->at, which is `was`, as `now`. */
static void put_changed(JsonPatch *patch, json_t *was, json_t *now) {
    const char *start = patch->at;
    JsonSetting setting;
    bool objects = json_is_object(was) && json_is_object(now), arrays = json_is_array(was) && json_is_array(now);
    if (json_equal(was, now)) {
        put(patch, start, patch->at = skip_value(patch, start));
    } else if (objects && survey(patch, start, true, &setting) == json_object_size(was)) {
        put_object(patch, &setting, was, now);
    } else if (arrays && survey(patch, start, false, &setting) == json_array_size(was)) {
        put_array(patch, &setting, was, now);
    } else { /* another value; or an object that has a key twice, of which the last counts */
        patch->at = skip_value(patch, start);
        put_value(patch, now);
    }
}

char *patch_text(const char *text, size_t length, json_t *was, json_t *now, size_t *size) {
    char *made = NULL;
    JsonPatch patch = {.at = text, .end = text + length, .out = open_memstream(&made, size)};
    if (!patch.out) return NULL;
    patch.at = skip_blank(&patch, text);
    put(&patch, text, patch.at);
    put_changed(&patch, was, now);
    put(&patch, patch.at, patch.end);
    if (ferror(patch.out)) patch.failed = true;
    if (fclose(patch.out) != 0) patch.failed = true;
    if (!patch.failed) return made;
    free(made);
    return NULL;
}
