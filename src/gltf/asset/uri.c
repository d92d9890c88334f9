/* IETF, RFC 3986 "Uniform Resource Identifier", 2005; RFC 2397 "The data URL scheme", 1998; RFC 4648 "The
 * Base16, Base32, and Base64 Data Encodings", 2006. */
#include "gltf/asset/uri.h"

#include <string.h>
#include <strings.h>

bool uri_is_data(const char *uri) { return strncasecmp(uri, "data:", 5) == 0; }

static int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

unsigned char *uri_decode(const Field *field, const char *uri, size_t *size) {
    const char *comma = strchr(uri, ','), *marker = comma ? comma - strlen(";base64") : NULL;
    if (!comma || marker < uri || strncasecmp(marker, ";base64", strlen(";base64")) != 0) {
        field_fail(field, WEFT_MESSAGE_GLTF_URI, "a data URI must be base64");
        return NULL;
    }
    const char *text = comma + 1;
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

bool uri_unescape(char *text) {
    char *out = text;
    for (const char *in = text; *in; in++) {
        if (*in != '%') {
            *out++ = *in;
            continue;
        }
        int high = hex_digit(in[1]), low = high < 0 ? -1 : hex_digit(in[2]);
        if (low < 0 || high + low == 0) return false;
        *out++ = (char)(high << 4 | low);
        in += 2;
    }
    *out = 0;
    return true;
}

static bool has_scheme(const char *uri) {
    size_t name = strspn(uri, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.");
    return name && uri[name] == ':';
}

/* Returns true if the path leaves the folder that it starts in, at any step. */
static bool leaves_folder(const char *path) {
    int depth = 0;
    while (*path) {
        size_t step = strcspn(path, "/");
        if (step == 2 && path[0] == '.' && path[1] == '.')
            depth--;
        else if (step && !(step == 1 && path[0] == '.'))
            depth++;
        if (depth < 0) return true;
        path += step;
        if (*path) path++;
    }
    return false;
}

char *uri_path(const Field *field, const char *uri) {
    Asset *asset = field->asset;
    const char *slash = strrchr(asset->name, '/');
    size_t folder = slash ? (size_t)(slash - asset->name) + 1 : 0, length = strlen(uri);
    char *path = arena_array(&asset->arena, folder + length + 1, 1), *name = path + folder;
    if (!path) {
        asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
        return NULL;
    }
    memcpy(path, asset->name, folder);
    memcpy(name, uri, length + 1);

    const char *reason = NULL;
    if (has_scheme(uri))
        reason = "only files and data URIs can be read";
    else if (!uri_unescape(name))
        reason = "its percent-encoding is damaged";
    else if (!*name)
        reason = "it is empty";
    else if (*name == '/')
        reason = "an absolute path is refused";
    else if (leaves_folder(name))
        reason = "a path out of the asset's folder is refused";
    else if (asset->in_memory)
        reason = "an asset in memory cannot refer to files";
    if (!reason) return path;
    field_fail(field, WEFT_MESSAGE_GLTF_URI, "%.80s: %s", uri, reason);
    return NULL;
}
