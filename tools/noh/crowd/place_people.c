#include "place_people.h"

#include <string.h>

#include "cli/message.h"
#include "noh/low_life.h"

#define REACH_M 2.5f
#define CELL_M 0.4f

static const noh_layer_desc layers[PLACE_LAYERS] = { { "body", NOH_LAYER_BASE, NULL, NULL, 3 },
                                                     { "act", NOH_LAYER_OVER, NULL, NULL, 2 } };

/* ---- as a kind ---- */

static void lay_ground(place_people *p, const place_file *place)
{
    p->floor.normal[1] = 1.0f;
    p->world.planes = &p->floor;
    p->world.plane_count = place->ground ? 0u : 1u;
    p->world.field = place->ground;
    p->world.boxes = p->boxes;
    p->world.friction = 0.6f;
    for (uint32_t i = 0; i < place->step_count; i++) {
        const place_step *step = &place->steps[i];
        noh_obb *b = &p->boxes[p->world.box_count];
        if (!(step->height > 0.0f)) continue;
        for (int k = 0; k < 2; k++) {
            b->centre[2 * k] = 0.5f * (step->area.low[k] + step->area.high[k]);
            b->half[2 * k] = 0.5f * (step->area.high[k] - step->area.low[k]);
        }
        b->centre[1] = b->half[1] = 0.5f * step->height;
        b->rotation[3] = 1.0f;
        p->world.box_count++;
    }
}

static int find_feet(place_people *p, const pack_file *file)
{
    noh_ragdoll_source source;
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(&source, 0, sizeof source);
    source.pack = &file->pack;
    source.metres = 1.0f;
    if (noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, &error) ||
        noh_feet_rig_make(&source, &p->feet.rig, &error)) {
        return tool_fail(file->path, "a place needs a body that walks: %s", error.what);
    }
    p->feet.ground.world = &p->world;
    p->parts[0] = noh_walkers_feet_modifier(&p->feet);
    return 0;
}

static void fill_kind(place_people *p, const pack_file *file, uint32_t agents, uint32_t ragdolls)
{
    noh_kind_desc *k = &p->kind;
    k->mesh = &file->pack;
    k->actor_count = agents;
    k->layers = layers;
    k->layer_count = PLACE_LAYERS;
    k->held_float_count = 2;
    k->root_axes = NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_BY_GAME;
    k->unpickable = 1;
    k->springs = noh_springs_module(NULL);
    k->modifiers = p->parts;
    k->modifier_count = 1;
    p->ragdoll.count = ragdolls;
    p->ragdoll.world = &p->world;
    if (ragdolls) k->ragdoll = noh_ragdoll_module(&p->ragdoll);
    k->inertia = ragdolls != 0;
    p->walkers.walker_max = agents;
    p->walkers.near_max = agents < PLACE_NEAR ? agents : PLACE_NEAR;
    p->walkers.feet_modifier = 1;
    p->walkers.layer = PLACE_BODY;
    p->walkers.walk = "walk";
}

int place_people_make(place_people *p, const pack_file *file, const place_file *place, uint32_t agents,
                      uint32_t ragdolls)
{
    memset(p, 0, sizeof *p);
    lay_ground(p, place);
    fill_kind(p, file, agents ? agents : PLACE_AGENTS, ragdolls);
    return find_feet(p, file);
}

/* ---- as agents ---- */

void place_crowd_desc(const place_file *place, uint32_t agents, noh_crowd_desc *desc)
{
    const uint32_t fields = place->goal_count + place->smart.object_count;
    memset(desc, 0, sizeof *desc);
    desc->agent_max = agents ? agents : PLACE_AGENTS;
    desc->reach = REACH_M;
    for (int i = 0; i < 2; i++) {
        desc->origin[i] = place->area.low[i];
        desc->extent[i] = place->area.high[i] - place->area.low[i];
    }
    desc->obstacles = place->obstacles;
    desc->obstacle_count = place->obstacle_count;
    desc->field_count = fields < NOH_CROWD_FIELDS_MAX ? fields : NOH_CROWD_FIELDS_MAX;
    desc->field_cell = CELL_M;
    desc->ground = place->ground;
    desc->field_radius = place->radius > 0.5f * CELL_M ? place->radius : 0.5f * CELL_M;
}

void place_smart_desc(const place_file *place, uint32_t agents, noh_smart_desc *desc)
{
    *desc = place->smart;
    desc->agent_max = agents ? agents : PLACE_AGENTS;
}
