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

#define OPTION_ANIMS(T, m, ...)                                                                    \
    {                                                                                              \
        .name = "--anim", .kind = OPTION_INPUTS, .at = offsetof(T, m), .value = "PACK",            \
        .what = "take the clips from another pack; repeat it for several, of which a later one's " \
                "clip replaces one of the same name",                                              \
        .example = "body_anim.noh", __VA_ARGS__                                                    \
    }

#define OPTION_FACE(T, m, text)                                                                          \
    {                                                                                                    \
        .name = "--face", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "on|off", .initial = text, \
        .what = "whether faces blink, look about, breathe and are never still, beside what clips say"    \
    }

#define OPTION_SPRINGS(T, m)                                                                                \
    {                                                                                                       \
        .name = "--springs", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "on|off", .initial = "on", \
        .what = "whether the springs of the pack swing (noh build --springs), beside what clips say"        \
    }

#define OPTION_WEIGHT_RULES(T, m)                                                                                   \
    {                                                                                                               \
        .name = "--weight-rules", .kind = OPTION_FLAG, .at = offsetof(T, m),                                        \
        .what = "keep the pack's rules for weights (range, oppose and share: noh help FORMATS), whoever says these" \
    }

#define OPTION_HAIR(T, m, text)                                                                          \
    {                                                                                                    \
        .name = "--hair", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "on|off", .initial = text, \
        .what = "whether the hair of the pack is drawn and moves, where it has some"                     \
    }

/* Marks and how they are drawn. */
#define OPTIONS_DECALS(T, m, k, others)                                                                                                                                            \
    { .name = "--decal",                                                                                                                                                           \
      .kind = OPTION_LIST,                                                                                                                                                         \
      .at = offsetof(T, m),                                                                                                                                                        \
      .value = "X,Y[,SIZE[,RRGGBB]]",                                                                                                                                              \
      .what =                                                                                                                                                                      \
          "a mark on the figure, struck at rest: where in the picture, 0 to 1 from its upper left corner; half its width, in model units; its colour. May repeat, up to 64 times", \
      .example = "0.5,0.4,0.01,aa2211",                                                                                                                                            \
      .excludes = (others) },                                                                                                                                                      \
    {                                                                                                                                                                              \
        .name = "--decal-kind", .kind = OPTION_TEXT, .at = offsetof(T, k), .value = "rest|grown", .initial = "rest",                                                               \
        .what =                                                                                                                                                                    \
            "how marks are drawn: looked up by where a pixel is at rest, also on a fold that only touches there; or grown as triangles, from the one that was hit",                \
        .example = "grown", .needs = "--decal"                                                                                                                                     \
    }

#define OPTION_FEEL(T, m)                                                                                              \
    {                                                                                                                  \
        .name = "--feel", .kind = OPTION_LIST, .at = offsetof(T, m), .value = "EMOTION=AMOUNT",                        \
        .what = "an emotion of faces that are on: joy, sadness, surprise, fear, anger, disgust, contempt; may repeat", \
        .example = "joy=0.7", .needs = "--face"                                                                        \
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

#define OPTION_WEIGHT(T, m, ...)                                                                            \
    {                                                                                                       \
        .name = "--weight", .kind = OPTION_LIST, .at = offsetof(T, m), .value = "NAME=V",                   \
        .what = "weight of a target; may repeat, and the last of each name counts", .example = "smile=0.7", \
        __VA_ARGS__                                                                                         \
    }

#define OPTION_PATH(T, m, ...)                                                \
    {                                                                         \
        .name = "--path", .kind = OPTION_TEXT, .at = offsetof(T, m),          \
        .value = "auto|blend|layered|mrt|per-layer|gather|cpu|streams",       \
        .what = "how targets are accumulated (noh help FORMATS)", __VA_ARGS__ \
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

#define OPTION_LOD(T, m, ...)                                                                                          \
    {                                                                                                                  \
        .name = "--lod", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "K", .initial = "0",                    \
        .what = "LOD level, 0 to 7; 0 is the full mesh; meshes with fewer levels take their coarsest", .example = "2", \
        __VA_ARGS__                                                                                                    \
    }

#define OPTION_LIGHT_NAME(T, m, text, ...)                                                                          \
    {                                                                                                               \
        .name = "--light", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "NAME|FILE", .initial = text,        \
        .what = "light from all around: white, studio, room, sky, a panorama (.hdr, .png), or none (a plain one); " \
                "auto: studio, but none for bones and --debug",                                                     \
        .example = "room", __VA_ARGS__                                                                              \
    }

#define OPTION_LIGHT_ROTATE(T, m, ...)                                                                   \
    {                                                                                                    \
        .name = "--rotate", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "DEG", .initial = "0", \
        .what = "turn that light about the vertical axis, degrees", .example = "90", __VA_ARGS__         \
    }

#define OPTION_LIGHT_TONEMAP(T, m, ...)                                                                              \
    {                                                                                                                \
        .name = "--tonemap", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "filmic|none", .initial = "filmic", \
        .what = "how bright light becomes colour: by a curve with a shoulder, or cut off", .example = "none",        \
        __VA_ARGS__                                                                                                  \
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
          .what = "whether the strongest part of that light casts shadows; blob: none, but soft spots under feet",     \
          .example = "off",                                                                                            \
          __VA_ARGS__ },                                                                                               \
        { .name = "--transfer",                                                                                        \
          .kind = OPTION_TEXT,                                                                                         \
          .at = offsetof(T, m.transfer),                                                                               \
          .value = "on|off",                                                                                           \
          .initial = "on",                                                                                             \
          .what = "whether the mesh shades itself from that light, in packs built with --transfer",                    \
          .example = "off",                                                                                            \
          __VA_ARGS__ },                                                                                               \
    {                                                                                                                  \
        .name = "--background", .kind = OPTION_TEXT, .at = offsetof(T, m.background), .value = "light|gradient|plain", \
        .initial = "light", .what = "what is behind: that light, blurred; its colours from below and above; grey",     \
        .example = "plain", __VA_ARGS__                                                                                \
    }

#define OPTIONS_BODY(T, m)                                                                                                                                                                           \
    { .name = "--look-at",                                                                                                                                                                           \
      .kind = OPTION_TEXT,                                                                                                                                                                           \
      .at = offsetof(T, m.look_at),                                                                                                                                                                  \
      .value = "X,Y,Z",                                                                                                                                                                              \
      .what = "a point that eyes, head, neck and spine turn to, in the pack's unit; the body looks along +z",                                                                                        \
      .example = "0.5,1.6,2" },                                                                                                                                                                      \
    {                                                                                                                                                                                                \
        .name = "--ground", .kind = OPTION_TEXT, .at = offsetof(T, m.ground), .value = "stairs|slope|FILE",                                                                                          \
        .what =                                                                                                                                                                                      \
            "feet on steps of 0.17 m up, on 20 degrees down, along +z, or on terrain (.png: a metre between pixels, a tenth as high as wide; .glb: as it is), as far as the clips walk; drawn, too", \
        .needs = "--clip", .excludes = "--bones"                                                                                                                                                     \
    }

#define OPTION_CAMERA(T, m, text)                                                                                    \
    {                                                                                                                \
        .name = "--camera", .kind = OPTION_TEXT, .at = offsetof(T, m), .value = "face|body|AZ,EL[,DIST]",            \
        .initial = text,                                                                                             \
        .what = "what the camera frames, or where it is: azimuth and elevation in degrees, distance in model units", \
        .example = "30,10,0.8"                                                                                       \
    }

#define OPTION_INSTANCES(T, m, text, ...)                                                                  \
    {                                                                                                      \
        .name = "--instances", .kind = OPTION_NUMBER, .at = offsetof(T, m), .value = "N", .initial = text, \
        .example = "100", __VA_ARGS__                                                                      \
    }

#endif
