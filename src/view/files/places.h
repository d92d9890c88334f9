/* places.h - folders that a file dialog offers */
#pragma once

#include <stdbool.h>

#include "view/files/settings.h"

enum { PLACES_MOST = 24, PLACE_NAME = 64, PLACE_PATH = 1024 };

typedef struct FilePlace {
    char name[PLACE_NAME], path[PLACE_PATH];
} FilePlace;

typedef struct FilePlaces {
    FilePlace places[PLACES_MOST];
    int count;
} FilePlaces;

/* Reads the folders: home; that of the scene (may be NULL or builtin:) and that the program was started in; those of the
 * recent files; the bookmarks of GTK's file dialogs; mounted volumes. Each is there, and is listed once. */
void places_read(FilePlaces *places, const char *scene, const Settings *settings);

/* Adds the bookmarks of a file, a URI "file:///FOLDER" and perhaps a name on each line. */
void places_read_bookmarks(FilePlaces *places, const char *path);
