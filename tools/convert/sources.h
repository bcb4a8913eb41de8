/* sources.h: the files that one pack is built from.
 *
 * One of them is the base: its model and its skeletons are the pack's. From the others only clips are added: clips of
 * joints if their skeleton has the same joints as one of the base's (names and parents; joint_match.h), or as they are
 * retargeted (retarget/retarget_set.h), morph weights if the base has a node of the same name with as many targets,
 * facial capture by the names of targets (shape_match.h). */
#ifndef NOH_CONVERT_SOURCES_H
#define NOH_CONVERT_SOURCES_H

#include "convert/clips/joint_match.h"
#include "convert/clips/model_clips.h"
#include "convert/clips/raw_turn.h"
#include "convert/skin/seam.h"
#include "convert/skin/skins.h"

typedef struct source {
    model *m;          /* of a glTF file; an empty one otherwise */
    model_clips *made; /* of a glTF file */
    raw_set *single;   /* of a file of clips alone; or clips added to a glTF file that has none of its own */
    raw_set **sets;    /* [set_count] the sets of `made`, or `single` */
    uint32_t set_count;
} source;

typedef struct source_options {
    double sample_rate_hz; /* 0: as the file has it */
    double unit_cm;        /* of .bvh, .obj and .fbx; 0: 1, 100 and the file's own */
    skin_options skin;
    const char *const *two_streams; /* [two_stream_count] "SOURCE=TARGET", see two_stream.h */
    uint32_t two_stream_count;
    const char *identity;        /* a file of identity targets, see identity_join.h; NULL: none */
    int split_eyes;              /* 1: eyeballs get joints, see eye_split.h */
    int lips;                    /* 1: a target that brings the lower lip to the teeth, see lip_target.h */
    unsigned choices;            /* CHOICE_* of choices.h: eyes and lips of a face, where neither is asked for above */
    const char *targets;         /* of .obj: a folder of targets, see obj_read.h; NULL: none */
    const char *const *attached; /* [attached_count] models whose meshes are added to the first, see model_attach.h */
    uint32_t attached_count;
    const char *attach_joint; /* the joint that carries models without joints; NULL: the head */
    seam_mode seam;
    turn_options turn;
    extra_list extras; /* extra attributes of vertices that stay, of glTF and FBX */
    unsigned clean;    /* bits of mocap/clean.h */
    FILE *warnings;    /* filled in by convert_files; NULL: none */
} source_options;

/* 0, or 1 and *error; free in both cases. */
int source_read(const char *path, const source_options *options, source *s, model_error *error);
void source_free(source *s);

/* Whether any skeleton has a joint of the name. */
int source_has_joint(const source *s, const char *name);

/* Move the clips of `other` to `base`. Translations are converted to the base's unit. A clip whose name the base
 * already has is renamed FILE/NAME, where FILE is the file's name without its ending. Omissions become
 * warnings of base.
 * options  how joints are matched by other names, or only in part
 * errors   1: no skeleton of base has these joints (the message names the first difference), `other` has no clips, or
 *          the file of names is wrong */
int source_join(source *base, const char *base_path, source *other, const char *other_path,
                const joint_match_options *options, model_error *error);

#endif
