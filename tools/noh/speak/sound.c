#include "sound.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/byte_buffer.h"
#include "platform.h"

/* ---- the part of libsndfile's interface that is used ---- */

enum { MODE_READ = 0x10 };

typedef struct file_info {
    int64_t frames;
    int rate, channels, format, sections, seekable;
} file_info;

typedef struct sndfile {
    void *library;
    void *(*open)(const char *path, int mode, file_info *info);
    int64_t (*read)(void *file, float *samples, int64_t frames);
    int (*error)(void *file);
    const char *(*what)(void *file);
    int (*close)(void *file);
} sndfile;

static int load(sndfile *s)
{
    s->library = dlopen("libsndfile.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!s->library) {
        return tool_fail("speak",
                         "sound files need libsndfile, which is not installed (Debian: apt install libsndfile1)");
    }
    /* ISO C has no cast from an object's address to a function's: POSIX takes this one */
    *(void **)&s->open = dlsym(s->library, "sf_open");
    *(void **)&s->read = dlsym(s->library, "sf_readf_float");
    *(void **)&s->error = dlsym(s->library, "sf_error");
    *(void **)&s->what = dlsym(s->library, "sf_strerror");
    *(void **)&s->close = dlsym(s->library, "sf_close");
    if (!s->open || !s->read || !s->error || !s->what || !s->close) {
        return tool_fail("speak", "libsndfile.so.1 lacks functions: is it libsndfile 1.0 or newer?");
    }
    return 0;
}

/* ---- reading ---- */

#define BLOCK 4096u
#define RATE_MIN 4000
#define RATE_MAX 192000 /* ten minutes of more take gigabytes, also from a FLAC of some kilobytes */
#define CHANNELS_MAX 64

static int grow(sound *s, size_t *room, size_t more)
{
    float *samples;
    if (s->count + more <= *room) return 0;
    *room = 2u * *room + more;
    samples = realloc(s->samples, *room * sizeof *samples);
    if (samples) s->samples = samples;
    return !samples;
}

/* The loudness of each channel and of their mean: sums of squares. */
typedef struct loudness {
    double own[CHANNELS_MAX], mean;
} loudness;

/* only: the one channel that is taken, or CHANNELS_MAX: their mean. */
static void mix(const float *block, size_t frames, size_t channels, size_t only, sound *out, loudness *heard)
{
    for (size_t f = 0; f < frames; f++) {
        float sum = 0.0f;
        for (size_t c = 0; c < channels; c++) {
            const float x = block[f * channels + c];
            sum += x;
            if (x > -1e6f && x < 1e6f) heard->own[c] += (double)x * (double)x;
        }
        sum = only < channels ? block[f * channels + only] : sum / (float)channels;
        if (!(sum > -1e6f && sum < 1e6f)) sum = 0.0f;
        heard->mean += (double)sum * (double)sum;
        out->clipped += sum >= 0.999f || sum <= -0.999f;
        out->samples[out->count++] = sum;
    }
}

/* The mean of channels that have nothing in common has the sum of their powers over the square of their number; of
 * channels that take each other away, as in opposite phase, it has less than a quarter of that. Then the loudest
 * channel is to be taken; else CHANNELS_MAX. */
static size_t only_channel(const loudness *heard, size_t channels)
{
    double sum = 0.0;
    size_t loudest = 0;
    for (size_t c = 0; c < channels; c++) {
        sum += heard->own[c];
        if (heard->own[c] > heard->own[loudest]) loudest = c;
    }
    return channels > 1 && 4.0 * heard->mean * (double)(channels * channels) < sum ? loudest : CHANNELS_MAX;
}

static int check_info(const char *path, const file_info *info)
{
    if (info->rate < RATE_MIN || info->rate > RATE_MAX) {
        return tool_fail(path, "%d samples a second: speech needs %d to %d", info->rate, RATE_MIN, RATE_MAX);
    }
    if (info->channels < 1 || info->channels > CHANNELS_MAX) {
        return tool_fail(path, "%d channels: at most %d can be read", info->channels, CHANNELS_MAX);
    }
    return 0;
}

/* The length in the header is not trusted: the samples are counted. */
static int read_all(const sndfile *s, void *file, const char *path, const file_info *info, size_t only, sound *out,
                    loudness *heard)
{
    const size_t channels = (size_t)info->channels, most = (size_t)SOUND_SECONDS_MAX * (size_t)info->rate;
    float *block = malloc(BLOCK * channels * sizeof *block);
    size_t room = 0;
    int64_t got = 0;
    int status = block ? 0 : tool_fail(path, "out of memory");
    out->rate = (uint32_t)info->rate;
    while (!status && (got = s->read(file, block, BLOCK)) > 0) {
        if (grow(out, &room, (size_t)got)) {
            status = tool_fail(path, "out of memory");
        } else if (out->count + (size_t)got > most) {
            status = tool_fail(path, "is longer than %u seconds: cut it at a pause", SOUND_SECONDS_MAX);
        } else {
            mix(block, (size_t)got, channels, only, out, heard);
        }
    }
    free(block);
    if (!status && s->error(file)) status = tool_fail(path, "sample %zu: %s", out->count, s->what(file));
    if (!status && !out->count) status = tool_fail(path, "contains no samples");
    return status;
}

/* only: as mix has it. *other: what should have been taken instead. */
static int read_file(const sndfile *s, const char *path, size_t only, sound *out, size_t *other)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_file there;
    loudness heard;
    file_info info;
    void *file;
    int status;
    memset(out, 0, sizeof *out);
    memset(&info, 0, sizeof info);
    memset(&heard, 0, sizeof heard);
    if (noh_file_map(path, &there, &error)) return tool_fail(path, "cannot be read: %s", error.what); /* also a pipe */
    noh_file_unmap(&there);
    file = s->open(path, MODE_READ, &info);
    if (!file)
        return tool_fail(path, "cannot be read as sound (WAV, FLAC and others that libsndfile knows): %s",
                         s->what(NULL));
    status = check_info(path, &info);
    if (!status) status = read_all(s, file, path, &info, only, out, &heard);
    s->close(file);
    *other = status ? CHANNELS_MAX : only_channel(&heard, (size_t)info.channels);
    if (status) sound_free(out);
    return status;
}

/* A WAV whose header counts more bytes than there are was cut off: libsndfile takes what is there. Programs that do not
 * know a length beforehand write 0, almost 2^31 (eSpeak NG, SoX) or almost 2^32. */
static void warn_if_cut(const char *path)
{
    noh_file file;
    if (noh_file_map(path, &file, NULL) != NOH_OK) return;
    const uint8_t *b = file.data;
    if (file.bytes >= 12 && memcmp(b, "RIFF", 4) == 0 && memcmp(b + 8, "WAVE", 4) == 0) {
        size_t at = 12;
        while (file.bytes - at >= 8 && memcmp(b + at, "data", 4) != 0) {
            const uint64_t next = at + 8u + (uint64_t)byte_word(b + at + 4) + (byte_word(b + at + 4) & 1u);
            at = next < file.bytes ? (size_t)next : file.bytes;
        }
        const uint32_t told = file.bytes - at >= 8 ? byte_word(b + at + 4) : 0;
        if (told > file.bytes - at - 8u && told < 0x7fff0000u) {
            fprintf(stderr,
                    "noh: %s: warning: its header at byte %zu counts %u bytes of sound, and %zu are there: it was cut "
                    "off; copy it again\n",
                    path, at, told, file.bytes - at - 8u);
        }
    }
    noh_file_unmap(&file);
}

int sound_read(const char *path, sound *out)
{
    size_t only, ignored;
    sndfile s;
    int status;
    memset(&s, 0, sizeof s);
    status = load(&s);
    if (!status) status = read_file(&s, path, CHANNELS_MAX, out, &only);
    if (!status) warn_if_cut(path);
    if (status || only == CHANNELS_MAX) return status;
    sound_free(out);
    status = read_file(&s, path, only, out, &ignored);
    out->only_channel = status ? 0 : (uint32_t)only + 1u;
    return status;
}

int sound_from_pcm(const int16_t *samples, size_t count, uint32_t rate, sound *out)
{
    memset(out, 0, sizeof *out);
    out->samples = malloc((count + 1u) * sizeof *out->samples);
    if (!out->samples) return tool_fail("speak", "out of memory");
    out->count = count;
    out->rate = rate;
    for (size_t i = 0; i < count; i++) out->samples[i] = (float)samples[i] / 32768.0f;
    return 0;
}

void sound_free(sound *s)
{
    free(s->samples);
    memset(s, 0, sizeof *s);
}

/* ---- another rate ---- */

#define ZEROS 24  /* of the sinc, on each side */
#define STEPS 512 /* of the kernel's table between two zeros; linear between them: an error below -90 dB */
#define PI 3.14159265358979323846

/* The modified Bessel function of order 0, by its series. */
static double bessel(double x)
{
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 40; k++) {
        term *= (x / (2.0 * k)) * (x / (2.0 * k));
        sum += term;
    }
    return sum;
}

static void make_kernel(float *kernel)
{
    for (int i = 0; i <= ZEROS * STEPS; i++) {
        const double x = (double)i / STEPS, w = x / ZEROS;
        const double sinc = i ? sin(PI * x) / (PI * x) : 1.0;
        kernel[i] = (float)(sinc * bessel(9.0 * sqrt(1.0 - w * w)) / bessel(9.0));
    }
    kernel[ZEROS * STEPS + 1] = 0.0f;
}

/* The sound at `at` samples, through a low-pass of `cut` times its rate / 2. */
static float sample_at(const sound *in, const float *kernel, double at, double cut)
{
    const double reach = ZEROS / cut;
    const double last = (double)in->count - 1.0;
    const size_t first = at - reach > 0.0 ? (size_t)ceil(at - reach) : 0u;
    const size_t end = (size_t)(at + reach < last ? floor(at + reach) : last);
    double sum = 0.0;
    for (size_t i = first; i <= end; i++) {
        const double x = fabs((double)i - at) * cut * STEPS;
        const size_t k = (size_t)x;
        const float f = (float)(x - (double)k);
        if (k >= ZEROS * STEPS) continue;
        sum += (double)(in->samples[i] * (kernel[k] + f * (kernel[k + 1u] - kernel[k])));
    }
    return (float)(sum * cut);
}

int sound_resample(const sound *in, uint32_t rate, sound *out)
{
    float *kernel = malloc((ZEROS * STEPS + 2u) * sizeof *kernel);
    const double ratio = (double)in->rate / rate;
    const double cut = 0.95 * (ratio > 1.0 ? 1.0 / ratio : 1.0);
    memset(out, 0, sizeof *out);
    out->rate = rate;
    out->count = (size_t)((double)in->count / ratio);
    out->clipped = in->clipped;
    out->samples = malloc((out->count + 1u) * sizeof *out->samples);
    if (!kernel || !out->samples) {
        free(kernel);
        sound_free(out);
        return tool_fail("speak", "out of memory");
    }
    make_kernel(kernel);
    for (size_t i = 0; i < out->count; i++) out->samples[i] = sample_at(in, kernel, (double)i * ratio, cut);
    free(kernel);
    return 0;
}
