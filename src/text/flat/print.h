/* print.h - a placed graph as text */
#pragma once

#include "text/flat/run.h"
#include "text/source/buffer.h"

/* Appends the shader: the first lines of its text, what it uses from outside, and one main. */
void print_shader(const Run *run, Buffer *out);
