/* film_file.h: writes a sequence of pictures as a film or as numbered .png files.
 *
 *   film_open / film_add / film_close
 *
 * By the ending of its name: .gif, .mp4, .webm and .apng are made by ffmpeg, a separate program
 * that is fed with pictures; .png gives numbered files and needs no program: "walk.png" becomes walk_0000.png,
 * walk_0001.png and so on. A film that fails half-way is not left behind. */
#ifndef NOH_NOH_FILE_FILM_FILE_H
#define NOH_NOH_FILE_FILM_FILE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct film {
    char path[1024];
    uint32_t width, height, rate_hz, count; /* count: pictures so far */
    int process, pipe;                      /* 0, -1: numbered pictures */
} film;

/* Prints an error and returns an exit code; 0 on success. Odd sides lose a row or column in .mp4 and .webm. */
int film_open(film *f, const char *path, uint32_t width, uint32_t height, uint32_t rate_hz);
/* rgba[height][width][4], top row first. After an error only film_close is left. */
int film_add(film *f, const uint8_t *rgba);
/* keep  0: leave nothing behind */
int film_close(film *f, int keep);

#ifdef __cplusplus
}
#endif
#endif
