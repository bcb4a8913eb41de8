/* Tests of ear.c: what it makes of noise, silence and broken sound; of chunks, rates and clones; and how
 * well it reads the lips of people outside its training data. */
#include "noh/base.h"
#include "noh/face.h"
#include "life/face/ear_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define V NOH_VISEME_COUNT

enum { MAX_FRAMES = 1200, SECOND = 16000 };

static const uint8_t lip_class[V] = { 0, 0, 1, 4, 4, 4, 4, 4, 4, 4, 3, 3, 4, 2, 2 };
static noh_ear_frame frames[MAX_FRAMES];
static int16_t sound[48000 * 4];

/* Hears all of it in chunks of at most `chunk` samples. */
static uint32_t hear(noh_ear *ear, const int16_t *samples, size_t count, size_t chunk)
{
    uint32_t heard = 0;
    for (size_t at = 0; at < count;) {
        const size_t some = count - at < chunk ? count - at : chunk;
        at += noh_ear_hear(ear, samples + at, some);
        while (heard < MAX_FRAMES && noh_ear_next(ear, &frames[heard])) heard++;
    }
    return heard;
}

static uint32_t hear_late(uint32_t rate, uint32_t latency_ms, size_t count)
{
    noh_ear ear;
    assert_int_equal(noh_ear_init(&ear, rate, latency_ms, NULL), NOH_OK);
    return hear(&ear, sound, count, 1000);
}

static uint32_t hear_at(uint32_t rate, size_t count)
{
    return hear_late(rate, NOH_EAR_LATENCY_MIN_MS, count);
}

/* The largest opening; every weight of every frame in range, and 1 together. */
static float check_frames(uint32_t count)
{
    float widest = 0.0f;
    assert_true(count > 50);
    for (uint32_t f = 0; f < count; f++) {
        float sum = 0.0f;
        for (int v = 0; v < V; v++) {
            assert_true(frames[f].visemes[v] >= 0.0f && frames[f].visemes[v] <= 1.0f);
            sum += frames[f].visemes[v];
        }
        assert_true(sum == 1.0f);
        assert_true(frames[f].open >= 0.0f && frames[f].open <= 1.0f);
        assert_true(frames[f].round >= 0.0f && frames[f].round <= 1.0f);
        assert_true(frames[f].closed >= 0.0f && frames[f].closed <= 1.0f);
        assert_int_equal(frames[f].index, f);
        widest = frames[f].open > widest ? frames[f].open : widest;
    }
    return widest;
}

static void make_noise(size_t count, float rms, uint32_t seed)
{
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        sound[i] = (int16_t)((float)(int32_t)seed * (rms * 1.7320508f * 32768.0f / 2147483648.0f));
    }
}

/* A voice of sorts: a saw whose pitch and loudness wander. Integers, so that it is the same everywhere. */
static void make_voice(size_t count, uint32_t rate)
{
    uint32_t phase = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t at = (uint32_t)(i * 64 / rate);
        phase += (100 + at * 37 % 60) * (uint32_t)(65536 * 256 / rate);
        sound[i] = (int16_t)(((int32_t)(phase >> 8 & 65535u) - 32768) * (int32_t)(at * 29 % 16) / 40);
    }
}

/* ---- sound that is not speech ---- */

static void noise_at_minus_40_db_does_not_open_the_mouth(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 5; seed++) {
        make_noise(SECOND * 4, 0.01f, seed);
        assert_true(check_frames(hear_at(16000, SECOND * 4)) < 0.1f);
    }
}

static void silence_and_direct_current_keep_it_shut(void **state)
{
    static const int16_t levels[] = { 0, 1, 3000, 32767, -32768 };
    (void)state;
    for (int k = 0; k < 5; k++) {
        for (size_t i = 0; i < SECOND * 2; i++) sound[i] = levels[k];
        assert_true(check_frames(hear_at(16000, SECOND * 2)) < 0.1f);
    }
}

static void clipped_and_loud_sound_stays_in_range(void **state)
{
    (void)state;
    make_noise(SECOND * 2, 0.5f, 7);
    for (size_t i = 0; i < SECOND * 2; i++) sound[i] = sound[i] > 0 ? 32767 : -32768;
    check_frames(hear_at(16000, SECOND * 2));
    for (size_t i = 0; i < SECOND * 2; i++) sound[i] = i & 1u ? 32767 : -32768;
    check_frames(hear_at(16000, SECOND * 2));
    for (size_t i = 0; i < SECOND * 2; i++) sound[i] = i / 40 & 1u ? 32767 : -32768; /* a tone of 200 Hz */
    check_frames(hear_at(16000, SECOND * 2));
}

/* Chords of four tones with beats, loud: no voice, and nothing but numbers in range is asked. */
static void music_stays_in_range(void **state)
{
    static const uint32_t steps[] = { 1123, 1415, 1683, 2246 };
    uint32_t phases[4] = { 0 };
    (void)state;
    for (size_t i = 0; i < SECOND * 4; i++) {
        int32_t sum = 0;
        for (int k = 0; k < 4; k++) {
            phases[k] = (phases[k] + steps[k] * (uint32_t)(1 + i / SECOND % 3)) & 65535u;
            sum += phases[k] < 32768 ? (int32_t)phases[k] - 16384 : 49152 - (int32_t)phases[k];
        }
        sound[i] = (int16_t)(sum / 2 * (int32_t)(8 - i / 1000 % 8) / 8);
    }
    check_frames(hear_at(16000, SECOND * 4));
}

static void it_is_as_small_as_it_says(void **state)
{
    (void)state;
    assert_int_equal(sizeof(noh_ear), NOH_EAR_BYTES);
    assert_true(NOH_EAR_BYTES <= 4096);
    assert_true(sizeof(ear_tables) <= 18432);
}

static void every_rate_gives_a_hundred_frames_a_second(void **state)
{
    static const uint32_t rates[] = { 8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000 };
    noh_ear ear;
    noh_error error;
    (void)state;
    for (int k = 0; k < 9; k++) {
        uint32_t count;
        make_voice(rates[k] * 2, rates[k]);
        count = hear_at(rates[k], rates[k] * 2);
        assert_in_range(count, 195, 197);
        check_frames(count);
    }
    assert_int_equal(noh_ear_init(&ear, 7999, 40, &error), NOH_ERR_ARG);
    assert_int_equal(noh_ear_init(&ear, 48001, 40, &error), NOH_ERR_ARG);
    assert_int_equal(noh_ear_init(&ear, 16000, 39, &error), NOH_ERR_ARG);
    assert_int_equal(noh_ear_init(&ear, 16000, 81, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "latency_ms must be 40 to 80"));
}

/* A voice with a t in each half second, 50 ms without sound and 30 ms of hiss; in the end it is silent. */
static void lips_stay_open_in_a_stop_and_close_in_a_pause(void **state)
{
    uint32_t count, seed = 1;
    (void)state;
    make_voice(SECOND * 4, 16000);
    for (size_t i = 0, at = 0; i < SECOND * 4; i++, at = (at + 1) % (SECOND / 2)) {
        seed = seed * 1664525u + 1013904223u;
        if (at < SECOND * 8 / 100) sound[i] = (int16_t)((int32_t)(seed >> 19) - 4096);
        if (at < SECOND * 5 / 100 || i > SECOND * 3) sound[i] = 0;
    }
    count = hear_late(16000, NOH_EAR_LATENCY_MAX_MS, SECOND * 4);
    for (uint32_t f = 50; f < 300; f++) assert_true(f % 50 > 4 || lip_class[frames[f].shape] > 0);
    for (uint32_t f = 335; f < count; f++) assert_true(lip_class[frames[f].shape] == 0 && frames[f].open < 0.05f);
}

/* ---- the same whatever the chunks, the clone and the processor ---- */

static uint32_t hash_frames(uint32_t count)
{
    uint32_t hash = 2166136261u;
    for (uint32_t f = 0; f < count; f++) {
        uint32_t words[V + 3];
        memcpy(words, frames[f].visemes, sizeof frames[f].visemes);
        memcpy(words + V, &frames[f].open, 4);
        memcpy(words + V + 1, &frames[f].round, 4);
        memcpy(words + V + 2, &frames[f].closed, 4);
        for (int i = 0; i < V + 3; i++) hash = (hash ^ words[i]) * 16777619u;
    }
    return hash;
}

static void chunks_of_any_size_give_the_same_frames(void **state)
{
    static const uint32_t rates[] = { 8000, 16000, 44100 };
    static const size_t chunks[] = { 1, 7, 160, 441, 4096, 200000 };
    (void)state;
    for (int r = 0; r < 3; r++) {
        uint32_t expected = 0;
        make_voice(rates[r] * 3, rates[r]);
        for (int c = 0; c < 6; c++) {
            noh_ear ear;
            uint32_t hash;
            assert_int_equal(noh_ear_init(&ear, rates[r], 80, NULL), NOH_OK);
            hash = hash_frames(hear(&ear, sound, rates[r] * 3, chunks[c]));
            if (c == 0) expected = hash;
            assert_int_equal(hash, expected);
        }
    }
}

static void a_clone_goes_on_as_its_original_does(void **state)
{
    noh_ear ear, clone;
    uint32_t hash;
    (void)state;
    make_voice(SECOND * 3, 16000);
    noh_ear_init(&ear, 16000, 60, NULL);
    hear(&ear, sound, SECOND, 333);
    memcpy(&clone, &ear, sizeof ear);
    hash = hash_frames(hear(&ear, sound + SECOND, SECOND * 2, 333));
    assert_int_equal(hash_frames(hear(&clone, sound + SECOND, SECOND * 2, 5)), hash);
}

/* A restarted ear counts from 0 again and has forgotten the sound, but not the voice: a second
 * hearing is not the first. */
static void a_restart_keeps_what_was_learnt(void **state)
{
    uint32_t hashes[3];
    noh_ear ear;
    (void)state;
    make_voice(SECOND * 4, 16000);
    noh_ear_init(&ear, 16000, 80, NULL);
    for (int k = 0; k < 3; k++) {
        const uint32_t count = hear(&ear, sound, SECOND * 4, 777);
        check_frames(count);
        hashes[k] = hash_frames(count);
        noh_ear_restart(&ear);
    }
    assert_int_not_equal(hashes[0], hashes[1]);
    noh_ear_init(&ear, 16000, 80, NULL);
    assert_int_equal(hash_frames(hear(&ear, sound, SECOND * 4, 5)), hashes[0]);
}

/* What a frame shows depends on no sound later than latency_ms behind its middle, and on all before. */
static void the_latency_is_as_stated(void **state)
{
    (void)state;
    make_voice(SECOND, 16000);
    for (uint32_t latency = NOH_EAR_LATENCY_MIN_MS; latency <= NOH_EAR_LATENCY_MAX_MS; latency += 10) {
        noh_ear ear;
        noh_ear_frame frame;
        uint32_t next = 0;
        noh_ear_init(&ear, 16000, latency, NULL);
        for (size_t at = 0; at < SECOND; at++) {
            assert_int_equal(noh_ear_hear(&ear, sound + at, 1), 1);
            while (noh_ear_next(&ear, &frame)) {
                assert_int_equal(frame.index, next++);
                assert_true((double)(at + 1) / 16.0 == frame.index * 10 + 12.5 + latency);
            }
        }
        assert_in_range(next, 90, 96);
    }
}

/* 10 ms more add a frame to the mean of the opening, and nothing else: the network reads the same frames of the
 * past. */
static void the_past_is_heard_at_every_latency(void **state)
{
    static float open[MAX_FRAMES];
    float apart[3] = { 0 };
    (void)state;
    make_voice(SECOND * 4, 16000);
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t count = hear_late(16000, NOH_EAR_LATENCY_MIN_MS + 10 * i, SECOND * 4);
        for (uint32_t f = 0; f < count; f++) {
            apart[i] += fabsf(frames[f].open - open[f]);
            open[f] = frames[f].open;
        }
    }
    assert_true(apart[1] < 1.5f * apart[2]);
}

/* One number for all processors: change it together with the tables or the arithmetic, and with nothing else. */
static void every_processor_has_the_same_bits(void **state)
{
    (void)state;
    make_voice(SECOND * 4, 16000);
    assert_int_equal(hash_frames(hear_late(16000, 40, SECOND * 4)), 0xf3232e9du);
    assert_int_equal(hash_frames(hear_late(16000, 80, SECOND * 4)), 0x0127defdu);
}

/* ---- people ---- */

static const float opens[V] = { 0, 0, .1f, .2f, .2f, .25f, .15f, .1f, .2f, .2f, 1, .6f, .3f, .7f, .25f };

typedef struct score {
    double fifteen, five, count, lips, shut, vowels, shut_vowels, changes, others;
    double x, y, xx, yy, xy, n;
} score;

/* The time of each phone: [start, end) in seconds, and its viseme, or none. */
typedef struct spoken {
    double start, end;
    int first, second;
} spoken;

static spoken said[512];

static int read_phones(const char *path)
{
    char name[32];
    int count = 0;
    FILE *f = fopen(path, "r");
    while (f && count < 512 && fscanf(f, "%lf %lf %31s", &said[count].start, &said[count].end, name) == 3) {
        noh_viseme second;
        said[count].first = (int)noh_viseme_of_phone(name, &second);
        said[count++].second = (int)second;
    }
    if (f) fclose(f);
    return count;
}

static int truth_at(int count, double t)
{
    for (int i = 0; i < count; i++) {
        const spoken *s = &said[i];
        if (t < s->start || t >= s->end || s->first == V) continue;
        return s->second < V && t >= s->start + .6 * (s->end - s->start) ? s->second : s->first;
    }
    return -1;
}

/* Seven frames are averaged: openings are compared as they move, not frame by frame. */
static void score_opening(const int *truth, int count, score *s)
{
    for (int f = 3; f + 3 < count; f++) {
        double x = 0, y = 0;
        if (truth[f] < 0) continue;
        for (int k = f - 3; k <= f + 3; k++) {
            x += opens[truth[k] < 0 ? 0 : truth[k]] / 7;
            y += frames[k].open / 7;
        }
        s->x += x;
        s->y += y;
        s->xx += x * x;
        s->yy += y * y;
        s->xy += x * y;
        s->n++;
    }
}

static void score_lips(int phones, int count, score *s)
{
    for (int i = 0; i < phones; i++) {
        const int first = (int)ceil((said[i].start - .03 - .0125) * 100),
                  last = (int)((said[i].end + .03 - .0125) * 100);
        int shut = 0;
        if (said[i].first != NOH_VISEME_PP) continue;
        for (int f = first < 0 ? 0 : first; f <= last && f < count; f++) shut |= lip_class[frames[f].shape] == 0;
        s->lips++;
        s->shut += shut;
    }
}

static void score_file(int phones, int count, score *s)
{
    static int truth[MAX_FRAMES];
    for (int f = 0; f < count; f++) {
        const int shape = (int)frames[f].shape, is = truth[f] = truth_at(phones, f * .01 + .0125);
        if (f > 0) s->changes += lip_class[shape] != lip_class[frames[f - 1].shape];
        if (f > 0) s->others += shape != (int)frames[f - 1].shape && lip_class[shape] == lip_class[frames[f - 1].shape];
        if (is < 0) continue;
        s->count++;
        s->fifteen += is == shape;
        s->five += lip_class[is] == lip_class[shape];
        s->vowels += is >= NOH_VISEME_AA;
        s->shut_vowels += is >= NOH_VISEME_AA && lip_class[shape] == 0;
    }
    score_opening(truth, count, s);
    score_lips(phones, count, s);
}

/* RIFF files as these are: 44 bytes, 16 bits, one channel. */
static size_t read_sound(const char *path, uint32_t *rate)
{
    static int16_t header[22];
    FILE *f = fopen(path, "rb");
    size_t count = 0;
    if (f && fread(header, 2, 22, f) == 22) {
        memcpy(rate, header + 12, 4);
        count = fread(sound, 2, sizeof sound / 2, f);
    }
    if (f) fclose(f);
    return count;
}

/* Hears the recordings.
 * returns  their number */
static int hear_people(uint32_t latency_ms, score *s)
{
    static const char *const names[] = {
        "bobby", "sense_0870", "sense_0880", "sense_0890", "sense_0920", "sense_0930"
    };
    int files = 0;
    memset(s, 0, sizeof *s);
    for (int i = 0; i < 6 && getenv("NOH_ASSETS"); i++) {
        char path[1024];
        uint32_t rate = 0;
        size_t samples;
        int phones;
        snprintf(path, sizeof path, "%s/speech/%s.phones", getenv("NOH_ASSETS"), names[i]);
        phones = read_phones(path);
        snprintf(path, sizeof path, "%s/speech/%s.wav", getenv("NOH_ASSETS"), names[i]);
        samples = read_sound(path, &rate);
        if (!phones || !samples) continue;
        files++;
        score_file(phones, (int)hear_late(rate, latency_ms, samples), s);
    }
    return files;
}

static void people_are_read_as_well_as_measured(void **state)
{
    static const struct {
        uint32_t latency_ms;
        double five, opening, shut, shut_vowels, changes;
    } limits[] = { { 40, .70, .77, .9, .05, 8.0 }, { 80, .74, .77, .95, .05, 8.0 } };
    (void)state;
    for (int i = 0; i < 2; i++) {
        score s;
        double opening, changes;
        if (!hear_people(limits[i].latency_ms, &s)) test_skip("no labelled speech in NOH_ASSETS");
        opening = (s.n * s.xy - s.x * s.y) / sqrt((s.n * s.xx - s.x * s.x) * (s.n * s.yy - s.y * s.y));
        changes = s.changes / s.count * 100;
        printf("# ear, %u ms: fifteen %.3f, five %.3f, opening %.3f, p b m shut %.0f/%.0f, vowels shut %.3f, "
               "changes of lips %.1f/s\n",
               limits[i].latency_ms, s.fifteen / s.count, s.five / s.count, opening, s.shut, s.lips,
               s.shut_vowels / s.vowels, changes);
        assert_true(s.five / s.count >= limits[i].five && opening >= limits[i].opening);
        assert_true(s.shut >= limits[i].shut * s.lips && s.shut_vowels <= limits[i].shut_vowels * s.vowels);
        assert_true(changes <= limits[i].changes && changes >= 4.0);
        assert_true(s.others / s.count * 100 >= 1.0); /* another shape of the same lips */
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_at_minus_40_db_does_not_open_the_mouth),
        cmocka_unit_test(silence_and_direct_current_keep_it_shut),
        cmocka_unit_test(clipped_and_loud_sound_stays_in_range),
        cmocka_unit_test(music_stays_in_range),
        cmocka_unit_test(lips_stay_open_in_a_stop_and_close_in_a_pause),
        cmocka_unit_test(it_is_as_small_as_it_says),
        cmocka_unit_test(every_rate_gives_a_hundred_frames_a_second),
        cmocka_unit_test(chunks_of_any_size_give_the_same_frames),
        cmocka_unit_test(a_clone_goes_on_as_its_original_does),
        cmocka_unit_test(a_restart_keeps_what_was_learnt),
        cmocka_unit_test(the_latency_is_as_stated),
        cmocka_unit_test(the_past_is_heard_at_every_latency),
        cmocka_unit_test(every_processor_has_the_same_bits),
        cmocka_unit_test(people_are_read_as_well_as_measured),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
