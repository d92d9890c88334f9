/* call_stack.h - enough stack, whatever the limit of the shell */
#pragma once

/* Calls run(count, arguments) and returns its result. If the program's stack may be smaller than a mebibyte
 * (`ulimit -s`), it runs in a thread with a larger one, as do all threads that start later. */
int stack_run(int (*run)(int count, char **arguments), int count, char **arguments);
