/* drop_scene.h: ragdolls of a pack's character that fall onto a floor, step by step, and how well they do. */
#ifndef NOH_NOH_DROP_DROP_SCENE_H
#define NOH_NOH_DROP_DROP_SCENE_H

#include "file/pack_file.h"
#include "life/physics/ragdoll_internal.h"
#include "noh/body.h"
#include "noh/low_life.h"

typedef struct drop_scene {
    noh_ragdoll_rig rig;
    noh_ragdolls *set;
    size_t bytes;
    uint32_t dolls, step, steps; /* steps of 1/60 s: made, to be made */
    noh_world world;
    noh_plane floor;
    noh_ragdoll_measures worst; /* of all steps and dolls; separation_mean: of the worst joint of each */
    double separation_sum, cpu_ns;
    uint64_t awake_steps; /* steps of a doll that was awake */
    double settled;       /* seconds after which the last one fell asleep */
} drop_scene;

/* Whether the pack's joints have names that make a ragdoll. */
int drop_scene_can(const pack_file *file);

/* Made and thrown. Prints an error and returns an exit code; 0 on success. */
int drop_scene_open(drop_scene *s, const pack_file *file, uint32_t dolls, double seconds, uint32_t substeps,
                    uint32_t seed);
void drop_scene_close(drop_scene *s);

void drop_scene_step(drop_scene *s);
uint32_t drop_scene_asleep(const drop_scene *s);

/* FNV-1a of all positions and rotations. */
uint32_t drop_scene_hash(const drop_scene *s);

#endif
