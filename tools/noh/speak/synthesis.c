#include "synthesis.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* ---- the part of eSpeak NG's interface that is used ---- */

enum { EVENT_LAST = 0, EVENT_WORD = 1, EVENT_PHONEME = 7 };
enum { OUTPUT_SYNCHRONOUS = 2, WITH_PHONEMES = 1, PHONEMES_IPA = 2, DO_NOT_EXIT = 0x8000 };
enum { BY_CHARACTER = 1, IN_UTF8 = 1, PHONES_IN_BRACKETS = 0x100 };

typedef struct event {
    int type;
    unsigned id;
    int text_position, length; /* characters, the first is 1 */
    int audio_ms, sample;
    void *user;
    union {
        int number;
        const char *name;
        char text[8];
    } value;
} event;

typedef struct voice {
    const char *name, *languages, *identifier;
    unsigned char gender, age, variant, reserved;
    int score;
    void *spare;
} voice;

typedef int (*sound_fn)(short *samples, int count, event *events);

typedef struct espeak {
    void *library;
    int (*initialize)(int output, int buffer_ms, const char *path, int options);
    int (*set_voice)(const char *name);
    int (*set_properties)(voice *wanted);
    voice *(*current_voice)(void);
    void (*set_callback)(sound_fn fn);
    int (*synth)(const void *text, size_t bytes, unsigned position, int unit, unsigned end, unsigned flags,
                 unsigned *id, void *user);
    int (*synchronize)(void);
    int (*terminate)(void);
} espeak;

/* Started once: after espeak_Terminate it would wait for ever in espeak_Synchronize. */
static espeak engine;
static int engine_rate;

static int load(espeak *e)
{
    e->library = dlopen("libespeak-ng.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!e->library) {
        return tool_fail("speak", "eSpeak NG is not installed (Debian: apt install libespeak-ng1 espeak-ng-data)");
    }
    /* ISO C has no cast from an object's address to a function's: POSIX takes this one */
    *(void **)&e->initialize = dlsym(e->library, "espeak_Initialize");
    *(void **)&e->set_voice = dlsym(e->library, "espeak_SetVoiceByName");
    *(void **)&e->set_properties = dlsym(e->library, "espeak_SetVoiceByProperties");
    *(void **)&e->current_voice = dlsym(e->library, "espeak_GetCurrentVoice");
    *(void **)&e->set_callback = dlsym(e->library, "espeak_SetSynthCallback");
    *(void **)&e->synth = dlsym(e->library, "espeak_Synth");
    *(void **)&e->synchronize = dlsym(e->library, "espeak_Synchronize");
    *(void **)&e->terminate = dlsym(e->library, "espeak_Terminate");
    if (!e->initialize || !e->set_voice || !e->set_properties || !e->current_voice || !e->set_callback || !e->synth ||
        !e->synchronize || !e->terminate) {
        return tool_fail("speak", "libespeak-ng.so.1 lacks functions: is it eSpeak NG 1.50 or newer?");
    }
    return 0;
}

/* ---- events of eSpeak NG ---- */

/* Its callback has no place for ours. */
static synthesis *current;

/* Room for one more of `size` bytes. */
static int grow(void **items, size_t *room, size_t count, size_t size)
{
    const size_t wanted = count < 256 ? 256 : 2 * count;
    void *more;
    if (count < *room) return 0;
    more = realloc(*items, wanted * size);
    if (!more) return 1;
    *items = more;
    *room = wanted;
    return 0;
}

static void take_samples(synthesis *s, const short *samples, int count)
{
    for (int i = 0; i < count && !s->failed; i++) {
        s->failed = grow((void **)&s->samples, &s->sample_room, s->sample_count, sizeof *s->samples);
        if (!s->failed) s->samples[s->sample_count++] = samples[i];
    }
}

static void take_event(synthesis *s, const event *e)
{
    if (e->type == EVENT_PHONEME) {
        s->failed = s->failed || grow((void **)&s->phones, &s->phone_room, s->phone_count, sizeof *s->phones);
        if (s->failed) return;
        memset(&s->phones[s->phone_count], 0, sizeof *s->phones);
        s->phones[s->phone_count].sample = (uint32_t)e->sample;
        memcpy(s->phones[s->phone_count++].name, e->value.text, sizeof e->value.text);
    } else if (e->type == EVENT_WORD && e->length > 0) {
        s->failed = s->failed || grow((void **)&s->words, &s->word_room, s->word_count, sizeof *s->words);
        if (s->failed) return;
        s->words[s->word_count].sample = (uint32_t)e->sample;
        s->words[s->word_count].first = e->text_position > 0 ? (uint32_t)e->text_position - 1u : 0u;
        s->words[s->word_count++].length = (uint32_t)e->length;
    }
}

static int take(short *samples, int count, event *events)
{
    if (samples) take_samples(current, samples, count);
    for (; events && events->type != EVENT_LAST; events++) take_event(current, events);
    return current->failed;
}

static int start(void)
{
    int status = load(&engine);
    if (status) return status;
    engine_rate = engine.initialize(OUTPUT_SYNCHRONOUS, 200, NULL, WITH_PHONEMES | PHONEMES_IPA | DO_NOT_EXIT);
    if (engine_rate > 0) return 0;
    return tool_fail("speak", "eSpeak NG cannot start: its data may be missing (Debian: apt install espeak-ng-data)");
}

/* A voice's own name, or else the name of the best voice for a language, and then its variant ("+f2"). */
static int set_voice(const char *name)
{
    const char *variant = strchr(name, '+');
    char language[64], full[256];
    voice wanted;
    const voice *found;
    if (!engine.set_voice(name)) return 0;
    memset(&wanted, 0, sizeof wanted);
    snprintf(language, sizeof language, "%.*s", (int)(variant ? variant - name : (ptrdiff_t)strlen(name)), name);
    wanted.languages = language;
    if (engine.set_properties(&wanted)) return 1;
    found = engine.current_voice();
    if (!found || !found->languages || !strstr(found->languages, language)) return 1;
    snprintf(full, sizeof full, "%s%s", found->identifier, variant ? variant : "");
    return variant && engine.set_voice(full);
}

static int say(const char *text, const char *name, synthesis *out)
{
    if (set_voice(name)) {
        return tool_fail("speak", "eSpeak NG has no language '%s' (`espeak-ng --voices` lists them)", name);
    }
    out->sample_rate = (uint32_t)engine_rate;
    current = out;
    engine.set_callback(take);
    if (engine.synth(text, strlen(text) + 1u, 0, BY_CHARACTER, 0, IN_UTF8 | PHONES_IN_BRACKETS, NULL, NULL) ||
        engine.synchronize()) {
        return tool_fail("speak", "eSpeak NG cannot speak this text");
    }
    if (out->failed) return tool_fail("speak", "out of memory");
    return out->word_count && out->phone_count && out->sample_count
               ? 0
               : tool_fail("speak", "the text contains no words to speak");
}

int synthesis_make(const char *text, const char *name, synthesis *out)
{
    int status;
    memset(out, 0, sizeof *out);
    status = engine_rate > 0 ? 0 : start();
    if (!status) status = say(text, name, out);
    if (status) synthesis_free(out);
    return status;
}

void synthesis_end(void)
{
    if (engine_rate > 0) engine.terminate(); /* the library stays: it keeps memory that it would lose sight of */
    engine_rate = 0;
}

void synthesis_free(synthesis *s)
{
    free(s->samples);
    free(s->phones);
    free(s->words);
    memset(s, 0, sizeof *s);
}
