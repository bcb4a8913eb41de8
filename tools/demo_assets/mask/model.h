/* The mask as data: seeds (where a vertex grows from), triangles, and poses. */
#ifndef MASK_MODEL_H
#define MASK_MODEL_H

#include "shared/maths.h"
#include "pose.h"

#include <stdint.h>

/* One part becomes one glTF primitive with its own material. */
enum { PART_PAINT, PART_WOOD, PART_EYES, PART_TEETH, PART_MOUTH, PART_COUNT, PARTS_MAX = 6 };

/* What a vertex is part of: chooses the function that places it in a pose. */
typedef enum {
    ON_SKIN,
    ON_LIP_FOLD,
    ON_LID_FOLD,
    ON_EAR,
    ON_STROKE,
    ON_RIM,
    ON_BACK,
    ON_BALL,
    ON_TEETH,
    ON_TONGUE,
    ON_BAG,
    REGION_COUNT /* nell/ has more */
} Region;

/* What a vertex grows from. A pose turns a seed into a position, and every pose uses the same seeds, so all targets
 * have the same vertices. */
typedef struct {
    int region;  /* a Region, or one of nell/ */
    double s, t; /* place in the closed face plane, or the region's own grid */
    double k;    /* depth along a fold, a ring number, ... */
    int eye;     /* above (+1) or below (-1) the eye slits; for a ball: its side */
    int mouth;   /* above (+1) or below (-1) the mouth slit; for teeth: the row */
    double u, v; /* texture coordinates */
} Seed;

typedef struct {
    V3 (*place)(const Seed *seed, const Pose *pose); /* where a seed's vertex lies in a pose */
    int seed_count, seed_space;
    Seed *seeds;
    int index_count, index_space;
    uint32_t *indices;
    V3 *colours; /* linear; baked from the neutral pose */
} Part;

typedef struct {
    int part_count;
    Part parts[PARTS_MAX];
} Model;

/* An empty model, whose vertices `place` puts. */
Model model_begin(int part_count, V3 (*place)(const Seed *seed, const Pose *pose));
void model_free(Model *model);
uint32_t model_seed(Model *model, int part, const Seed *seed);
void model_triangle(Model *model, int part, uint32_t a, uint32_t b, uint32_t c);
void model_quad(Model *model, int part, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

#endif
