/* passports.h - printing of a passport: as text, in a line, as lines of a lobe's header, as JSON, as a
 * page */
#pragma once

#include "cli/console/json_writer.h"
#include "weft/measure.h"

/* Prints the passport on standard output: passport_text in full, passport_line as a line. */
void passport_text(const WeftPassport *passport);
void passport_line(const WeftPassport *passport);

/* Prints the lines that the lobe's file has at the end of its opening comment. */
void passport_header(const WeftPassport *passport);

/* Prints the heading of the lines. */
void passport_line_heading(void);

void passport_json(Json *json, const WeftPassport *passport);

/* Writes one HTML page, which contains its pictures and needs no other file. */
void passports_page(FILE *stream, const WeftPassport *passports, int count);
