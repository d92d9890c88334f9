/* browser.h - a file chooser: places, folders and files in a list that narrows as one types */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "view/files/places.h"

typedef struct Browser Browser;

/* Creates a browser of a folder; NULL or a folder that does not exist stands for the current one. NULL where memory is
 * short. */
Browser *browser_create(const char *folder);
void browser_free(Browser *browser);

const char *browser_folder(const Browser *browser);

/* Rereads the folder, forgets what was searched for, and offers these places, which must outlive it. */
void browser_refresh(Browser *browser, const FilePlaces *places);

/* Draws it in what is left of a dialog, `height` pixels high: folders, and files of some kinds, bit k for PathKind k. A
 * double click, Enter, or browser_open opens the chosen one. Returns a path once one is opened that is there and of
 * those kinds, valid until the next call; what was typed stays until then. */
const char *browser_draw(Browser *browser, unsigned kinds, float height);

/* Opens what is chosen in the list or typed: a folder is shown, the path of a file returned; NULL: none. */
const char *browser_open(Browser *browser);

/* Draws it likewise to choose where to save; a click on a file writes its name to `name`, of that size. */
void browser_draw_saving(Browser *browser, unsigned kinds, float height, char *name, size_t size);

/* Writes the path of a file of that name in the folder that is shown, or the name itself if it is a path from the root,
 * or that folder is the current one. Returns false where it is too long. */
bool browser_place(const Browser *browser, const char *name, char *path, size_t size);
