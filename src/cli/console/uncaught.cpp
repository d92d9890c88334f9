#include "cli/console/uncaught.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <unistd.h>

extern "C" {
#include "cli/console/report.h"
}

namespace {

bool is_memory(const std::exception_ptr &thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const std::bad_alloc &) {
        return true;
    } catch (...) {
    }
    return false;
}

/* TBB starts its threads from functions that may not throw, and allocates there. */
[[noreturn]] void end() {
    if (!is_memory(std::current_exception())) std::abort();
    if (!report_failed()) report(WEFT_RESOURCES, "out of memory");
    _exit(WEFT_RESOURCES);
}

} // namespace

void uncaught_begin(void) { std::set_terminate(end); }
