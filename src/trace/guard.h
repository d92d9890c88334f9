/* guard.h - calls into libraries of C++, whose exceptions C cannot catch */
#ifndef WEFT_TRACE_GUARD_H
#define WEFT_TRACE_GUARD_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Calls call(user). Returns false if it threw, as Embree and TBB do where memory runs out in the middle of
 * their own handling of it; what they held is then lost. *starved (not NULL): it threw for want of memory. */
bool guarded(void (*call)(void *user), void *user, bool *starved);

#ifdef __cplusplus
}
#endif

#endif
