/* IETF, RFC 3986 "Uniform Resource Identifier", 2005; RFC 2397 "The data URL scheme", 1998; RFC 4648 "The
 * Base16, Base32, and Base64 Data Encodings", 2006. */
#include "gltf/asset/uri.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "gltf/asset/enclosure.h"

bool uri_is_data(const char *uri) { return strncasecmp(uri, "data:", 5) == 0; }

static int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

static unsigned char *base64_decode(const Field *field, const char *text, size_t *size) {
    size_t length = strlen(text);
    for (int pad = 0; pad < 2 && length && text[length - 1] == '='; pad++) length--;
    unsigned char *bytes = alloc_array(length / 4 * 3 + 3, 1);
    if (!bytes) {
        asset_fail(field->asset, WEFT_MESSAGE_MEMORY, NULL);
        return NULL;
    }
    size_t count = 0;
    uint32_t bits = 0;
    for (size_t i = 0; i < length; i++) {
        int digit = base64_digit(text[i]);
        if (digit < 0 || (i + 1 == length && length % 4 == 1)) {
            field_fail(field, WEFT_MESSAGE_GLTF_URI, "its base64 is damaged at character %zu", i);
            free(bytes);
            return NULL;
        }
        bits = bits << 6 | (uint32_t)digit;
        if (i % 4) bytes[count++] = (unsigned char)(bits >> (6 - 2 * (i % 4)));
    }
    *size = count;
    return bytes;
}

static int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/* Returns the byte of the two hexadecimal digits that follow a %; -1 where there are none. */
static int escaped_byte(const char *percent) {
    int high = hex_digit(percent[1]), low = high < 0 ? -1 : hex_digit(percent[2]);
    return low < 0 ? -1 : high << 4 | low;
}

bool uri_unescape(char *text) {
    char *out = text;
    for (const char *in = text; *in; in++) {
        if (*in != '%') {
            *out++ = *in;
            continue;
        }
        int byte = escaped_byte(in);
        if (byte <= 0) return false;
        *out++ = (char)byte;
        in += 2;
    }
    *out = 0;
    return true;
}

/* Returns true for what stands for itself in the data of a URI: the characters that RFC 2397 names. */
static bool is_plain(char c) { return base64_digit(c) >= 0 || (c && strchr("-_.!~*'();?:@&=$,", c)); }

static unsigned char *percent_decode(const Field *field, const char *text, size_t *size) {
    unsigned char *bytes = alloc_array(strlen(text) + 1, 1);
    if (!bytes) {
        asset_fail(field->asset, WEFT_MESSAGE_MEMORY, NULL);
        return NULL;
    }
    size_t count = 0;
    for (const char *in = text; *in; in++) {
        int byte = *in == '%' ? escaped_byte(in) : is_plain(*in) ? *in : -1;
        if (byte < 0) {
            field_fail(field, WEFT_MESSAGE_GLTF_URI,
                       *in == '%' ? "its percent-encoding is damaged at character %zu"
                                  : "its character %zu must be percent-encoded",
                       (size_t)(in - text));
            free(bytes);
            return NULL;
        }
        if (*in == '%') in += 2;
        bytes[count++] = (unsigned char)byte;
    }
    *size = count;
    return bytes;
}

unsigned char *uri_decode(const Field *field, const char *uri, size_t *size) {
    static const char base64[] = ";base64";
    const char *comma = strchr(uri, ',');
    if (!comma) {
        field_fail(field, WEFT_MESSAGE_GLTF_URI, "a data URI needs a comma before its data");
        return NULL;
    }
    const size_t before = (size_t)(comma - uri), length = strlen(base64);
    const bool encoded = before >= length && strncasecmp(comma - length, base64, length) == 0;
    return encoded ? base64_decode(field, comma + 1, size) : percent_decode(field, comma + 1, size);
}

static bool has_scheme(const char *uri) {
    size_t name = strspn(uri, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.");
    return name && uri[name] == ':';
}

/* Returns uri behind the asset's folder, whose length is set, in the asset's arena; NULL after a sticky failure. */
static char *joined(const Field *field, const char *uri, size_t *folder) {
    Asset *asset = field->asset;
    const char *slash = strrchr(asset->name, '/');
    const size_t length = strlen(uri);
    *folder = slash ? (size_t)(slash - asset->name) + 1 : 0;
    char *path = arena_array(&asset->arena, *folder + length + 1, 1);
    if (!path) {
        asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
        return NULL;
    }
    memcpy(path, asset->name, *folder);
    memcpy(path + *folder, uri, length + 1);
    return path;
}

/* Turns the backslashes of a name that a program for Windows wrote into slashes, with a warning, unless a file has just
 * that name. */
static void separators_repair(const Field *field, char *path, size_t folder) {
    if (!strchr(path + folder, '\\') || access(path, F_OK) == 0) return;
    field_warn(field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "%.80s: its backslashes are taken as slashes", path + folder);
    for (char *c = path + folder; *c; c++)
        if (*c == '\\') *c = '/';
}

/* Removes percent-encoding from the name. Returns why it is not one of a file beside the asset; NULL if it is. */
static const char *refusal(const Field *field, const char *uri, char *path, size_t folder) {
    char *name = path + folder;
    if (has_scheme(uri)) return "only files and data URIs can be read";
    if (!uri_unescape(name)) return "its percent-encoding is damaged";
    separators_repair(field, path, folder);
    if (!*name) return "it is empty";
    if (*name == '/') return "an absolute path is refused";
    return NULL;
}

char *uri_path(const Field *field, const char *uri) {
    char out[200], outside[300];
    size_t folder;
    char *path = joined(field, uri, &folder);
    if (!path) return NULL;
    const char *reason = refusal(field, uri, path, folder);
    if (!reason && field->asset->in_memory)
        reason = leaves_folder(path + folder) ? "a path out of the asset's folder is refused"
                                              : "an asset in memory cannot refer to files";
    if (!reason && !is_enclosed(path, folder, out, sizeof out)) {
        snprintf(outside, sizeof outside, "a %s out of the asset's folder is refused; --root %s lets it in",
                 leaves_folder(path + folder) ? "path" : "link", out);
        reason = outside;
    }
    if (!reason) return path;
    field_fail(field, WEFT_MESSAGE_GLTF_URI, "%.80s: %s", uri, reason);
    return NULL;
}

char *uri_path_to_write(const Field *field, const char *uri) {
    size_t folder;
    char *path = joined(field, uri, &folder);
    const char *reason = path ? refusal(field, uri, path, folder) : NULL;
    if (path && !reason && leaves_folder(path + folder)) reason = "a path out of the asset's folder is refused";
    if (!path || !reason) return path;
    field_fail(field, WEFT_MESSAGE_GLTF_URI, "%.80s: %s", uri, reason);
    return NULL;
}
