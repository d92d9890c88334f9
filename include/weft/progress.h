/* progress.h - progress reports of long calls, and their number of threads */
#ifndef WEFT_PROGRESS_H
#define WEFT_PROGRESS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Called now and then from the thread that made the call it was given to, with the finished fraction in [0, 1].
 * A result other than 0 stops the work soon. */
typedef int (*WeftProgress)(void *user, double fraction);

/* The most threads that any call takes. */
enum { WEFT_THREADS_MAX = 256 };

#ifdef __cplusplus
}
#endif

#endif
