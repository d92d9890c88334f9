/* root.h - the folder whose files an asset may name, beside those of its own folder
 *
 * An asset's pictures and buffers lie in its own folder or below it; a path that leads out, by `..` or by a link, is
 * refused, since an asset may come from a stranger. Exporters that keep the original textures write such paths. */
#ifndef WEFT_ROOT_H
#define WEFT_ROOT_H

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Lets assets name files in folder, or below it, too, for the whole process; NULL: those of their own folders alone.
 * Must not run beside another call of the library. Fails with WEFT_MESSAGE_FILE_OPEN, or _MEMORY. */
WEFT_API WeftResult weft_root_use(const char *folder, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
