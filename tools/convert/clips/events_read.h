/* events_read.h: callback keys and sync markers from a text file (noh build --events FILE).
 *
 * One per line, words apart by blanks, names with blanks in double quotes:
 *     CLIP TIME_S NAME [PAYLOAD] [min=WEIGHT]     a callback key
 *     CLIP TIME_S NAME marker                     a sync marker
 * PAYLOAD is a number: 8 bytes that the callback gets, little endian. Whole numbers (also
 * 0x and up to 16 hexadecimal digits) are 64-bit integers, those with a point or an
 * exponent 64-bit floats. WEIGHT is the least weight at which the key is delivered.
 * A marker lies before its clip's end, no two of a clip at one time; clips of one sync group
 * have the same markers in the same order.
 * What follows a # that begins a word is a comment. */
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

/* Add the keys to the clips that they name: the first of that name, also where several
 * sets have one, so that no key is delivered twice. A name that no clip has, and a time
 * outside the clip, are refused with the line. */
int events_apply(const event_list *list, raw_set *const *sets, uint32_t set_count, model_error *error);

/* A payload's text as above. Returns 0 where it is not one. */
int event_payload(const char *text, size_t size, uint8_t out[8]);

#ifdef __cplusplus
}
#endif
#endif
