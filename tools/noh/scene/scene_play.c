/* scene_play.c: a scene posed by clips: banks, controllers, and the items that get their poses. */
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "scene.h"

/* ---- opening ---- */

int scene_open_anim(scene *s, const pack_file *file, const char *path)
{
    int status = path ? pack_file_open(&s->anim_file, path) : 0;
    if (!path || status) {
        s->anim_file.path = NULL; /* nothing to close */
        return status;
    }
    s->anim = &s->anim_file;
    return s->anim->pack.clip_count ? 0 : tool_fail(path, "the pack has no clips for %s", file->path);
}

static noh_clip_bank_desc set_desc(const scene *s, const pack_file *file, uint32_t player, uint32_t controllers)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clips = &s->anim->pack;
    desc.mesh = &file->pack;
    desc.skeleton = player;
    desc.instance_count = controllers;
    return desc;
}

static noh_controller_desc controller_desc(const noh_clip_set *set)
{
    noh_controller_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.set = set;
    desc.flags = NOH_CONTROLLER_INERTIAL;
    return desc;
}

/* Bytes of one pose and its matrices, beside the scratch. */
static uint64_t pose_bytes(const noh_clip_set *set)
{
    return (uint64_t)set->joint_count * (sizeof(noh_transform) + 12 * sizeof(float)) +
           (uint64_t)set->float_count * sizeof(float);
}

/* A player whose skeleton no clip fits (NOT_FOUND) is an error only if the clips fit no other player either. */
static int failed_for_good(const scene *s, const pack_file *file, uint32_t fitting, const noh_error *error)
{
    if (error->result != NOH_OK && error->result != NOH_ERR_NOT_FOUND) {
        return tool_fail_error(s->anim->path, error);
    }
    return fitting == 0 && s->anim->pack.clip_count ? tool_fail(s->anim->path, "for %s: %s", file->path, error->what)
                                                    : 0;
}

static int open_controllers(scene_player *p, uint32_t count)
{
    const noh_controller_desc desc = controller_desc(&p->bank->clips);
    const size_t bytes = noh_controller_size(&desc);
    p->controllers = calloc(count, sizeof *p->controllers);
    for (uint32_t i = 0; p->controllers && i < count; i++) {
        void *memory = malloc(bytes);
        if (!memory || noh_controller_init(memory, bytes, &desc, &p->controllers[i], NULL)) {
            free(memory);
            return 1;
        }
        p->controller_count++;
        p->controller_bytes += bytes;
    }
    return !p->controllers;
}

static int open_poses(scene_player *p)
{
    const noh_clip_set *set = &p->bank->clips;
    const size_t bytes = noh_pose_scratch_size(set, 1);
    p->scratch_memory = malloc(bytes + 1);
    p->pose = calloc(set->joint_count + 1u, sizeof *p->pose);
    p->floats = calloc(set->float_count + 1u, sizeof *p->floats);
    p->pose_bytes = bytes + pose_bytes(set);
    return !p->scratch_memory || !p->pose || !p->floats ||
           noh_pose_scratch_init(p->scratch_memory, bytes, set, 1, &p->scratch, NULL);
}

/* Also 0 if no clip fits: the player then has no bank, and *error says why. */
static int open_player(scene *s, const pack_file *file, uint32_t index, uint32_t controllers, noh_error *error)
{
    const noh_clip_bank_desc desc = set_desc(s, file, index, controllers);
    scene_player *p = &s->players[index];
    const size_t bytes = noh_clip_bank_size(&desc, error);
    if (!bytes) {
        return error->result == NOH_ERR_NOT_FOUND ? 0 : tool_fail_error(s->anim->path, error);
    }
    p->set_memory = malloc(bytes);
    p->set_bytes = bytes;
    if (!p->set_memory) {
        return tool_fail(s->anim->path, "out of memory");
    }
    if (noh_clip_bank_init(p->set_memory, bytes, &desc, &p->bank, error)) {
        p->bank = NULL;
        return tool_fail_error(s->anim->path, error);
    }
    return open_controllers(p, controllers) || open_poses(p) ? tool_fail(s->anim->path, "out of memory") : 0;
}

void scene_close_player(scene_player *p)
{
    for (uint32_t i = 0; i < p->controller_count; i++) {
        free(p->controllers[i]);
    }
    free(p->controllers);
    free(p->set_memory);
    free(p->scratch_memory);
    free(p->pose);
    free(p->floats);
    p->controllers = NULL;
    p->set_memory = p->scratch_memory = NULL;
    p->pose = NULL;
    p->floats = NULL;
    p->bank = NULL;
    p->controller_count = 0;
    p->set_bytes = p->controller_bytes = p->pose_bytes = 0;
}

static int is_open(const scene *s)
{
    for (uint32_t i = 0; i < s->player_count; i++) {
        if (s->players[i].bank) {
            return 1;
        }
    }
    return 0;
}

int scene_open_players(scene *s, const pack_file *file, uint32_t controllers)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = 0;
    if (is_open(s) || s->anim->pack.clip_count == 0) {
        return 0;
    }
    for (uint32_t i = 0; i < s->player_count && !status; i++) {
        status = open_player(s, file, i, controllers, &error);
    }
    return status ? status : failed_for_good(s, file, (uint32_t)is_open(s), &error);
}

/* ---- posing ---- */

static int fail_clip(const scene *s, const pack_file *file, const char *name)
{
    const uint32_t count = s->anim->pack.clip_count;
    const char **names = calloc(count + 1u, sizeof *names);
    int status = 0;
    for (uint32_t i = 0; names && i < count && !status; i++) {
        noh_pack_clip clip;
        noh_pack_clip_at(&s->anim->pack, i, &clip, NULL);
        names[i] = clip.name;
        if (strcmp(clip.name, name) == 0) {
            status = tool_fail(s->anim->path,
                               "clip '%s' moves another skeleton than that of %s: names or parents of joints differ",
                               name, file->path);
        }
    }
    if (!status) {
        status = names ? scene_fail_unknown(s->anim, "clip", name, names, count)
                       : tool_fail(file->path, "out of memory");
    }
    free(names);
    return status;
}

static int has_clip(const scene_player *p, const char *name, uint32_t *clip)
{
    *clip = p->bank ? noh_clip_bank_find(p->bank, name) : 0;
    return p->bank && *clip < p->bank->clips.clip_count;
}

/* Animated weights, to every item of their nodes. */
static void take_weights(scene *s, const scene_player *p)
{
    for (uint32_t i = 0; i < s->item_count; i++) {
        const uint32_t group = noh_clip_bank_node_group(p->bank, s->items[i].node);
        if (group != NOH_NONE && noh_clip_bank_controller_moves(p->bank, p->controllers[0], group)) {
            memcpy(s->items[i].weights, p->floats + p->bank->groups[group].first,
                   p->bank->groups[group].width * sizeof(float));
        }
    }
}

int scene_reset_player(scene_player *p)
{
    const noh_controller_desc desc = controller_desc(&p->bank->clips);
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_controller *c = p->controllers[0];
    return noh_controller_init(c, noh_controller_bytes(c), &desc, &p->controllers[0], &error)
               ? tool_fail_error("controller", &error)
               : 0;
}

void scene_pose_player(scene *s, scene_player *p)
{
    noh_controller_pose(p->controllers[0], &p->bank->clips, &p->scratch, p->pose, p->floats);
    take_weights(s, p);
    if (p->skeleton.joint_count) {
        noh_local_to_model(&p->skeleton, p->pose, p->skeleton.joint_count, p->joint_matrices);
    }
}

/* On the first free track. */
static int start_clip(scene *s, scene_player *p, uint32_t clip, double time_s)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const double limit_s = 1e8; /* a track's position cannot be larger */
    noh_controller *c = p->controllers[0];
    noh_track_desc desc;
    uint32_t track = 0;
    while (track + 1 < c->track_count && noh_controller_track(c, track)->mode != NOH_TRACK_OFF) {
        track++;
    }
    memset(&desc, 0, sizeof desc);
    desc.clip = clip;
    desc.position_ticks = noh_ticks_from_seconds(time_s > limit_s ? limit_s : time_s < -limit_s ? -limit_s : time_s);
    return noh_controller_start(c, &p->bank->clips, track, &desc, &error) ? tool_fail_error(s->anim->path, &error) : 0;
}

static int start_named(scene *s, const pack_file *file, const char *name, double time_s)
{
    int status = 0, found = 0;
    for (uint32_t i = 0; i < s->player_count && !status; i++) {
        uint32_t clip;
        if (has_clip(&s->players[i], name, &clip)) {
            status = start_clip(s, &s->players[i], clip, time_s);
            found = 1;
        }
    }
    return status || found ? status : fail_clip(s, file, name);
}

int scene_set_clips(scene *s, const pack_file *file, const option_list *names, double time_s)
{
    int status = scene_open_players(s, file, 1);
    for (uint32_t i = 0; i < s->player_count && !status; i++) {
        status = s->players[i].bank ? scene_reset_player(&s->players[i]) : 0;
    }
    for (int i = 0; i < names->count && !status; i++) {
        status = start_named(s, file, names->items[i], time_s);
    }
    for (uint32_t i = 0; i < s->player_count && !status; i++) {
        if (s->players[i].bank) scene_pose_player(s, &s->players[i]);
    }
    return status;
}
