/* u3m_text.h - a U3M file of defaults, whose members tests replace */
#ifndef WEFT_TESTS_U3M_TEXT_H
#define WEFT_TESTS_U3M_TEXT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { U3M_TEXT = 16384 };

#define U3M_NUMBER_OF(x) "{\"constant\":" x ",\"texture\":null}"
#define U3M_GREY         "{\"constant\":{\"r\":1,\"g\":1,\"b\":1},\"texture\":null}"
#define U3M_FLAT         "{\"constant\":{\"x\":0,\"y\":0,\"z\":1},\"texture\":null}"

/* A visual part with the defaults of the schema. */
/* clang-format off */
#define U3M_VISUAL \
    "{\"shader\":\"principled\",\"preview\":null,\"alpha\":" U3M_NUMBER_OF("1") ",\"anisotropy_value\":" \
    U3M_NUMBER_OF("0") ",\"anisotropy_rotation\":" U3M_NUMBER_OF("0") ",\"clearcoat_value\":" \
    U3M_NUMBER_OF("0") ",\"clearcoat_normal\":" U3M_FLAT ",\"clearcoat_roughness\":" U3M_NUMBER_OF("0") \
    ",\"ior\":" U3M_NUMBER_OF("1.4") ",\"metalness\":" U3M_NUMBER_OF("0") ",\"normal\":" U3M_FLAT \
    ",\"displacement\":" U3M_NUMBER_OF("0") ",\"roughness\":" U3M_NUMBER_OF("0.7") ",\"sheen_value\":" \
    U3M_NUMBER_OF("0") ",\"sheen_tint\":" U3M_NUMBER_OF("0") ",\"specular_value\":" U3M_NUMBER_OF("0.5") \
    ",\"specular_tint\":" U3M_NUMBER_OF("0") ",\"subsurface_radius\":" U3M_NUMBER_OF("0") \
    ",\"subsurface_value\":" U3M_NUMBER_OF("0") ",\"transmission\":" U3M_NUMBER_OF("0") \
    ",\"basecolor\":" U3M_GREY ",\"subsurface_color\":" U3M_GREY "}"
/* clang-format on */

#define U3M_BEFORE                                                                                                     \
    "{\"schema\":\"1.1\",\"custom\":null,\"material\":{\"id\":\"{45d231aa-96a0-4d94-9aae-4a99fae0e32a}\",\"name\":"    \
    "\"cloth\",\"description\":\"\",\"created\":\"2026-01-01T00:00:00Z\",\"modified\":\"2026-01-01T00:00:00Z\","       \
    "\"side\":null,\"metadata\":null,"

/* Replaces the value of the first member of that name, quotes included, which has no string with brackets in it. */
static inline void u3m_put(char text[U3M_TEXT], const char *name, const char *value) {
    char *at = strstr(text, name), rest[U3M_TEXT];
    if (!at) abort();
    at += strlen(name) + 1;
    const char *end = at;
    int depth = 0;
    for (; *end && (depth || (*end != ',' && *end != '}')); end++) depth += (*end == '{') - (*end == '}');
    snprintf(rest, sizeof rest, "%s", end);
    snprintf(at, U3M_TEXT - (size_t)(at - text), "%s%s", value, rest);
}

/* Writes a file of a front alone, one member of which is replaced. */
static inline void u3m_text(char text[U3M_TEXT], const char *name, const char *value) {
    snprintf(text, U3M_TEXT, "%s\"back\":null,\"physics\":null,\"front\":%s}}", U3M_BEFORE, U3M_VISUAL);
    u3m_put(text, name, value);
}

#endif
