/* audit_sheet.h - a table, E and the error between them side by side, as a picture */
#pragma once

#include "weft/bake.h"

typedef struct AuditSheet {
    const WeftAudit *audit;
    const WeftImage *errors; /* of weft_audit */
    const char *name;        /* of the table */
    const char *lobe;
} AuditSheet;

/* Draws U8 RGB; fails as weft_sheet_compose does. */
WeftResult audit_sheet(const AuditSheet *sheet, WeftImage *out, WeftError *error);
