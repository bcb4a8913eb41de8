#include "play.h"

#include <string.h>

#define BLOCK 16u /* what objects are aligned to */
#define AHEAD_TICKS (NOH_TICKS_PER_SECOND / 4u)
#define AHEAD_TRACK_FRAMES 4096u /* decoded in a frame, ahead of need */

static noh_result fail_memory(const noh_arena *arena, noh_error *error)
{
    return noh_fail(error, NOH_ERR_MEMORY, "less memory than the pack needs: build the page for this pack", 0,
                    arena->used);
}

/* ---- opening ---- */

static noh_clip_bank_desc set_desc(const web_playback *play, uint32_t player)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clips = &play->scene->pack;
    desc.skeleton = player;
    return desc;
}

static noh_controller_desc controller_desc(const web_player *p)
{
    noh_controller_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.set = &p->set->clips;
    desc.flags = NOH_CONTROLLER_INERTIAL;
    return desc;
}

/* A skeleton without a clip is no error: it stands in its bind pose. */
static noh_result open_clips(const web_playback *play, uint32_t player, noh_arena *arena, noh_clip_bank **set,
                             noh_error *error)
{
    const noh_clip_bank_desc desc = set_desc(play, player);
    const size_t bytes = play->scene->pack.clip_count ? noh_clip_bank_size(&desc, error) : 0;
    void *memory;
    if (!bytes) {
        return play->scene->pack.clip_count && error->result != NOH_ERR_NOT_FOUND ? error->result : NOH_OK;
    }
    memory = noh_arena_carve(arena, bytes, BLOCK);
    return memory ? noh_clip_bank_init(memory, bytes, &desc, set, error) : fail_memory(arena, error);
}

noh_result web_playback_open_clips(web_playback *play, web_scene *scene, noh_arena *arena, noh_error *error)
{
    const noh_pack *pack = &scene->pack;
    noh_result result = NOH_OK;
    memset(play, 0, sizeof *play);
    play->scene = scene;
    play->clip = NOH_NONE;
    play->speed = 1.0f;
    play->player_count = pack->skeleton_count ? pack->skeleton_count : 1u;
    if (play->player_count > WEB_PLAYERS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "more skeletons than the page has room for", 0, play->player_count);
    }
    for (uint32_t i = 0; i < play->player_count && !result; i++) {
        (void)noh_pack_skeleton_at(pack, i, &play->players[i].skeleton, NULL, NULL);
        result = open_clips(play, i, arena, &play->players[i].set, error);
    }
    return result;
}

noh_result web_playback_open_controllers(web_playback *play, noh_arena *arena, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < play->player_count && !result; i++) {
        web_player *p = &play->players[i];
        if (p->set) {
            const noh_controller_desc desc = controller_desc(p);
            const size_t bytes = noh_controller_size(&desc);
            void *memory = noh_arena_carve(arena, bytes, BLOCK);
            result = memory ? noh_controller_init(memory, bytes, &desc, &p->controller, error)
                            : fail_memory(arena, error);
        }
    }
    return result;
}

static noh_result open_pose(web_player *p, noh_arena *arena, noh_error *error)
{
    const noh_clip_set *set = &p->set->clips;
    const size_t bytes = noh_pose_scratch_size(set, 1);
    void *scratch = noh_arena_carve(arena, bytes, BLOCK);
    p->pose = noh_arena_carve(arena, sizeof *p->pose * set->joint_count, BLOCK);
    p->model = noh_arena_carve(arena, sizeof(float) * 12u * set->joint_count, BLOCK);
    p->floats = noh_arena_carve(arena, sizeof *p->floats * set->float_count, BLOCK);
    if (arena->used > arena->bytes) return fail_memory(arena, error);
    return noh_pose_scratch_init(scratch, bytes, set, 1, &p->scratch, error);
}

static noh_result open_still(web_playback *play, web_player *p, noh_error *error)
{
    if (p->skeleton.joint_count > WEB_STILL_JOINTS_MAX - play->still_count) {
        return noh_fail(error, NOH_ERR_LIMIT, "more joints that no clip moves than the page has room for", 0,
                        p->skeleton.joint_count);
    }
    p->model = play->still[play->still_count];
    play->still_count += p->skeleton.joint_count;
    return NOH_OK;
}

noh_result web_playback_open_poses(web_playback *play, noh_arena *arena, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < play->player_count && !result; i++) {
        web_player *p = &play->players[i];
        result = p->set ? open_pose(p, arena, error) : p->skeleton.joint_count ? open_still(play, p, error) : NOH_OK;
        if (!result && p->skeleton.joint_count) {
            noh_local_to_model(&p->skeleton, p->skeleton.bind_pose, p->skeleton.joint_count, p->model);
        }
    }
    return result;
}

noh_result web_playback_open_matrices(web_playback *play, noh_arena *arena, noh_error *error)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < play->scene->item_count; i++) {
        noh_skin skin;
        if (noh_pack_skin_at(&play->scene->pack, play->scene->meshes[play->scene->items[i].mesh].header->skin, &skin,
                             NULL) == NOH_OK) {
            most = skin.header->joint_count > most ? skin.header->joint_count : most;
        }
    }
    if (!most) return NOH_OK;
    play->matrices = noh_arena_carve(arena, sizeof(float) * 12u * most, BLOCK);
    return play->matrices ? NOH_OK : fail_memory(arena, error);
}

/* ---- playing ---- */

/* Whether the pack's clip of that index moves the player, and its index in the player's own set. */
static int find_clip(const web_player *p, uint32_t pack_clip, uint32_t *clip)
{
    *clip = 0;
    if (!p->set) return 0;
    while (*clip < p->set->clips.clip_count && p->set->pack_clips[*clip] != pack_clip) ++*clip;
    return *clip < p->set->clips.clip_count;
}

double web_playback_seconds(const web_playback *play, uint32_t pack_clip)
{
    uint32_t clip;
    for (uint32_t i = 0; i < play->player_count; i++) {
        if (find_clip(&play->players[i], pack_clip, &clip)) {
            return (double)play->players[i].set->clips.clips[clip].duration_ticks / (double)NOH_TICKS_PER_SECOND;
        }
    }
    return -1.0;
}

/* Reset the weights of every item that the player moves to the pack's; with to_pose, set them to the player's pose. */
static void move_weights(const web_playback *play, const web_player *p, int to_pose)
{
    for (uint32_t i = 0; p->set && i < play->scene->item_count; i++) {
        const web_item *item = &play->scene->items[i];
        const uint32_t g = noh_clip_bank_node_group(p->set, item->node);
        if (g == NOH_NONE || !noh_clip_bank_controller_moves(p->set, p->controller, g)) continue;
        web_scene_reset(play->scene, item);
        if (to_pose)
            memcpy(play->scene->weights + item->first_weight, p->floats + p->set->groups[g].first,
                   p->set->groups[g].width * sizeof(float));
    }
}

static void pose(web_playback *play)
{
    for (uint32_t i = 0; i < play->player_count; i++) {
        web_player *p = &play->players[i];
        if (!p->set) continue;
        noh_controller_pose(p->controller, &p->set->clips, &p->scratch, p->pose, p->floats);
        move_weights(play, p, 1);
        if (p->skeleton.joint_count) noh_local_to_model(&p->skeleton, p->pose, p->skeleton.joint_count, p->model);
    }
}

static noh_result start(const web_playback *play, web_player *p, uint32_t clip, double time_s, noh_error *error)
{
    noh_track_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clip = clip;
    desc.position_ticks = noh_ticks_from_seconds(time_s);
    desc.speed = (int32_t)(play->speed * (float)NOH_SPEED_ONE);
    desc.flags = desc.speed ? 0 : NOH_TRACK_PAUSED;
    desc.loop = NOH_LOOP_REPEAT;
    return noh_controller_start(p->controller, &p->set->clips, 0, &desc, error);
}

/* Make the player's controller anew, and start the clip on it if it is one of the player's. */
static noh_result restart(const web_playback *play, web_player *p, double time_s, noh_error *error)
{
    const noh_controller_desc desc = controller_desc(p);
    uint32_t clip;
    noh_result result = noh_controller_init(p->controller, noh_controller_bytes(p->controller), &desc, &p->controller,
                                            error);
    return !result && find_clip(p, play->clip, &clip) ? start(play, p, clip, time_s, error) : result;
}

/* Cross over to the clip, or to the bind pose if it is not one of the player's. The pose before the change is captured,
 * and its difference to the new one decays over the transition (inertialisation: anim/controller_pose.h). */
static noh_result go_over(const web_playback *play, web_player *p, double time_s, double transition_s, noh_error *error)
{
    const noh_clip_set *set = &p->set->clips;
    uint32_t clip;
    noh_result result = noh_controller_inertia_capture(p->controller, set, &p->scratch, error);
    if (!result) {
        result = find_clip(p, play->clip, &clip) ? start(play, p, clip, time_s, error)
                                                 : noh_controller_set_mode(p->controller, 0, NOH_TRACK_OFF);
    }
    if (!result) {
        result = noh_controller_inertia_begin(p->controller, set, &p->scratch,
                                              (uint32_t)noh_ticks_from_seconds(transition_s), error);
    }
    return result;
}

noh_result web_playback_start(web_playback *play, uint32_t clip, double time_s, double transition_s, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < play->player_count; i++) move_weights(play, &play->players[i], 0);
    play->clip = clip;
    for (uint32_t i = 0; i < play->player_count && !result; i++) {
        web_player *p = &play->players[i];
        if (!p->set) continue;
        result = transition_s > 0.0 ? go_over(play, p, time_s, transition_s, error) : restart(play, p, time_s, error);
    }
    if (!result) pose(play);
    return result;
}

void web_playback_set_speed(web_playback *play, float speed)
{
    play->speed = speed;
    for (uint32_t i = 0; i < play->player_count; i++) {
        if (play->players[i].set)
            (void)noh_controller_set_speed(play->players[i].controller, 0, (int32_t)(speed * (float)NOH_SPEED_ONE));
    }
}

void web_playback_step(web_playback *play, double seconds)
{
    for (uint32_t i = 0; i < play->player_count; i++) {
        web_player *p = &play->players[i];
        if (!p->set) continue;
        noh_clip_cache_begin_frame(p->set->cache);
        noh_controller_step(p->controller, &p->set->clips, (uint32_t)noh_ticks_from_seconds(seconds), NULL, NULL);
        noh_clip_bank_prefetch(p->set, p->controller, AHEAD_TICKS);
        noh_clip_cache_work(p->set->cache, AHEAD_TRACK_FRAMES);
    }
    pose(play);
}

double web_playback_time(const web_playback *play)
{
    uint32_t clip;
    for (uint32_t i = 0; i < play->player_count; i++) {
        const web_player *p = &play->players[i];
        if (find_clip(p, play->clip, &clip)) {
            uint32_t tick = noh_track_clip_tick(noh_controller_track(p->controller, 0), &p->set->clips.clips[clip], 0);
            return (double)tick / (double)NOH_TICKS_PER_SECOND;
        }
    }
    return 0.0;
}

/* ---- results ---- */

int web_playback_matrices(web_playback *play, const web_item *item)
{
    noh_skin skin;
    if (noh_pack_skin_at(&play->scene->pack, play->scene->meshes[item->mesh].header->skin, &skin, NULL)) return 0;
    noh_skin_matrices(&skin, play->players[skin.header->skeleton].model, play->matrices);
    return 1;
}

static void grow(float box[6], const float world[12], const float p[3])
{
    for (int c = 0; c < 3; c++) {
        float x = world[4 * c] * p[0] + world[4 * c + 1] * p[1] + world[4 * c + 2] * p[2] + world[4 * c + 3];
        box[c] = x < box[c] ? x : box[c];
        box[3 + c] = x > box[3 + c] ? x : box[3 + c];
    }
}

void web_playback_bounds(web_playback *play, float box[6])
{
    noh_box_empty(box);
    for (uint32_t i = 0; i < play->scene->item_count; i++) {
        const web_item *item = &play->scene->items[i];
        const noh_mesh mesh = noh_mesh_at_lod(&play->scene->meshes[item->mesh], NOH_LOD_LEVELS_MAX); /* as the tool */
        const float *world = web_scene_world(play->scene, item);
        int is_skinned = web_playback_matrices(play, item);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            float skinned[3];
            if (is_skinned) noh_skin_position(&mesh, play->matrices, NULL, v, skinned);
            grow(box, world, is_skinned ? skinned : mesh.positions + 3 * (size_t)v);
        }
    }
}
