#include "view/files/record.h"

#include <math.h>
#include <string.h>

enum { FLOATS_MOST = 8 };

static json_t *member_json(const char *at, const RecordMember *member) {
    float x[FLOATS_MOST];
    int whole;
    bool on;
    if (member->kind == MEMBER_SWITCH) {
        memcpy(&on, at, sizeof on);
        return json_boolean(on);
    }
    if (member->kind == MEMBER_WHOLE) {
        memcpy(&whole, at, sizeof whole);
        return json_integer(whole);
    }
    json_t *array = json_array();
    memcpy(x, at, (size_t)member->most * sizeof *x);
    for (int k = 0; k < member->most; k++) json_array_append_new(array, json_real((double)x[k]));
    return array;
}

json_t *record_write(const void *record, const RecordMember *members, size_t count) {
    json_t *object = json_object();
    for (size_t k = 0; k < count; k++)
        json_object_set_new(object, members[k].name,
                            member_json((const char *)record + members[k].offset, &members[k]));
    return object;
}

bool record_whole(const json_t *object, const char *key, int low, int high, int *value) {
    const json_t *number = json_object_get(object, key);
    const json_int_t x = json_integer_value(number);
    if (!json_is_integer(number) || x < low || x > high) return false;
    *value = (int)x;
    return true;
}

static bool read_floats(const json_t *array, int count, char *at) {
    float x[FLOATS_MOST];
    if (!json_is_array(array) || json_array_size(array) != (size_t)count) return false;
    for (int k = 0; k < count; k++) {
        const json_t *number = json_array_get(array, (size_t)k);
        x[k] = (float)json_number_value(number);
        if (!json_is_number(number) || !isfinite(x[k])) return false;
    }
    memcpy(at, x, (size_t)count * sizeof *x);
    return true;
}

bool record_read(const json_t *object, const RecordMember *members, size_t count, void *record) {
    for (size_t k = 0; k < count; k++) {
        const json_t *value = json_object_get(object, members[k].name);
        char *at = (char *)record + members[k].offset;
        int whole;
        if (members[k].kind == MEMBER_FLOATS) {
            if (!read_floats(value, members[k].most, at)) return false;
        } else if (members[k].kind == MEMBER_WHOLE) {
            if (!record_whole(object, members[k].name, 0, members[k].most, &whole)) return false;
            memcpy(at, &whole, sizeof whole);
        } else {
            const bool on = json_is_true(value);
            if (!json_is_boolean(value)) return false;
            memcpy(at, &on, sizeof on);
        }
    }
    return true;
}
