/* printable.h - names out of files, as a terminal may be given them
 *
 * A terminal obeys control characters, among them those of U+0080 .. U+009F, and shows text in another order or not at
 * all by format characters (The Unicode Standard, version 15.0, section 23.2 and general category Cf). Each of them,
 * and each byte that is no UTF-8, becomes one question mark. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Reads the character at s in well-formed UTF-8 (The Unicode Standard, version 15.0, table 3-7). Returns its length in
 * bytes, or 0 if there is none; s ends with a zero byte. */
static inline int utf8_read(const unsigned char *s, unsigned *code) {
    const int length = s[0] < 0x80                   ? 1
                       : s[0] >= 0xc2 && s[0] < 0xe0 ? 2
                       : (s[0] & 0xf0) == 0xe0       ? 3
                       : s[0] >= 0xf0 && s[0] < 0xf5 ? 4
                                                     : 0;
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    if (length < 2) {
        *code = s[0];
        return length;
    }
    *code = s[0] & (0x7fu >> length);
    for (int k = 1; k < length; k++) {
        if ((s[k] & 0xc0) != 0x80) return 0;
        *code = *code << 6 | (s[k] & 0x3fu);
    }
    const bool whole = *code >= least[length] && *code <= 0x10ffff && (*code < 0xd800 || *code > 0xdfff);
    return whole ? length : 0;
}

/* Returns true for a character that a terminal obeys or nobody sees. */
static inline bool is_unprintable(unsigned code) {
    static const unsigned ranges[][2] = {
        {0x00, 0x1f},       {0x7f, 0x9f},       {0xad, 0xad},       {0x61c, 0x61c},   {0x180e, 0x180e},
        {0x200b, 0x200f},   {0x2028, 0x202e},   {0x2060, 0x206f},   {0xfeff, 0xfeff}, {0xfff9, 0xfffb},
        {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a}, {0xe0000, 0xe007f},
    };
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++)
        if (code >= ranges[k][0] && code <= ranges[k][1]) return true;
    return false;
}

/* Puts a question mark in place of each such character of a text, which only gets shorter. */
static inline void make_printable(char *text) {
    const unsigned char *from = (const unsigned char *)text;
    unsigned code;
    while (*from) {
        int length = utf8_read(from, &code);
        if (length == 0 || is_unprintable(code)) {
            *text++ = '?';
            from += length ? length : 1;
            continue;
        }
        while (length-- > 0) *text++ = (char)*from++;
    }
    *text = '\0';
}

/* Copies whole characters of a text (NULL is "") so, as many as there is room for. Returns out. */
static inline const char *printable(const char *text, char *out, size_t size) {
    size_t length = text ? strnlen(text, size - 1) : 0;
    if (text && text[length])
        while (length && ((unsigned char)text[length] & 0xc0u) == 0x80u) length--; /* the cut is within a character */
    if (length) memcpy(out, text, length);
    out[length] = '\0';
    make_printable(out);
    return out;
}
