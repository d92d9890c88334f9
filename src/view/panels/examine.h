/* examine.h - the doctor's findings about a file, in a thread of its own */
#pragma once

#include <stdbool.h>

#include "view/ui/window.h"
#include "weft/doctor.h"

typedef struct Examination Examination;

/* Starts; the window must outlive it, and is woken at the end. NULL where memory is short. */
Examination *examination_start(Window *window, const char *path);

bool examination_done(Examination *examination);

/* Returns the findings once the examination is done, or NULL if the file could not be examined; the second returns the
 * reason. */
const WeftDoctor *examination_doctor(const Examination *examination);
const char *examination_failure(const Examination *examination);

/* Gives up what is not done. May be NULL. */
void examination_free(Examination *examination);
