#include "plot/type.h"

#include <math.h>
#include <string.h>

#include "base/printable.h"

void set_font(cairo_t *cairo, double size, bool bold) {
    cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, size);
}

void drawable(const char *text, char line[TEXT_SIZE]) {
    size_t used = 0, length;
    unsigned code;
    const unsigned char *s = (const unsigned char *)text;
    for (; *s && used + 4 <= TEXT_MAX; s += length ? length : 1) {
        length = (size_t)utf8_read(s, &code); /* Cairo accepts only well-formed text */
        const bool plain = length && !is_unprintable(code);
        if (plain)
            memcpy(line + used, s, length);
        else
            line[used] = '?';
        used += plain ? length : 1;
    }
    memcpy(line + used, *s ? "\xe2\x80\xa6" : "", *s ? ELLIPSIS + 1 : 1);
}

double text_width(cairo_t *cairo, const char *text) {
    char line[TEXT_SIZE];
    cairo_text_extents_t extents;
    drawable(text, line);
    cairo_text_extents(cairo, line, &extents);
    return extents.x_advance;
}

void write_text(cairo_t *cairo, const double color[3], double x, double y, double width, const char *text) {
    char line[TEXT_SIZE];
    drawable(text, line);
    for (size_t length = strlen(line); length > 0 && text_width(cairo, line) > width;) {
        do length--;
        while (length > 0 && ((unsigned char)line[length] & 0xc0) == 0x80);
        memcpy(line + length, "\xe2\x80\xa6", ELLIPSIS + 1);
    }
    cairo_set_source_rgb(cairo, color[0], color[1], color[2]);
    cairo_move_to(cairo, x, y);
    cairo_show_text(cairo, line);
}

void place_text(cairo_t *cairo, const double color[3], double x, double y, double share, const char *text) {
    write_text(cairo, color, x - share * text_width(cairo, text), y, HUGE_VAL, text);
}
