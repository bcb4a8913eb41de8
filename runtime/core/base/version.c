#include "noh/base.h"

#include "core/base/assert_internal.h"

#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

/* NOH_VERSION is written out so that scripts can read it; this checks that it has the length of its three numbers. */
static const char from_numbers[] = TEXT(NOH_VERSION_MAJOR) "." TEXT(NOH_VERSION_MINOR) "." TEXT(NOH_VERSION_PATCH);
NOH_STATIC_ASSERT(sizeof from_numbers == sizeof NOH_VERSION, the_version_is_its_numbers);

const char *noh_version(void)
{
    return from_numbers;
}

uint32_t noh_version_number(void)
{
    return NOH_VERSION_NUMBER(NOH_VERSION_MAJOR, NOH_VERSION_MINOR, NOH_VERSION_PATCH);
}
