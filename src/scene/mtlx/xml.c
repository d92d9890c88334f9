#include "scene/mtlx/xml.h"

#include <expat.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"

/* A document being read. The first complaint stops the parser. */
typedef struct Tree {
    XML_Parser parser;
    Arena *arena;
    XmlElement *open, *root;
    int depth, count;
    const char *complaint; /* NULL: none */
    bool starved;
} Tree;

static void stop(Tree *tree, const char *complaint) {
    if (!complaint) tree->starved = true;
    if (!tree->complaint) tree->complaint = complaint;
    XML_StopParser(tree->parser, XML_FALSE);
}

static const char **copy_attributes(Arena *arena, const char **attributes) {
    size_t count = 0;
    while (attributes[count]) count++;
    const char **copy = arena_array(arena, count + 1, sizeof(const char *));
    for (size_t k = 0; copy && k < count; k++)
        if (!(copy[k] = arena_text(arena, attributes[k]))) return NULL;
    return copy;
}

static void XMLCALL element_begin(void *user, const char *name, const char **attributes) {
    Tree *tree = user;
    if (tree->starved || tree->complaint) return;
    if (++tree->depth > XML_DEPTH) {
        stop(tree, "its elements are nested too deeply");
        return;
    }
    if (++tree->count > XML_ELEMENTS) {
        stop(tree, "it has too many elements");
        return;
    }
    XmlElement *element = arena_array(tree->arena, 1, sizeof *element);
    const char *copy = element ? arena_text(tree->arena, name) : NULL;
    const char **pairs = copy ? copy_attributes(tree->arena, attributes) : NULL;
    if (!pairs) {
        stop(tree, NULL);
        return;
    }
    *element = (XmlElement){
        .name = copy, .attributes = pairs, .parent = tree->open, .line = (int)XML_GetCurrentLineNumber(tree->parser)};
    if (!tree->open)
        tree->root = element;
    else if (tree->open->last)
        tree->open->last->next = element;
    else
        tree->open->first = element;
    if (tree->open) tree->open->last = element;
    tree->open = element;
}

static void XMLCALL element_end(void *user, const char *name) {
    Tree *tree = user;
    (void)name;
    tree->depth--;
    if (tree->open) tree->open = tree->open->parent;
}

static void XMLCALL doctype_begin(void *user, const char *name, const char *system, const char *public, int internal) {
    (void)name, (void)system, (void)public, (void)internal;
    stop(user, "a document type (DOCTYPE) is not allowed");
}

/* Says why the parser stopped. */
static WeftResult refuse(const Tree *tree, const char *name, WeftError *error) {
    const enum XML_Error code = XML_GetErrorCode(tree->parser);
    if (tree->starved || code == XML_ERROR_NO_MEMORY) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    return fail(error, WEFT_MESSAGE_MATERIAL_FILE, name, "line %lu: %s",
                (unsigned long)XML_GetCurrentLineNumber(tree->parser),
                tree->complaint ? tree->complaint : XML_ErrorString(code));
}

WeftResult xml_read(const void *data, size_t size, const char *name, Arena *arena, const XmlElement **root,
                    WeftError *error) {
    Tree tree = {.parser = XML_ParserCreate(NULL), .arena = arena};
    *root = NULL;
    if (!tree.parser) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    XML_SetUserData(tree.parser, &tree);
    XML_SetElementHandler(tree.parser, element_begin, element_end);
    XML_SetStartDoctypeDeclHandler(tree.parser, doctype_begin);
    WeftResult result = WEFT_OK;
    if (size > INT_MAX)
        result = fail(error, WEFT_MESSAGE_FILE_LARGE, name, NULL);
    else if (XML_Parse(tree.parser, data, (int)size, 1) != XML_STATUS_OK)
        result = refuse(&tree, name, error);
    XML_ParserFree(tree.parser);
    *root = tree.root;
    return result;
}

const char *xml_attribute(const XmlElement *element, const char *key) {
    for (const char **pair = element->attributes; pair[0]; pair += 2)
        if (strcmp(pair[0], key) == 0) return pair[1];
    return NULL;
}

const XmlElement *xml_child(const XmlElement *element, const char *name) {
    for (const XmlElement *child = element->first; child; child = child->next) {
        const char *is = xml_attribute(child, "name");
        if (is && strcmp(is, name) == 0) return child;
    }
    return NULL;
}

const char *xml_inherited(const XmlElement *element, const char *key) {
    const char *value = NULL;
    for (; element && !value; element = element->parent) value = xml_attribute(element, key);
    return value;
}
