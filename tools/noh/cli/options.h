/* options.h: options that several verbs share, as rows of their tables. T: the type of the verb's arguments; m: the
 * member for the value; further members of struct option may follow. */
#ifndef NOH_NOH_CLI_OPTIONS_H
#define NOH_NOH_CLI_OPTIONS_H

#include "args.h"

#define OPTION_JSON(T, m)                                              \
    {                                                                  \
        .name = "--json", .kind = OPTION_FLAG, .at = offsetof(T, m),   \
        .what = "print JSON on stdout; errors too: {\"error\": {...}}" \
    }

#define OPTION_ANIM(T, m, ...)                                                              \
    {                                                                                       \
        .name = "--anim", .kind = OPTION_INPUT, .at = offsetof(T, m), .value = "PACK",      \
        .what = "take the clips from another pack", .example = "body_anim.noh", __VA_ARGS__ \
    }

#define OPTION_ANIMS(T, m, ...)                                                                      \
    {                                                                                                \
        .name = "--anim", .kind = OPTION_INPUTS, .at = offsetof(T, m), .value = "PACK",              \
        .what = "take the clips from another pack; may repeat: a clip of a later pack replaces one " \
                "of the same name",                                                                  \
        .example = "body_anim.noh", __VA_ARGS__                                                      \
    }

#define OPTION_FACE(T, m, text)                                                                          \
    {                                                                                                    \
        .name = "--face", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "on|off", .initial = text, \
        .what = "whether faces blink, look about, breathe and keep moving, in addition to the clips; a " \
                "head without joints turns as a whole"                                                   \
    }

#define OPTION_SPRINGS(T, m)                                                                                \
    {                                                                                                       \
        .name = "--springs", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "on|off", .initial = "on", \
        .what = "whether the pack's springs swing (noh build --springs), in addition to the clips"          \
    }

#define OPTION_TIER(T, m, ...)                                                                                 \
    {                                                                                                          \
        .name = "--tier", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "full|phone", .initial = "full", \
        .what = "how much is computed at each pixel: phone approximates, for the GPUs of cheap phones",        \
        .example = "phone", __VA_ARGS__                                                                        \
    }

#define OPTION_WEIGHT_RULES(T, m)                                                                          \
    {                                                                                                      \
        .name = "--weight-rules", .kind = OPTION_FLAG, .at = offsetof(T, m),                               \
        .what = "apply the pack's weight rules (range, oppose and share: noh help FORMATS) to all weights" \
    }

#define OPTION_HAIR(T, m, text)                                                                          \
    {                                                                                                    \
        .name = "--hair", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "on|off", .initial = text, \
        .what = "whether the pack's hair, if any, is drawn and moves"                                    \
    }

/* Marks and how they are drawn. */
#define OPTIONS_DECALS(T, m, k, others)                                                                              \
    { .name = "--decal",                                                                                             \
      .kind = OPTION_LIST,                                                                                           \
      .at = offsetof(T, m),                                                                                          \
      .value = "X,Y[,SIZE[,RRGGBB]]",                                                                                \
      .what = "put a mark on the figure in its rest pose: X,Y in the picture, 0 to 1 from its "                      \
              "upper left corner; SIZE, half its width in model units; its colour. May repeat, "                     \
              "up to 64 times",                                                                                      \
      .example = "0.5,0.4,0.01,aa2211",                                                                              \
      .excludes = (others) },                                                                                        \
    {                                                                                                                \
        .name = "--decal-kind", .kind = OPTION_TEXT, .at = offsetof(T, k), .value = "rest|grown", .initial = "rest", \
        .what = "how marks are drawn: rest looks each pixel up by its rest position, and also "                      \
                "marks a fold that touches there; grown draws triangles, grown from the one that "                   \
                "was hit",                                                                                           \
        .example = "grown", .needs = "--decal"                                                                       \
    }

#define OPTION_FEEL(T, m, ...)                                                                  \
    {                                                                                           \
        .name = "--feel", .kind = OPTION_LIST, .at = offsetof(T, m), .value = "EMOTION=AMOUNT", \
        .what = "an emotion of a live face: joy, sadness, surprise, fear, anger, disgust, "     \
                "contempt; may repeat",                                                         \
        .example = "joy=0.7", __VA_ARGS__                                                       \
    }

#define OPTION_CLIP(T, m, ...)                                                                         \
    {                                                                                                  \
        .name = "--clip", .kind = OPTION_LIST, .at = offsetof(T, m), .value = "NAME",                  \
        .what = "pose by this clip; repeat it to play several at once", .example = "walk", __VA_ARGS__ \
    }

#define OPTION_TIME(T, m, ...)                                                                       \
    {                                                                                                \
        .name = "--time", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "S", .initial = "0", \
        .what = "time in the clips, seconds", .example = "0.5", __VA_ARGS__                          \
    }

#define OPTION_WEIGHT(T, m, ...)                                                                             \
    {                                                                                                        \
        .name = "--weight", .kind = OPTION_LIST, .at = offsetof(T, m), .value = "NAME=V",                    \
        .what = "weight of a target; may repeat: the last one for each name counts", .example = "smile=0.7", \
        __VA_ARGS__                                                                                          \
    }

#define OPTION_PATH(T, m, ...)                                                 \
    {                                                                          \
        .name = "--path", .kind = OPTION_TEXT, .at = offsetof(T, m),           \
        .value = "auto|blend|layered|mrt|per-layer|gather|direct|cpu|streams", \
        .what = "how targets are accumulated (noh help FORMATS)", __VA_ARGS__  \
    }

#define OPTION_ACCUMULATE(T, m, ...)                                                                \
    {                                                                                               \
        .name = "--accumulate", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "auto|f32|f16", \
        .what = "format of the accumulation texels", __VA_ARGS__                                    \
    }

#define OPTION_DRIVER(T, m, ...)                                                                         \
    {                                                                                                    \
        .name = "--driver", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "egl|osmesa|angle|glfw", \
        .what = "where the GL context comes from", __VA_ARGS__                                           \
    }

#define OPTION_LOD(T, m, ...)                                                                                        \
    {                                                                                                                \
        .name = "--lod", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "K", .initial = "0",                  \
        .what = "LOD level, 0 to 7; 0 is the full mesh; a mesh with fewer levels uses its coarsest", .example = "2", \
        __VA_ARGS__                                                                                                  \
    }

#define OPTION_LIGHT_NAME(T, m, text, ...)                                                                   \
    {                                                                                                        \
        .name = "--light", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "NAME|FILE", .initial = text, \
        .what = "environment light: white, studio, room, sky, a panorama (.hdr, .png), or none "             \
                "(one plain lamp); "                                                                         \
                "auto: room for skin, sky for toons, otherwise studio; none for bones and --debug",          \
        .example = "room", __VA_ARGS__                                                                       \
    }

#define OPTION_LIGHT_ROTATE(T, m, ...)                                                                      \
    {                                                                                                       \
        .name = "--rotate", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "DEG", .initial = "0",    \
        .what = "turn the environment light about the vertical axis, degrees", .example = "90", __VA_ARGS__ \
    }

#define OPTION_LIGHT_TONEMAP(T, m, ...)                                                                      \
    {                                                                                                        \
        .name = "--tonemap", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "neutral|filmic|none",      \
        .initial = "neutral",                                                                                \
        .what = "tone mapping of bright light: neutral keeps colours; filmic has a shoulder; none clips it", \
        .example = "none", __VA_ARGS__                                                                       \
    }

/* Rows of draw/lighting.h; m: the light_options; text: the light by default; more: what every row needs or excludes */
#define OPTIONS_LIGHT(T, m, text, ...)                                                                                 \
    OPTION_LIGHT_NAME(T, m.light, text, __VA_ARGS__), OPTION_LIGHT_ROTATE(T, m.rotate, __VA_ARGS__),                   \
        OPTION_LIGHT_TONEMAP(T, m.tonemap, __VA_ARGS__),                                                               \
        { .name = "--shadow",                                                                                          \
          .kind = OPTION_TEXT,                                                                                         \
          .at = offsetof(T, m.shadow),                                                                                 \
          .value = "on|off|blob",                                                                                      \
          .initial = "on",                                                                                             \
          .what = "whether the strongest part of the light casts shadows; blob: soft spots under "                     \
                  "the feet instead",                                                                                  \
          .example = "off",                                                                                            \
          __VA_ARGS__ },                                                                                               \
        { .name = "--transfer",                                                                                        \
          .kind = OPTION_TEXT,                                                                                         \
          .at = offsetof(T, m.transfer),                                                                               \
          .value = "on|off",                                                                                           \
          .initial = "on",                                                                                             \
          .what = "whether the mesh shadows itself, in packs built with --transfer",                                   \
          .example = "off",                                                                                            \
          __VA_ARGS__ },                                                                                               \
    {                                                                                                                  \
        .name = "--background", .kind = OPTION_TEXT, .at = offsetof(T, m.background), .value = "light|gradient|plain", \
        .initial = "light",                                                                                            \
        .what = "background: the light, blurred; a gradient of its colours below and above; or plain grey",            \
        .example = "plain", __VA_ARGS__                                                                                \
    }

#define OPTIONS_BODY(T, m)                                                                                  \
    { .name = "--look-at",                                                                                  \
      .kind = OPTION_TEXT,                                                                                  \
      .at = offsetof(T, m.look_at),                                                                         \
      .value = "X,Y,Z",                                                                                     \
      .what = "a point that eyes, head, neck and spine turn to, in the model's axes and the pack's unit",   \
      .example = "0.5,1.6,2" },                                                                             \
    {                                                                                                       \
        .name = "--ground", .kind = OPTION_TEXT, .at = offsetof(T, m.ground), .value = "stairs|slope|FILE", \
        .what = "plant the feet on stairs of 0.17 m going up along +z, on a slope of 20 degrees "           \
                "going down, or on terrain (.png: a metre between pixels, height a tenth of the "           \
                "width; .glb: as modelled), as far as the clips walk; the ground is drawn",                 \
        .needs = "--clip", .excludes = "--bones"                                                            \
    }

#define OPTION_CAMERA(T, m, text)                                                                                      \
    {                                                                                                                  \
        .name = "--camera", .kind = OPTION_TEXT, .at = offsetof(T, m),                                                 \
        .value = "auto|face|upper|full[,AZ,EL]|AZ,EL[,DIST]", .initial = text,                                         \
        .what = "what the camera frames (face: with its hair; upper: a body from the waist; full: all of it; auto: "   \
                "the face of a head and of a body whose clips move no joints, otherwise full), and its position: "     \
                "azimuth and elevation in degrees, distance in model units; a frame is seen from the front of a body", \
        .example = "face,30,10"                                                                                        \
    }

#define OPTION_INSTANCES(T, m, text, ...)                                                                  \
    {                                                                                                      \
        .name = "--instances", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "N", .initial = text, \
        .example = "100", __VA_ARGS__                                                                      \
    }

#endif
