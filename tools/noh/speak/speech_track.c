#include "speech_track.h"
#include "phone_shapes.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/error.h"
#include "convert/clips/raw_set.h"
#include "convert/pack/pack_clips.h"
#include "convert/pack/pack_write.h"

#define FRAMES_PER_SECOND 60u
#define QUIET 0.75f /* how far vowels of a quiet voice move the mouth, as a share of a loud voice */
#define REST_S 0.3  /* of silence behind the last phone: the mouth shuts */

static const struct {
    const char *name;
    float open, round;
} shapes[NOH_VISEME_COUNT] = {
    { "sil", 0.0f, 0.0f }, { "PP", 0.0f, 0.0f },  { "FF", 0.1f, 0.0f }, { "TH", 0.2f, 0.0f }, { "DD", 0.2f, 0.0f },
    { "kk", 0.25f, 0.0f }, { "CH", 0.15f, 0.6f }, { "SS", 0.1f, 0.0f }, { "nn", 0.2f, 0.0f }, { "RR", 0.2f, 0.4f },
    { "aa", 1.0f, 0.0f },  { "E", 0.6f, 0.0f },   { "ih", 0.3f, 0.0f }, { "oh", 0.7f, 0.8f }, { "ou", 0.25f, 1.0f },
};

const char *viseme_name(uint32_t viseme)
{
    return shapes[viseme].name;
}

float viseme_open(uint32_t viseme)
{
    return shapes[viseme].open;
}

float viseme_round(uint32_t viseme)
{
    return shapes[viseme].round;
}

/* ---- phones ---- */

static uint32_t tick_of(const synthesis *said, uint64_t sample)
{
    return (uint32_t)((sample * NOH_TICKS_PER_SECOND + said->sample_rate / 2u) / said->sample_rate);
}

/* A phone that begins where the one before it does takes its place. */
static void add_phone(speech_track *t, uint32_t start, noh_viseme viseme)
{
    if (t->speech.phone_count && t->phones[t->speech.phone_count - 1u].start >= start) t->speech.phone_count--;
    t->phones[t->speech.phone_count].start = start;
    t->phones[t->speech.phone_count++].viseme = viseme;
}

int speech_track_make(const synthesis *said, speech_track *out)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(out, 0, sizeof *out);
    out->phones = calloc(2u * said->phone_count + 1u, sizeof *out->phones);
    if (!out->phones) return tool_fail("speak", "out of memory");
    out->speech.phones = out->phones;
    out->speech.end = tick_of(said, said->sample_count);
    for (size_t i = 0; i < said->phone_count; i++) {
        const uint64_t next = i + 1u < said->phone_count ? said->phones[i + 1u].sample : said->sample_count;
        const uint32_t start = tick_of(said, said->phones[i].sample), end = tick_of(said, next);
        noh_viseme second;
        const noh_viseme first = phone_shape(said->phones[i].name, &second);
        if (first == NOH_VISEME_COUNT || start >= out->speech.end) continue; /* a mark, or nothing that lips show */
        add_phone(out, start, first);
        if (second != NOH_VISEME_COUNT && end > start + 5u) add_phone(out, start + (end - start) * 3u / 5u, second);
    }
    out->seconds = (double)said->sample_count / said->sample_rate;
    if (noh_speech_check(&out->speech, &error)) {
        speech_track_free(out);
        return tool_fail("speak", "%s (phone %llu)", error.what, (unsigned long long)error.where);
    }
    return 0;
}

void speech_track_free(speech_track *t)
{
    free(t->phones);
    free(t->frames);
    memset(t, 0, sizeof *t);
}

int speech_track_frames(speech_track *t, double seconds)
{
    memset(t, 0, sizeof *t);
    t->seconds = seconds;
    t->frame_room = (uint32_t)(seconds * SPEECH_TRACK_RATE) + 1u;
    t->frames = calloc(t->frame_room, sizeof *t->frames);
    return t->frames ? 0 : tool_fail("speak", "out of memory");
}

/* The frame whose middle is at or before a tick, the one behind it, and how far between them. */
static float frames_at(const speech_track *t, int64_t tick, const speech_track_frame **a, const speech_track_frame **b)
{
    const double last = (double)t->frame_count - 1.0;
    const double at = (double)tick * SPEECH_TRACK_RATE / NOH_TICKS_PER_SECOND - 0.5;
    const double held = at < 0.0 ? 0.0 : at > last ? last : at;
    const uint32_t n = (uint32_t)held;
    *a = &t->frames[n];
    *b = n + 1u < t->frame_count ? &t->frames[n + 1u] : *a;
    return (float)(held - n);
}

/* Before it begins and after it has ended, the mouth is shut. */
static int is_outside(const speech_track *t, int64_t tick)
{
    return !t->frame_count || tick < 0 || (double)tick > t->seconds * NOH_TICKS_PER_SECOND;
}

void speech_track_visemes(const speech_track *t, int64_t tick, float *visemes)
{
    const speech_track_frame *a, *b;
    float part;
    if (!t->frames) {
        noh_speech_visemes(&t->speech, tick, visemes);
        return;
    }
    memset(visemes, 0, NOH_VISEME_COUNT * sizeof *visemes);
    visemes[NOH_VISEME_SIL] = 1.0f;
    if (is_outside(t, tick)) return;
    part = frames_at(t, tick, &a, &b);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        visemes[v] = a->visemes[v] + part * (b->visemes[v] - a->visemes[v]);
    }
}

static float curve_at(const speech_track *t, int64_t tick, float (*of)(uint32_t viseme))
{
    float visemes[NOH_VISEME_COUNT], sum = 0.0f;
    speech_track_visemes(t, tick, visemes);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) sum += visemes[v] * of(v);
    return sum;
}

float speech_track_open(const speech_track *t, int64_t tick)
{
    const speech_track_frame *a, *b;
    if (!t->frames || is_outside(t, tick)) return curve_at(t, tick, viseme_open);
    (void)frames_at(t, tick, &a, &b);
    return a->open;
}

float speech_track_round(const speech_track *t, int64_t tick)
{
    return curve_at(t, tick, viseme_round);
}

uint32_t speech_track_viseme(const speech_track *t, int64_t tick)
{
    uint32_t low = 0, high = t->speech.phone_count;
    if (t->frames) {
        const speech_track_frame *a, *b;
        if (is_outside(t, tick)) return NOH_VISEME_SIL;
        (void)frames_at(t, tick, &a, &b);
        return a->shape;
    }
    if (tick < (int64_t)t->phones[0].start || tick >= (int64_t)t->speech.end) return NOH_VISEME_SIL;
    while (high - low > 1u) {
        const uint32_t middle = low + (high - low) / 2u;
        if ((int64_t)t->phones[middle].start <= tick) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return t->phones[low].viseme;
}

/* ---- a clip ---- */

typedef struct face_node {
    noh_mesh mesh;
    uint32_t node; /* NOH_NONE: a pack without nodes */
    noh_face_link *links;
    uint32_t link_count;
} face_node;

/* The n-th mesh that the pack draws. */
static int drawn_mesh(const noh_pack *pack, uint32_t n, face_node *out)
{
    const uint32_t mesh = pack->node_count ? pack->nodes[n].mesh : n;
    memset(out, 0, sizeof *out);
    out->node = pack->node_count ? n : NOH_NONE;
    return mesh != NOH_NONE && noh_pack_mesh_at(pack, mesh, &out->mesh, NULL) == NOH_OK;
}

/* Only rows of mouth shapes are kept: a clip of speech moves nothing else. */
static int bind(const noh_pack *pack, face_node *n)
{
    const uint32_t targets = n->mesh.header->target_count;
    const noh_face_recipe own = noh_face_recipe_in_pack(pack);
    const noh_face_recipe *const recipes[4] = { &own, &noh_face_recipe_arkit, &noh_face_recipe_vrm,
                                                &noh_face_recipe_units };
    const char **names = calloc(targets + 1u, sizeof *names);
    noh_face_link *all;
    uint32_t count = 0;
    for (uint32_t i = 0; names && i < targets; i++) names[i] = noh_pack_string(pack, n->mesh.targets[i].name);
    if (names) count = noh_face_recipe_bind(recipes, 4, names, targets, NULL, 0);
    all = calloc(count + 1u, sizeof *all);
    if (names && all) {
        (void)noh_face_recipe_bind(recipes, 4, names, targets, all, count);
        for (uint32_t i = 0; i < count; i++) {
            if (all[i].channel >= NOH_CHANNEL_VISEMES) all[n->link_count++] = all[i];
        }
    }
    n->links = all;
    free(names);
    return !names || !all;
}

static float shut_of(const float *visemes)
{
    return visemes[NOH_VISEME_PP] + visemes[NOH_VISEME_FF];
}

/* The shapes of a frame. If the lips are more closed a frame earlier or later, that frame's: blends between frames then
 * stay closed for as long as the lips do. */
static void visemes_of(const speech_track *t, uint32_t frame, float *visemes)
{
    const int64_t step = NOH_TICKS_PER_SECOND / FRAMES_PER_SECOND, tick = (int64_t)frame * step;
    float other[NOH_VISEME_COUNT];
    speech_track_visemes(t, tick, visemes);
    for (int64_t at = tick - step; at <= tick + step; at += 2 * step) {
        speech_track_visemes(t, at, other);
        if (shut_of(other) > shut_of(visemes)) memcpy(visemes, other, sizeof other);
    }
}

static int64_t tick_of_frame(uint32_t frame)
{
    return (int64_t)frame * (NOH_TICKS_PER_SECOND / FRAMES_PER_SECOND);
}

static void fill_frame(const speech_track *t, const prosody *voice, const face_node *n, uint32_t frame, float *weights)
{
    float visemes[NOH_VISEME_COUNT], channels[NOH_CHANNEL_COUNT];
    const float size = QUIET + (1.0f - QUIET) * prosody_at(voice, tick_of_frame(frame)).loud;
    visemes_of(t, frame, visemes);
    for (uint32_t v = NOH_VISEME_AA; v <= NOH_VISEME_OU; v++) visemes[v] *= size;
    noh_face_channels(NULL, visemes, NOH_MOUTH_BLEND, channels);
    memcpy(weights, n->mesh.weights, n->mesh.header->target_count * sizeof *weights);
    noh_face_apply(n->links, n->link_count, channels, weights);
}

static int fill_floats(const speech_track *t, const prosody *voice, const noh_pack *pack, const face_node *n,
                       uint32_t frames, raw_floats *out)
{
    const uint32_t targets = n->mesh.header->target_count;
    const char *name = n->node == NOH_NONE ? n->mesh.name : noh_pack_string(pack, pack->nodes[n->node].name);
    if (raw_floats_alloc(out, frames, targets)) return 1;
    out->name = model_string(name);
    out->node = n->node == NOH_NONE ? 0 : n->node;
    out->radius = calloc(targets + 1u, sizeof *out->radius);
    if (!out->name || !out->radius) return 1;
    for (uint32_t i = 0; i < targets; i++) out->radius[i] = 100.0f * n->mesh.targets[i].radius; /* centimetres */
    for (uint32_t f = 0; f < frames; f++) fill_frame(t, voice, n, f, out->values + (size_t)f * targets);
    return 0;
}

/* The byte of the n-th character of a text in UTF-8, or its end. */
static const char *character(const char *text, uint32_t n)
{
    while (*text && n) {
        text++;
        while ((*text & 0xc0) == 0x80) text++;
        n--;
    }
    return text;
}

static int add_words(const synthesis *said, const char *text, raw_clip *clip)
{
    for (size_t i = 0; i < said->word_count; i++) {
        const char *first = character(text, said->words[i].first), *end = character(first, said->words[i].length);
        raw_event e;
        int failed;
        memset(&e, 0, sizeof e);
        e.name = model_string_of(first, (size_t)(end - first));
        e.time_s = (double)said->words[i].sample / said->sample_rate;
        failed = !e.name || (e.name[0] && raw_clip_add_event(clip, &e));
        free(e.name);
        if (failed) return 1;
    }
    return 0;
}

/* A named float that gives a face (modules.h) the share of the mouth in use, which emotions leave free. */
static int add_float(const speech_track *t, const char *name, int shut_alone, raw_clip *clip)
{
    raw_floats *out = &clip->floats[clip->float_count++];
    if (raw_floats_alloc(out, clip->frame_count, 1)) return 1;
    out->name = model_string(name);
    out->node = MODEL_NONE;
    for (uint32_t f = 0; f < clip->frame_count; f++) {
        float visemes[NOH_VISEME_COUNT], moves;
        visemes_of(t, f, visemes);
        moves = shut_alone ? shut_of(visemes) : 1.0f - visemes[NOH_VISEME_SIL];
        out->values[f] = moves < 0.0f ? 0.0f : moves > 1.0f ? 1.0f : moves;
    }
    return !out->name;
}

/* Named floats with the fields of noh_face_speech. */
static int add_voice(const prosody *voice, raw_clip *clip)
{
    static const char *const names[] = { "speech-brows", "speech-nod", "speech-blink", "speech-away" };
    for (uint32_t i = 0; i < 4u; i++) {
        raw_floats *out = &clip->floats[clip->float_count++];
        if (raw_floats_alloc(out, clip->frame_count, 1)) return 1;
        out->name = model_string(names[i]);
        out->node = MODEL_NONE;
        for (uint32_t f = 0; f < clip->frame_count; f++) {
            const noh_face_speech asked = prosody_at(voice, tick_of_frame(f)).face;
            const float fields[4] = { asked.brows, asked.nod, asked.blink, asked.away };
            out->values[f] = fields[i];
        }
        if (!out->name) return 1;
    }
    return 0;
}

/* The clip's floats: the weights of every node with mouth shapes. Returns 1 when out of memory. */
static int add_faces(const speech_track *t, const prosody *voice, const noh_pack *pack, raw_clip *clip)
{
    const uint32_t count = pack->node_count ? pack->node_count : pack->runs[NOH_CHUNK_MESH].count;
    int failed = 0;
    clip->floats = calloc(count + 6u, sizeof *clip->floats);
    failed = !clip->floats;
    for (uint32_t i = 0; i < count && !failed; i++) {
        face_node n;
        if (!drawn_mesh(pack, i, &n)) continue;
        failed = bind(pack, &n);
        if (!failed && n.link_count) {
            failed = fill_floats(t, voice, pack, &n, clip->frame_count, &clip->floats[clip->float_count++]);
        }
        free(n.links);
    }
    if (!failed && clip->float_count) {
        failed = add_float(t, "speech", 0, clip) || add_float(t, "lips-shut", 1, clip) || add_voice(voice, clip);
    }
    return failed;
}

static int encode(raw_set *set, const char *path, byte_buffer *out)
{
    clips_settings settings;
    encoded_clips made;
    model empty;
    model_error error;
    int failed;
    memset(&settings, 0, sizeof settings);
    memset(&empty, 0, sizeof empty);
    settings.clip.error_cm = 0.01;
    settings.clip.shell_cm = 3.0;
    settings.m = &empty;
    failed = clips_encode(&set, 1, &settings, &made, &error) || pack_write(&empty, NULL, NULL, &made, out, &error);
    clips_free(&made);
    return failed ? tool_fail(path, "%s", error.what) : 0;
}

int speech_track_pack(const speech_track *t, const prosody *voice, const synthesis *said, const char *text,
                      const pack_file *face, const char *name, byte_buffer *out)
{
    raw_set *set = raw_set_new(0, 1);
    raw_clip *clip = set ? set->clips : NULL;
    int status = clip ? 0 : tool_fail(face->path, "out of memory");
    if (clip) {
        const uint32_t frames = 1u + (uint32_t)((t->seconds + REST_S) * FRAMES_PER_SECOND);
        set->skeleton.unit_cm = 100.0; /* a unit of a pack is a metre */
        clip->name = model_string(name);
        clip->sample_rate_hz = FRAMES_PER_SECOND;
        clip->frame_count = frames;
        if (!clip->name || raw_clip_alloc(clip, frames, 0) || add_faces(t, voice, &face->pack, clip) ||
            add_words(said, text, clip)) {
            status = tool_fail(face->path, "out of memory");
        } else if (!clip->float_count) {
            status = tool_fail(
                face->path,
                "the pack has no mouth targets with names of ARKit, VRM or facial units (`noh info` lists its targets)");
        }
    }
    if (!status) status = encode(set, face->path, out);
    raw_set_free(set);
    return status;
}
