/* patch.h - JSON text after its values were edited: what was not touched stays, byte for byte */
#ifndef WEFT_GLTF_PATCH_H
#define WEFT_GLTF_PATCH_H

#include <jansson.h>
#include <stddef.h>

/* The text of `now`, made of `text`, whose value is `was`: members and elements that are equal in both are
 * copied with the blanks around them, numbers as they were written; what is new comes last in its object or
 * array, spaced like its neighbours. Of size bytes and a zero byte; NULL where memory is short. Release with
 * free(). */
char *patch_text(const char *text, size_t length, json_t *was, json_t *now, size_t *size);

#endif
