#include <stdio.h>
#include <stdlib.h>

#include "text/assemble/tables.h"

#include "shading/catalogue/albedo.h"
#include "shading/catalogue/engine_tables.h"
#include "shading/lobe/lobe_tables.h"
#include "text/source/number_text.h"

/* Writes lines that make `t` the table e, which becomes a layer of `rows` rows. */
static void put_reference(Text *text, const TableRef *e, int rows, const char *name, const char *indent) {
    bool own = e->kind == TABLE_ROOTS || e->kind == TABLE_TINTED;
    int layer = text_table(text, (TextTable){e->texels, rows, own ? e->columns + 1 : e->columns, name});
    text_line(text, "%st.texels = %d;\n%st.kind = %d;\n%st.rows = %d;\n%st.columns = %d;", indent, layer, indent,
              e->kind, indent, e->rows, indent, e->columns);
    text_line(text, "%st.low = %s;\n%st.high = %s;\n%st.tilts = %d;\n%st.tilt = %s;", indent, number(e->low).text,
              indent, number(e->high).text, indent, e->tilts, indent, number(e->tilt).text);
}

void text_lobe_tables(Text *text) {
    if (!text_provide(text, "shading/lobe/lobe_tables.h")) return;
    text_include(text, "shading/lobe/table.h");
    lobe_tables_make_for(-1);
#define LOBE_TABLE_NAME(name) #name,
    static const char *const names[LOBE_TABLE_COUNT] = {LOBE_TABLES(LOBE_TABLE_NAME)};
    for (int k = 0; k < LOBE_TABLE_COUNT; k++) {
        if (!lobe_table_refs[k].texels) continue;
        text_line(text, "\nTableRef lobe_table_%s() {\n    TableRef t;", names[k]);
        put_reference(text, &lobe_table_refs[k], lobe_table_refs[k].rows, names[k], "    ");
        text_line(text, "    return t;\n}");
    }
}

void text_albedo_table(Text *text, const char *function, const char *name, const AlbedoTable *table) {
    const TableRef e = albedo_table_ref(table);
    text_line(text, "\nTableRef %s() {\n    TableRef t;", function);
    put_reference(text, &e, table->maps * e.rows, name, "    ");
    text_line(text, "    return t;\n}");
}

/* Returns an engine's table resampled to table_side by table_side texels, if it is larger and that is not 0. */
static TableRef smaller(Text *text, TableRef e) {
    int side = text->desc.table_side;
    if (!side || (e.rows <= side && e.columns <= side)) return e;
    float *texels = arena_array(&text->macros.arena, (size_t)side * (size_t)side, sizeof *texels);
    if (!texels) {
        text->macros.short_of_memory = true;
        return e;
    }
    for (int row = 0; row < side; row++)
        for (int column = 0; column < side; column++)
            texels[row * side + column] =
                table_linear(e, ((float)column + 0.5f) / (float)side, ((float)row + 0.5f) / (float)side);
    e.texels = texels;
    e.rows = e.columns = side;
    return e;
}

void text_engine_tables(Text *text, const int *which, int count) {
#define ENGINE_TABLE_NAMES(NAME, name, side, points, sheen, shifted) {"ENGINE_" #NAME, #name},
    static const char *const names[ENGINE_COUNT][2] = {ENGINE_TABLES(ENGINE_TABLE_NAMES)};
    if (!text_provide(text, "shading/catalogue/engine_tables.h")) return;
    text_include(text, "shading/lobe/table.h");
    for (int k = 0; k < ENGINE_COUNT; k++) text_line(text, "const int %s = %d;", names[k][0], k);
    text_line(text,
              "\nTableRef engine_table(int which) {\n    TableRef t;\n    t.texels = 0;\n    t.kind = TABLE_NONE;\n"
              "    t.rows = 0;\n    t.columns = 0;\n    t.low = 0.0;\n    t.high = 0.0;\n    t.tilts = 0;\n    "
              "t.tilt = 0.0;");
    for (int k = 0; k < count; k++) {
        TableRef e = smaller(text, engine_table(which[k]));
        text_line(text, "    if (which == %d) {", which[k]);
        put_reference(text, &e, e.rows, names[which[k]][1], "        ");
        text_line(text, "    }");
    }
    text_line(text, "    return t;\n}");
}
