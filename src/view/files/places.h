/* places.h - folders that a file dialog offers */
#pragma once

#include <stdbool.h>

#include "view/files/settings.h"

enum { PLACES_MOST = 24, PLACE_NAME = 64, PLACE_PATH = 1024 };

typedef struct Place {
    char name[PLACE_NAME], path[PLACE_PATH];
} Place;

typedef struct Places {
    Place places[PLACES_MOST];
    int count;
} Places;

/* Reads the folders: home; that of the scene (may be NULL or builtin:) and that the program was started in; those of the
 * recent files; the bookmarks of GTK's file dialogs; mounted volumes. Each is there, and is listed once. */
void places_read(Places *places, const char *scene, const Settings *settings);

/* Adds the bookmarks of a file, a URI "file:///FOLDER" and perhaps a name on each line. */
void places_read_bookmarks(Places *places, const char *path);
