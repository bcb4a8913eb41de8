/* web_ear.c: writes the ear's tables, which the page fetches when it first listens: they do not compress. */
#include <stdio.h>

#include "life/face/ear_internal.h"

int main(void)
{
    return fwrite(&noh_ear_tables, sizeof noh_ear_tables, 1, stdout) != 1;
}
