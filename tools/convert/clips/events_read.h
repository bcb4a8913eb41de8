/* events_read.h: callback keys and sync markers from a text file (noh build --events FILE).
 *
 * One per line. Blanks separate words; names that contain blanks stand in double quotes:
 *     CLIP TIME_S NAME [PAYLOAD] [min=WEIGHT]     a callback key
 *     CLIP TIME_S NAME marker                     a sync marker
 * PAYLOAD is a number, which the callback gets as 8 bytes, little-endian: whole numbers (also 0x and up to 16
 * hexadecimal digits) as 64-bit integers, those with a point or an exponent as 64-bit floats. WEIGHT is the least
 * weight at which the key fires. A marker lies before its clip's end; a clip has no two markers at one time; clips of
 * one sync group have the same markers in the same order. A word that begins with # starts a comment. */
#ifndef NOH_CONVERT_CLIPS_EVENTS_READ_H
#define NOH_CONVERT_CLIPS_EVENTS_READ_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct event_entry {
    char *clip;
    uint32_t line;
    raw_event event;
} event_entry;

typedef struct event_list {
    uint32_t count;
    event_entry *entries; /* in the file's order */
} event_list;

/* Returns 0 and *out, to be freed with events_free, or 1 and *error with a line number. */
int events_read(const char *path, event_list **out, model_error *error);
void events_free(event_list *list);

/* Add the keys to the clips that they name: if several sets have a clip of that name, to the first alone, so that no
 * key fires twice. An unknown name, or a time outside the clip, is an error with its line. */
int events_apply(const event_list *list, raw_set *const *sets, uint32_t set_count, model_error *error);

/* The bytes of a payload written as above. Returns 0 if the text is not a payload. */
int event_payload(const char *text, size_t size, uint8_t out[8]);

#ifdef __cplusplus
}
#endif
#endif
