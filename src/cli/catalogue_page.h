/* catalogue_page.h - what the catalogue's own files say of an id: the comment that each begins with */
#ifndef WEFT_CLI_CATALOGUE_PAGE_H
#define WEFT_CLI_CATALOGUE_PAGE_H

#include "names.h"

/* The opening comment of the file of an id as plain lines. Release with free; NULL where there is no file. */
char *page_text(const Kind *kind, const char *id);

#endif
