/* guard.h - calls into libraries of C++, whose exceptions C cannot catch */
#pragma once

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Calls call(user). Returns false if it threw, as Embree and TBB do if memory runs out while they handle that; what
 * they had allocated then leaks. *starved (not NULL) becomes true if it threw because memory is short. */
bool guarded(void (*call)(void *user), void *user, bool *starved);

#ifdef __cplusplus
}
#endif
