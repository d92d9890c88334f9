/* browser.h - a file chooser: folders and files in a list */
#pragma once

#include <stdbool.h>

typedef struct Browser Browser;

/* Creates a browser of a folder; NULL or a folder that does not exist stands for the current one. NULL where memory is
 * short. */
Browser *browser_create(const char *folder);
void browser_free(Browser *browser);

const char *browser_folder(const Browser *browser);

/* Rereads the folder. */
void browser_refresh(Browser *browser);

/* Draws it in what is left of a dialog, `height` pixels high: folders, and files of some kinds, bit k for
 * PathKind k. Returns a path once one is chosen that is there and of those kinds, valid until the next call;
 * what was typed stays until then. */
const char *browser_draw(Browser *browser, unsigned kinds, float height);
