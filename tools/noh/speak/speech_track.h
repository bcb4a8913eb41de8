/* speech_track.h: speech as mouth shapes over time, and as a clip of morph weights for the face of a pack. */
#ifndef NOH_NOH_SPEAK_SPEECH_TRACK_H
#define NOH_NOH_SPEAK_SPEECH_TRACK_H

#include "convert/base/byte_buffer.h"
#include "file/pack_file.h"
#include "prosody.h"
#include "synthesis.h"
#include "noh/face.h"

#define SPEECH_TRACK_RATE 100u /* frames a second */

typedef struct speech_track_frame {
    uint32_t shape; /* noh_viseme: the one that shows */
    float visemes[NOH_VISEME_COUNT], open, round;
} speech_track_frame;

/* Of phones, or of frames where there are any. */
typedef struct speech_track {
    noh_speech speech;
    noh_phone *phones;
    speech_track_frame *frames; /* the middle of the n-th is at (n + 1/2) / SPEECH_TRACK_RATE s */
    uint32_t frame_count, frame_room;
    double seconds;
} speech_track;

/* Prints an error and returns an exit code; 0 on success: as all here. */
int speech_track_make(const synthesis *said, speech_track *out);
/* Room for the frames of this duration. */
int speech_track_frames(speech_track *t, double seconds);
void speech_track_free(speech_track *t);

/* A pack with one clip of weights, at 60 frames a second, for every node of `face` with mouth shapes, callback keys
 * where words begin, and floats that a live face takes (modules.h). text: what was said, whose words name the keys */
int speech_track_pack(const speech_track *t, const prosody *voice, const synthesis *said, const char *text,
                      const pack_file *face, const char *name, byte_buffer *out);

/* The shape of the sound that is made at a tick, without those before and behind it. */
uint32_t speech_track_viseme(const speech_track *t, int64_t tick);
/* The weights of shapes at a tick, and how far the mouth is opened and rounded then. */
void speech_track_visemes(const speech_track *t, int64_t tick, float *visemes);
float speech_track_open(const speech_track *t, int64_t tick);
float speech_track_round(const speech_track *t, int64_t tick);

const char *viseme_name(uint32_t viseme);
float viseme_open(uint32_t viseme);  /* 0..1 how far the mouth opens */
float viseme_round(uint32_t viseme); /* 0..1 how rounded the lips are */

#endif
