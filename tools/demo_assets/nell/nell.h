/* Nell: a head and shoulders drawn like a figure of an animated film. */
#ifndef NELL_NELL_H
#define NELL_NELL_H

#include "mask/figure.h"

Figure nell_build(void);

#endif
