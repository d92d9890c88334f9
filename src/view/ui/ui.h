/* ui.h - widgets, in C: the bridge to Dear ImGui, which alone is C++
 *
 * One frame: ui_begin, widgets, ui_end. A widget is named by its label and by the scopes around it:
 * "Material/ roughness"; after "##" a label is part of the name alone, and
 * after "###" that is all of its name, regardless of what it shows: "Distribution D###d". A shown control can be found
 * by its name (ui_control_find), as scripts do. Colours are 0xAABBGGRR, places in
 * pixels from the top left. One thread, the one whose OpenGL context is current. */
#pragma once

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Keys by their place on a keyboard of the United States, as GLFW numbers them (GLFW_KEY_W is the key above S
 * on any layout). */
enum { UI_KEYS = 512, UI_BUTTONS = 5, UI_TYPED = 32, UI_PRESSED = 16 };

/* A key that was pressed. letter: on this keyboard, in lower case; 0: none. */
typedef struct UiPress {
    int key;
    char letter;
    bool control, shift, alt, repeats; /* repeats: by the system while the key is held down */
} UiPress;

/* The state of mouse and keys; wheel and typed text since the last frame. */
typedef struct UiInput {
    int width, height;       /* of the window */
    float seconds;           /* since the last frame */
    float x, y;              /* of the mouse; negative: elsewhere */
    bool button[UI_BUTTONS]; /* left, right, middle */
    float wheel, wheel_across;
    bool key[UI_KEYS];
    bool control, shift, alt;
    unsigned typed[UI_TYPED]; /* code points */
    int typed_count;
    UiPress pressed[UI_PRESSED]; /* since the last frame */
    int pressed_count;
} UiInput;

/* Functions that get and set the text of the window system's clipboard. */
typedef struct UiClipboard {
    const char *(*get)(void *user);
    void (*set)(void *user, const char *text);
    void *user;
} UiClipboard;

/* Sets up the widgets. scale: pixels per design pixel (1: 96 dpi); clipboard may be NULL. Returns false on failure. */
bool ui_create(float scale, const UiClipboard *clipboard);
void ui_destroy(void);

void ui_begin(const UiInput *input);
/* Draws everything into the framebuffer that is bound. */
void ui_end(void);

/* Returns true if a widget uses the mouse, or the keyboard. */
bool ui_wants_mouse(void);
bool ui_wants_keys(void);
/* Returns true if text is being typed. */
bool ui_types(void);

/* Hands the keyboard to the menus, or to the next panel and after the last one back to the picture: arrows,
 * Space and Enter then go through its widgets until Escape, or the mouse, ends that. */
void ui_go_to_menus(void);
void ui_go_to_next_panel(void);

typedef enum UiCursor { UI_ARROW, UI_BEAM, UI_ACROSS, UI_HAND, UI_CURSORS } UiCursor;
UiCursor ui_cursor(void);

float ui_scale(void);
float ui_line_height(void); /* of a row of widgets */
float ui_text_width(const char *text);
float ui_width_left(void);  /* of this row */
float ui_height_left(void); /* of this panel or dialog */

typedef struct UiBox {
    float x, y, width, height;
} UiBox;

/* Begins a panel, a fixed region of the window. Returns true if it is to be filled; ui_panel_end follows either way. */
bool ui_panel(const char *name, UiBox box, bool scrolls);
void ui_panel_end(void);
/* Begins a floating window, with a cross that sets *open to false. */
bool ui_window(const char *name, UiBox first, bool *open);
void ui_window_end(void);
/* Opens a dialog above all else; ui_dialog is then called every frame until it is closed. */
void ui_dialog_open(const char *name);
bool ui_dialog(const char *name, float width, float height);
bool ui_escaped(void); /* Escape was pressed, and not in a text field other than that of ui_search */
void ui_dialog_close(void);
void ui_dialog_end(void);
/* Begins a scrolling box within a panel; width 0: all that is left of this row. */
bool ui_list(const char *name, float width, float height);
void ui_list_end(void);

/* Adds a prefix to the names of the controls that follow. */
void ui_scope(const char *name);
void ui_scope_end(void);

/* Draws a heading that folds what is below it; returns true while unfolded. */
bool ui_section(const char *label, bool unfolded);

/* Draws a smaller heading, within a section; returns true while unfolded, which it is not at first. */
bool ui_fold(const char *label);

bool ui_menu_bar(void);
void ui_menu_bar_end(void);
bool ui_menu(const char *label);
void ui_menu_end(void);
bool ui_menu_item(const char *label, const char *shortcut, bool checked, bool enabled);

void ui_same_line(void);
void ui_column(float fraction); /* continues in this row at that fraction of the width */
void ui_leave_room(void);       /* the next name leaves room for what ui_beside puts there */
void ui_beside(void);           /* puts the next, a small button, at the end of this row's column of names */
void ui_rule(void);
void ui_disabled(bool disabled);
void ui_disabled_end(void);
void ui_faint(bool faint); /* controls that have no effect now */
void ui_faint_end(void);
void ui_indent(void); /* to the column of values */
void ui_indent_end(void);

void ui_text(const char *text);
void ui_wrapped(const char *text);
void ui_dim(const char *text);
void ui_warning(const char *text);

/* Shows help for the preceding widget when the mouse rests on it; NULL: none. The second shows a square picture above it,
 * texture 0: none. */
void ui_tip(const char *text);
void ui_tip_picture(const char *text, unsigned texture, float side);

bool ui_button(const char *label);
bool ui_small_button(const char *label);
bool ui_checkbox(const char *label, bool *on);
/* Draws a row of buttons of which one is chosen; names ends with NULL, and each has a tip. */
bool ui_tabs(const char *label, const char *const *names, const char *const *tips, int *chosen);
bool ui_selectable(const char *label, bool chosen);
/* Draws a row of a list. Returns 0, or 1 if it was clicked, 2 if twice. */
int ui_row(const char *label, bool chosen);
/* Scrolls the list so that the preceding row is visible. */
void ui_scroll_here(void);
/* Draws a name and a button that shows a value, as a row of a menu does. */
bool ui_field(const char *label, const char *value);
/* Draws a square picture with a line below it, which is cut if it is too long; texture 0: none yet. */
bool ui_tile(const char *label, unsigned texture, float side, const char *caption, bool chosen);
/* Writes a title and, dimmed, what is said of it, to the right of the preceding widget. */
void ui_words_beside(const char *title, const char *words);
/* Returns true if the next widget will be seen, should it be of that size. */
bool ui_will_be_seen(float width, float height);

/* A menu of count values; name and help (may be NULL) return them by number. */
typedef struct UiChoices {
    int count;
    const char *(*name)(const void *user, int value);
    const char *(*help)(const void *user, int value);
    const void *user;
} UiChoices;
bool ui_choice(const char *label, const UiChoices *choices, int *chosen);

typedef struct UiRange {
    float low, high;  /* ends of the slider */
    float initial;    /* a double click goes there */
    const char *unit; /* NULL: none */
    bool logarithmic;
} UiRange;

/* Returns true if the value was changed, as the next three do. Ctrl-click types a value, which may lie beyond the
 * range. */
bool ui_slider(const char *label, const UiRange *range, float *value);
bool ui_slider_int(const char *label, int low, int high, int *value);
bool ui_numbers(const char *label, float step, float *values, int count);
/* Edits a colour, linear Rec. 709, displayed as sRGB; values above 1 stay. */
bool ui_color(const char *label, const float initial[3], float color[3]);
/* Converts a channel of sRGB to linear; ui_shown converts a linear colour, clamped, to what drawing functions take. */
float ui_linear(float shown);
unsigned ui_shown(const float color[3]);
/* Draws a small square of that linear colour; returns true if it was clicked. */
bool ui_swatch(const char *label, const float color[3]);
bool ui_input(const char *label, char *text, int size);
/* Edits a path likewise: a click selects all of it. */
bool ui_input_path(const char *label, char *text, int size);
/* Edits words to search for, shown as `hint` while there are none; it takes the keyboard in a dialog that opens, or where
 * `focus` is set. step receives -1 or 1 if an arrow up or down was pressed, else 0. Returns true if Enter was pressed. */
bool ui_search(const char *label, const char *hint, char *text, int size, bool focus, int *step);
void ui_progress(float fraction, const char *text); /* fraction below 0: under way */

/* Reserves a region to draw in, which `box` receives. Returns true while the mouse is over it or drags it. */
bool ui_canvas(const char *label, float width, float height, UiBox *box);
/* Draws behind all panels from now on, or no longer. */
void ui_behind(bool behind);
void ui_clip(const UiBox *box); /* NULL: no clipping */
void ui_line(float x0, float y0, float x1, float y1, unsigned color, float thickness);
void ui_curve(const float *xy, int count, unsigned color, float thickness);
void ui_fill(UiBox box, unsigned color);
void ui_triangle(const float xy[6], unsigned color);
void ui_disc(float x, float y, float radius, unsigned color);
void ui_ring(float x, float y, float radius, unsigned color);
void ui_label(float x, float y, unsigned color, const char *text);
void ui_picture(unsigned texture, UiBox box, bool flipped);
void ui_picture_faint(unsigned texture, UiBox box, bool flipped, float opacity); /* 0 to 1 */
void ui_picture_part(unsigned texture, UiBox box, float u0, float v0, float u1, float v1);

/* A control of the last frame. */
typedef struct UiControl {
    char name[96];
    UiBox box;
    bool explained; /* a tip exists or none is needed */
} UiControl;
int ui_control_count(void);
const UiControl *ui_control(int index);
const UiControl *ui_control_find(const char *name); /* NULL: it is not shown */
/* Scrolls its panel so that the control is visible in the next frame. */
void ui_reveal(const char *name);

#ifdef __cplusplus
}
#endif
