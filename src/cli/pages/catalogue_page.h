/* catalogue_page.h - the opening comment of an id's file in the catalogue */
#pragma once

#include "cli/console/names.h"

/* Returns the opening comment of the file of an id as lines of text. Release with free; NULL where there is no file. */
char *page_text(const Kind *kind, const char *id);
