#include "cast.h"

#include <string.h>
#include "noh/low_life.h"

static const noh_layer_desc layers[WEB_LAYERS] = {
    { .name = "body", .mode = NOH_LAYER_BASE },
    { .name = "face", .mode = NOH_LAYER_OVER, .joints = "" },
};

/* Whether a skeleton moves the mesh of a node, or in a pack without nodes, a mesh. */
static int moves(const noh_pack *pack, uint32_t skeleton, uint32_t node)
{
    noh_mesh mesh;
    noh_skin skin;
    return noh_pack_mesh_at(pack, pack->node_count ? pack->nodes[node].mesh : node, &mesh, NULL) == NOH_OK &&
           noh_pack_skin_at(pack, mesh.header->skin, &skin, NULL) == NOH_OK && skin.header->skeleton == skeleton;
}

/* The nodes whose meshes a skeleton moves, at most NOH_STAGE_MESHES_MAX. */
static uint32_t list_nodes(const noh_pack *pack, uint32_t skeleton, uint32_t *nodes)
{
    const uint32_t all = pack->node_count ? pack->node_count : pack->runs[NOH_CHUNK_MESH].count;
    uint32_t count = 0;
    for (uint32_t i = 0; i < all && count < NOH_STAGE_MESHES_MAX; i++) {
        if (moves(pack, skeleton, i)) nodes[count++] = i;
    }
    return count;
}

static noh_kind_desc kind_of(const noh_pack *pack, uint32_t skeleton, const web_wants *wants)
{
    noh_kind_desc k;
    memset(&k, 0, sizeof k);
    k.mesh = pack;
    k.skeleton = skeleton;
    k.actor_count = wants->actors;
    if (wants->alive) web_cast_add_springs(&k);
    k.layers = layers;
    k.layer_count = WEB_LAYERS;
    k.root_axes = NOH_ROOT_GROUND;
    k.inertia = 1;
    return k;
}

/* The first kind also has the meshes that no joint moves. */
static noh_result list_kinds(web_cast *cast, const noh_pack *pack, noh_error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_SKELETON].count; i++) {
        uint32_t *nodes = cast->nodes + NOH_STAGE_MESHES_MAX * (size_t)(count % NOH_STAGE_KINDS_MAX);
        const uint32_t node_count = list_nodes(pack, i, nodes);
        if (!node_count) continue;
        if (count == NOH_STAGE_KINDS_MAX) {
            return noh_fail(error, NOH_ERR_LIMIT, "the pack has more skeletons than a stage can have kinds", i, count);
        }
        cast->kinds[count] = kind_of(pack, i, &cast->wants);
        cast->kinds[count].nodes = count ? nodes : NULL;
        cast->kinds[count].node_count = count ? node_count : 0;
        count++;
    }
    if (!count) cast->kinds[count++] = kind_of(pack, NOH_NONE, &cast->wants);
    cast->desc.kinds = cast->kinds;
    cast->desc.kind_count = count;
    return NOH_OK;
}

static uint32_t most_skin_joints(const noh_pack *pack)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_SKIN].count; i++) {
        noh_skin skin;
        (void)noh_pack_skin_at(pack, i, &skin, NULL);
        most = skin.header->joint_count > most ? skin.header->joint_count : most;
    }
    return most;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

size_t web_cast_scratch(const noh_pack *pack)
{
    static web_cast cast;
    size_t most = 0;
    cast.wants.actors = 1;
    if (list_kinds(&cast, pack, NULL)) return 0;
    for (uint32_t k = 0; k < cast.desc.kind_count; k++) most = larger(most, noh_kind_find_eyes_size(&cast.kinds[k]));
    return most;
}

static void find_faces(web_cast *cast, void *scratch, size_t scratch_bytes)
{
    for (uint32_t k = 0; k < cast->desc.kind_count; k++) {
        if (noh_kind_find_eyes(&cast->kinds[k], scratch, scratch_bytes, cast->faces[k].face.eyes, NULL)) continue;
        cast->faces_found |= 1u << k;
        cast->kinds[k].face = noh_face_module(&cast->faces[k]);
    }
}

/* After the stage, each aligned to 16. */
static void place_rest(web_cast *cast, const noh_pack *pack)
{
    const size_t to_bake = noh_reflection_scratch_size(cast->reflection.side);
    size_t at = (size_t)cast->plan.cpu_bytes;
    cast->matrices_at = at = (at + 15u) / 16u * 16u;
    at += sizeof(float) * 12u * most_skin_joints(pack);
    cast->texels_at = at = (at + 15u) / 16u * 16u;
    at += noh_reflection_size(cast->reflection.side);
    cast->hair_at = at = (at + 15u) / 16u * 16u;
    if (cast->has_hair) at += cast->heads_bytes + noh_stage_hair_size(&cast->hair);
    cast->scratch_at = (at + 15u) / 16u * 16u;
    cast->scratch_bytes = larger(to_bake, web_cast_scratch(pack));
    cast->bytes = cast->scratch_at + cast->scratch_bytes + (size_t)cast->plan.state_bytes;
}

/* Sum the bytes of the stage and of the hair of all actors. */
static void add_up(web_cast *cast)
{
    cast->cpu_bytes = cast->plan.cpu_bytes;
    cast->gpu_bytes = cast->plan.gpu_bytes;
    if (!cast->has_hair) return;
    cast->cpu_bytes += noh_actor_hair_size(&cast->hair) + noh_stage_hair_size(&cast->hair);
    cast->gpu_bytes += noh_stage_hair_bytes(&cast->hair);
}

static void describe(web_cast *cast)
{
    cast->reflection.side = 64;
    cast->light.reflection = &cast->reflection;
    cast->light.shadow_px = WEB_SHADOW_PX;
    cast->desc.light = cast->wants.lit ? &cast->light : NULL;
    cast->desc.gpu = &noh_stage_on_gl;
    cast->desc.encode_srgb = 1; /* a canvas does not encode */
    cast->desc.without_depth = !cast->wants.lit;
    cast->desc.without_shader = cast->wants.elsewhere;
    cast->desc.shading = cast->wants.shading;
    cast->desc.without_transfer = cast->wants.without_transfer;
    cast->desc.morph_path = (uint32_t)cast->wants.path;
}

noh_result web_cast_plan(web_cast *cast, const noh_pack *pack, const web_wants *wants, void *scratch,
                         size_t scratch_bytes, const noh_gl_caps *caps, noh_error *error)
{
    noh_result result;
    memset(cast, 0, sizeof *cast);
    cast->wants = *wants;
    result = list_kinds(cast, pack, error);
    describe(cast);
    if (!result) web_cast_add_stand(cast, pack);
    if (!result) result = web_cast_add_hair(cast, pack, error);
    if (!result) web_cast_add_fall(cast);
    if (!result && wants->alive) find_faces(cast, scratch, scratch_bytes);
    if (!result) result = noh_stage_plan_make(&cast->desc, caps, &cast->plan, error);
    for (uint32_t i = 0; i < cast->desc.kind_count && !result; i++) { /* the plan has counted the floats */
        const uint32_t floats = cast->plan.kinds[i].float_count;
        cast->kinds[i].held_float_count = floats ? floats : NOH_NONE;
    }
    if (!result) result = noh_stage_plan_make(&cast->desc, caps, &cast->plan, error);
    if (!result) {
        place_rest(cast, pack);
        add_up(cast);
    }
    return result;
}
