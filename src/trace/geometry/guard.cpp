#include "trace/geometry/guard.h"

#include <new>

bool guarded(void (*call)(void *user), void *user, bool *starved) {
    *starved = false;
    try {
        call(user);
        return true;
    } catch (const std::bad_alloc &) {
        *starved = true;
    } catch (...) {
    }
    return false;
}
