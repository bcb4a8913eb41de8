/* joint_match.h: fits clips of one skeleton to another that has the same joints under other names, or only some of
 * them. Bones keep the lengths of the clip. */
#ifndef NOH_CONVERT_CLIPS_JOINT_MATCH_H
#define NOH_CONVERT_CLIPS_JOINT_MATCH_H

#include <stdio.h>

#include "raw_set.h"

typedef struct joint_match_options {
    const char *names;    /* a file of lines "THEIRS OURS", # begins a comment; NULL: none */
    int partial;          /* 1: joints that only one of the two has are left out, where at least half of the other's or
                          of these joints are found */
    const char *retarget; /* clips of humanoids are retargeted (retarget/retarget_set.h): "auto", or a file of bones;
                             NULL: VRM animations alone */
    FILE *report;         /* of what was retargeted; NULL: quiet */
} joint_match_options;

typedef enum joint_match {
    JOINTS_DIFFER,  /* nothing was changed */
    JOINTS_MATCHED, /* the set's skeleton has now the names and parents of `to` */
    JOINTS_FAILED   /* and *error: out of memory, or an error in the file of names */
} joint_match;

/* Fit a set's skeleton and clips to the joints of `to`, by name: the other name in the file of names, or else the same
 * name, without the namespaces that some exporters put before it ("mixamorig7:Hips" is "Hips"), or else another name of
 * the same bone (names.h), where both rest at the same angles, within 10 degrees. Joints that the set
 * lacks keep the bind pose of `to`; a joint that it has between two others is folded into the one below it, by
 * rotation, translation and even scale. report  a sentence about omissions, to be freed, or NULL */
joint_match joint_match_set(raw_set *set, const raw_skeleton *to, const joint_match_options *options, char **report,
                            model_error *error);

#endif
