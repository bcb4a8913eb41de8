/* osc.h: Open Sound Control 1.0, read: the messages of a packet, which may be a bundle of bundles. Nothing is copied, and
 * any bytes may be given.
 * Source: the Open Sound Control 1.0 specification (Wright 2002).
 *
 *   osc_begin    a packet
 *   osc_next     its next message, or what is damaged in it
 *   osc_text, osc_number   an argument of a message */
#ifndef NOH_NOH_CAPTURE_OSC_H
#define NOH_NOH_CAPTURE_OSC_H

#include <stddef.h>
#include <stdint.h>

#define OSC_DEPTH_MAX 8u   /* bundles within bundles */
#define OSC_VALUES_MAX 16u /* arguments of a message; any more are left out */

typedef struct osc_value {
    char type; /* 's': text; 'f': a number, of any type of OSC; 0: of a type without a value */
    const char *text;
    double number; /* finite or not, as it was sent */
} osc_value;

typedef struct osc_message {
    const char *address; /* in the packet, as are texts */
    uint32_t count;
    osc_value values[OSC_VALUES_MAX];
} osc_message;

/* OSC_DAMAGED: an element was left out, and the next one follows where its size is known. */
typedef enum osc_kind { OSC_END, OSC_MESSAGE, OSC_DAMAGED } osc_kind;

typedef struct osc_reader {
    const uint8_t *bytes;
    size_t at, ends[OSC_DEPTH_MAX]; /* where the open bundles end */
    uint32_t depth;
} osc_reader;

/* bytes  must stay while its messages are used */
void osc_begin(osc_reader *r, const uint8_t *bytes, size_t count);
osc_kind osc_next(osc_reader *r, osc_message *out);

/* 1 where a message has a text, or `count` finite numbers up to 1e6, from the argument `first` on. */
int osc_text(const osc_message *m, uint32_t first, const char **out);
int osc_numbers(const osc_message *m, uint32_t first, uint32_t count, float *out);

#endif
