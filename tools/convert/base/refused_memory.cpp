#include "refused_memory.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

static void end()
{
    try {
        if (std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
    } catch (const std::bad_alloc &) {
        std::fputs("noh: out of memory\n", stderr);
        std::_Exit(1);
    } catch (...) {
    }
    std::abort();
}

void exit_where_memory_is_refused(void)
{
    std::set_terminate(end);
}
