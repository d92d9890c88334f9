#include "plot/type.h"

#include <math.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

#include <cairo-ft.h>

#include "base/fail.h"
#include "base/printable.h"

static pthread_mutex_t faces_lock = PTHREAD_MUTEX_INITIALIZER;
static FT_Library library;
static cairo_font_face_t *faces[2]; /* regular, bold; kept until the program ends */

/* Opens a font file by FreeType. Its memory is given back only with the program. */
static cairo_font_face_t *open_face(const char *path) {
    FT_Face face;
    if (!library && FT_Init_FreeType(&library) != 0) return NULL;
    if (FT_New_Face(library, path, 0, &face) != 0) return NULL;
    cairo_font_face_t *made = cairo_ft_font_face_create_for_ft_face(face, 0);
    if (cairo_font_face_status(made) == CAIRO_STATUS_SUCCESS) return made;
    FT_Done_Face(face);
    return NULL;
}

void set_font(cairo_t *cairo, double size, bool bold) {
    const char *path = bold ? WEFT_FONTS "/DejaVuSans-Bold.ttf" : WEFT_FONTS "/DejaVuSans.ttf";
    pthread_mutex_lock(&faces_lock);
    if (!faces[bold]) faces[bold] = open_face(path);
    cairo_font_face_t *face = faces[bold];
    pthread_mutex_unlock(&faces_lock);
    /* Without the file fontconfig chooses; with it fontconfig, which does not survive lack of memory, is not asked. */
    if (face || access(path, R_OK) == 0)
        cairo_set_font_face(cairo, face ? face : cairo_toy_font_face_create(NULL, 0, 0)); /* an error of this drawing */
    else
        cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                               bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    if (cairo_surface_get_type(cairo_get_target(cairo)) == CAIRO_SURFACE_TYPE_IMAGE) { /* vectors have no pixels */
        cairo_font_options_t *options = cairo_font_options_create();
        cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
        cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_SLIGHT);
        cairo_set_font_options(cairo, options);
        cairo_font_options_destroy(options);
    }
    cairo_set_font_size(cairo, size);
}

WeftResult drawn(cairo_t *cairo, const char *what, WeftError *error) {
    const cairo_status_t status = cairo_status(cairo);
    if (status == CAIRO_STATUS_SUCCESS) return WEFT_OK;
    const bool plain = status == CAIRO_STATUS_NO_MEMORY || status == CAIRO_STATUS_NULL_POINTER; /* of set_font */
    return fail(error, WEFT_MESSAGE_MEMORY, what, plain ? NULL : "%s", cairo_status_to_string(status));
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
