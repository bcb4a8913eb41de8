/* wav_file.h: sound files. */
#ifndef NOH_NOH_SPEAK_WAV_FILE_H
#define NOH_NOH_SPEAK_WAV_FILE_H

#include <stddef.h>
#include <stdint.h>

/* 16 bits, one channel. Prints an error and returns an exit code; 0 on success. */
int wav_write(const char *path, const int16_t *samples, size_t count, uint32_t sample_rate);

#endif
