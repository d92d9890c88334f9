/* record.h - records as JSON, by a table of their members */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include <jansson.h>

typedef enum MemberKind { MEMBER_FLOATS, MEMBER_WHOLE, MEMBER_SWITCH } MemberKind;

/* A member of a record: up to eight floats, an int or enumeration from 0 to `most`, or a bool. */
typedef struct RecordMember {
    const char *name;
    size_t offset;
    MemberKind kind;
    int most; /* FLOATS: their number */
} RecordMember;

#define RECORD_FLOATS(type, name, count)                                                                               \
    { #name, offsetof(type, name), MEMBER_FLOATS, count }
#define RECORD_WHOLE(type, name, most)                                                                                 \
    { #name, offsetof(type, name), MEMBER_WHOLE, most }
#define RECORD_SWITCH(type, name)                                                                                      \
    { #name, offsetof(type, name), MEMBER_SWITCH, 1 }

/* Returns the members of a record as an object. */
json_t *record_write(const void *record, const RecordMember *members, size_t count);

/* Reads all of the members. Returns false, with some of them read, if one is missing or out of its range, or a float is
 * not finite. */
bool record_read(const json_t *object, const RecordMember *members, size_t count, void *record);

/* Reads a whole number from low to high; false if there is none. */
bool record_whole(const json_t *object, const char *key, int low, int high, int *value);
