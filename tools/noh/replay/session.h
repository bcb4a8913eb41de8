/* session.h: the inputs of a game to a stage of one pack, frame by frame, and their results.
 *
 *   session_open, session_close     a stage of a pack with all features that the pack supports
 *   session_draw                    a session by seed
 *   session_run                     play a session, and hash each part of each frame
 *   session_give, session_step, session_hash   the same, frame by frame
 *   session_write, session_read     as text (session_text.h)
 *
 * A stage is deterministic: the same pack and the same inputs give the same hashes on every processor. The stage of a
 * session follows from its pack and its number of actors: root motion along the ground, inertia, all graphs, and a
 * face and a ragdoll if the pack supports them. Nothing is drawn. */
#ifndef NOH_NOH_REPLAY_SESSION_H
#define NOH_NOH_REPLAY_SESSION_H

#include "noh/base.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"

#define SESSION_ACTORS_MAX 64u
#define SESSION_FRAMES_MAX 1000000u
#define SESSION_NUMBERS_MAX 6u
#define SESSION_FRAME_TICKS 800u /* 1/60 s */

/* The hashes of a frame. */
typedef enum session_part {
    SESSION_STATE,    /* noh_stage_hash */
    SESSION_EVENTS,   /* callback keys, and the results of inputs */
    SESSION_PLACES,   /* of actors */
    SESSION_FLOATS,   /* morph weights and named floats */
    SESSION_JOINTS,   /* in the world */
    SESSION_PALETTES, /* of skins */
    SESSION_VERTICES, /* of the actor whose turn it is, morphed and skinned; 0 in other frames */
    SESSION_PARTS
} session_part;

const char *session_part_name(session_part part);

/* In the order of the table in session_input.c. */
typedef enum session_what {
    SESSION_SPAWN, /* x, z, tangent of half the heading */
    SESSION_DESPAWN,
    SESSION_PLAY,      /* name of a clip; layer, fade in ticks, speed */
    SESSION_STOP,      /* layer, fade in ticks */
    SESSION_GRAPH,     /* name of a graph; layer, fade in ticks */
    SESSION_PARAMETER, /* name; value */
    SESSION_FLOAT,     /* name; value, amount */
    SESSION_LOOK,      /* point x, y, z */
    SESSION_FEEL,      /* name of an emotion; amount, onset, hold and fade in ticks */
    SESSION_HIT,       /* point x, y, z; impulse x, y, z in newton seconds */
    SESSION_RISE,      /* gets up, by the clips whose names begin with get_up */
    SESSION_KILL,
    SESSION_REVIVE,
    SESSION_VIEW,  /* actor 0; yaw and pitch in radians, distance */
    SESSION_TICKS, /* actor 0; of this frame and those that follow */
    SESSION_WHATS
} session_what;

typedef struct session_input {
    uint32_t frame;
    uint8_t what;   /* session_what */
    uint16_t actor; /* 0..: in the order in which actors first came in; a later one takes a free number */
    char name[NOH_NAME_BYTES_MAX];
    float numbers[SESSION_NUMBERS_MAX];
} session_input;

/* How the inputs of a kind are written: the word, whether a name follows the actor, and how many numbers do. */
typedef struct session_form {
    const char *word;
    int has_name;
    uint32_t number_count;
} session_form;

extern const session_form session_forms[SESSION_WHATS];

typedef struct session_hashes {
    uint32_t part[SESSION_PARTS];
} session_hashes;

typedef struct session {
    uint32_t pack_crc, actor_count, frame_count;
    session_input *inputs; /* [input_count], by frame */
    uint32_t input_count, input_room;
    session_hashes *hashes; /* [frame_count]; NULL: not known */
} session;

void session_free(session *s);
/* 0, or 1 when out of memory. */
int session_add(session *s, const session_input *input);

/* A stage for a session. */
typedef struct session_stage {
    const noh_pack *pack;
    noh_kind_desc kind;
    noh_kind_face face;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory, *sums;
    size_t sum_bytes;
    noh_actor actors[SESSION_ACTORS_MAX];
    uint32_t actor_count;
    int has_face, has_ragdoll;
    float *matrices;         /* [NOH_SKIN_JOINTS_MAX][12] */
    float view[3];           /* yaw, pitch, distance */
    uint32_t ticks;          /* of a frame */
    uint32_t returned;       /* CRC of the results of this frame's inputs */
    uint32_t refused;        /* inputs that returned an error, */
    uint32_t first_refused;  /* the first of them, */
    noh_error refused_error; /* and why */
} session_stage;

/* A stage for this many actors, all without clips yet. 0, or 1 and *error. */
int session_open(session_stage *stage, const noh_pack *pack, uint32_t actor_count, noh_error *error);
void session_close(session_stage *stage);

/* Do one input, the index-th of its session. Its result is hashed, and kept if it is an error. */
void session_do(session_stage *stage, const session_input *input, uint32_t index);

/* Fill a session with random inputs by seed: clips, graphs, parameters, floats, gaze, emotions, hits, as the pack
 * supports them. `stage` gives names. 0, or 1 when out of memory. */
int session_draw(session *s, const session_stage *stage, uint32_t frame_count, uint32_t seed);

/* The parts of session_run: do a frame's inputs, from *next on; step (0, or 1 and *error); hash. */
void session_give(const session *s, session_stage *stage, uint32_t frame, uint32_t *next);
int session_step(session_stage *stage, noh_error *error);
void session_hash(session_stage *stage, uint32_t frame, session_hashes *hashes);

/* Play a session on a fresh stage into hashes[frame_count]. 0, or 1 and *error. */
int session_run(const session *s, session_stage *stage, session_hashes *hashes, noh_error *error);

/* The first frame whose hashes differ, of the first `frames` of both, and a mask of the parts that do; frames: none. */
uint32_t session_differ(const session_hashes *a, const session_hashes *b, uint32_t frames, uint32_t *parts);

#endif
