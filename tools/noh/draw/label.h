/* label.h: text in pictures. */
#ifndef NOH_NOH_DRAW_LABEL_H
#define NOH_NOH_DRAW_LABEL_H

#include <stdint.h>

/* Draw light text on a dark strip into a picture; scale 1 is about 7 pixels high. */
void draw_text(uint8_t *rgba, uint32_t width, uint32_t height, int x, int y, int scale, const char *text);

#endif
