/* uncaught.h - threads of C++ libraries that run out of memory where no caller can catch it */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/* Makes such a thread end the program with WEFT_RESOURCES and one line, unless the program has reported a failure
 * already. Any other uncaught exception still aborts. */
void uncaught_begin(void);

#ifdef __cplusplus
}
#endif
