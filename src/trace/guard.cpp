#include "trace/guard.h"

bool guarded(void (*call)(void *user), void *user) {
    try {
        call(user);
        return true;
    } catch (...) {
        return false;
    }
}
