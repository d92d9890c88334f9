/* settings.h - settings that persist between runs: a small JSON in the user's configuration */
#pragma once

#include <stdbool.h>

enum { RECENT_MOST = 10, RECENT_PATH = 1024 };

typedef struct Settings {
    int width, height; /* of the window */
    float panel;       /* width of the side panel, design pixels */
    bool invert;       /* dragging down looks up */
    float speed;       /* of flying */
    char recent[RECENT_MOST][RECENT_PATH];
    int recent_count;
    char folder[RECENT_PATH]; /* of the file browser */
} Settings;

/* Returns the settings of a first start. */
Settings settings_default(void);

/* Reads $XDG_CONFIG_HOME/weft/view.json, or ~/.config/weft/view.json. Values that are missing or invalid stay
 * unchanged. */
void settings_read(Settings *settings);

/* Writes the same file, complete or not at all; false on failure. */
bool settings_write(const Settings *settings);

/* Makes a path the first of the recent files. */
void settings_opened(Settings *settings, const char *path);
