/* xml.h - an XML document as a tree of elements with attributes; text between elements is passed over
 *
 * The parser is expat. A document type is refused, and so are entities, which need one. Limits: XML_DEPTH levels and
 * XML_ELEMENTS elements. */
#pragma once

#include "base/memory.h"
#include "weft/result.h"

enum { XML_DEPTH = 64, XML_ELEMENTS = 100000 };

/* An element. Its strings and those that follow lie in the arena of the reading. */
typedef struct XmlElement {
    const char *name;
    const char **attributes; /* key, value, key, value, NULL */
    struct XmlElement *parent, *first, *last, *next;
    int line; /* where it begins, counted from 1 */
} XmlElement;

/* Reads size bytes as a document. name is the subject of errors. Fails with WEFT_MESSAGE_MATERIAL_FILE or _MEMORY. */
WeftResult xml_read(const void *data, size_t size, const char *name, Arena *arena, const XmlElement **root,
                    WeftError *error);

/* Returns the value of an attribute, or NULL. */
const char *xml_attribute(const XmlElement *element, const char *key);

/* Returns the first child whose attribute "name" is name, or NULL. */
const XmlElement *xml_child(const XmlElement *element, const char *name);

/* Returns the value of an attribute of the element, or of the nearest element around it that has it; NULL: none has. */
const char *xml_inherited(const XmlElement *element, const char *key);
