/* sound.h: sound in memory, one channel of floats, and sound files in.
 *
 * Files are read by libsndfile, which is looked for when it is needed (libsndfile.so.1), so that noh is built, and
 * runs, without it. It walks a WAV's chunks and takes 8 to 32 bits, floats, and any rate and number of channels. */
#ifndef NOH_NOH_SPEAK_SOUND_H
#define NOH_NOH_SPEAK_SOUND_H

#include <stddef.h>
#include <stdint.h>

#define SOUND_SECONDS_MAX 600u

typedef struct sound {
    float *samples; /* -1..1 */
    size_t count;
    uint32_t rate;  /* samples a second */
    size_t clipped; /* samples at or beyond full scale when read */
    /* 0: channels were averaged; else they take each other away, as stereo in opposite phase does, and this one, from 1,
     * was taken alone */
    uint32_t only_channel;
} sound;

/* Channels are averaged, or one is taken (only_channel); a sample that is no number is silence. Prints an error and returns an exit code; 0 on success:
 * as all here. */
int sound_read(const char *path, sound *out);
/* The sound at another rate: a sinc under a Kaiser window, whose cut is below half of the lower rate. */
int sound_resample(const sound *in, uint32_t rate, sound *out);
int sound_from_pcm(const int16_t *samples, size_t count, uint32_t rate, sound *out);
void sound_free(sound *s);

#endif
