/* compare.h - several pictures on one sheet: each, and how it differs from the first */
#pragma once

#include "cli/render/job.h"

/* Makes all pictures of a request and writes the sheet to every output. After an interruption the sheet has the
 * pictures made so far. Returns the exit code, after a line on standard error. */
int compare_run(const Request *request, Warnings *warnings);
