/* Nell's animations. */
#ifndef NELL_CLIPS_H
#define NELL_CLIPS_H

#include "mask/animate.h"

enum { NELL_CLIPS = 12 };

Animation nell_clip(int number);

#endif
