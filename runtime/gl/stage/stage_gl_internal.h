/* stage_gl_internal.h (private to stage_gl/): a stage's objects on the GPU. */
#ifndef NOH_STAGE_GL_STAGE_GL_INTERNAL_H
#define NOH_STAGE_GL_STAGE_GL_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "stage/actors/stage_draws_internal.h"
#include "stage/cast/stage_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/draw/gl_renderer_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define NOH_MODEL_POOLS_MAX 16u /* most sizes of tiles in one mesh */

/* A mesh of a pack, with its accumulators for all kinds that draw it. */
typedef struct noh_gl_model {
    noh_gl_mesh mesh;
    noh_gl_morph *morph; /* NULL: no targets */
    uint8_t *sides;      /* [tiles of morph / 2] with motion: NOH_SIDE_* of each pair of tiles; else NULL */
    uint32_t part_count; /* meshes of its desc */
    uint32_t load_kind;  /* noh_stage_kind.finer.kind where finer levels come later; else NOH_NONE, and the rest is 0 */
    uint32_t mesh_index; /* in the packs */
    int loaded;          /* 1: they are used */
    int waits;           /* of a slot whose kind is not filled: its sums are not updated */
    int taken;           /* 1: its buffers were filled when they came (stage_gl_share.c) */
    noh_mesh coarse;     /* the finest level that the kind's own pack has */
    noh_mesh room;       /* the finest of the plan: copies of its headers and its submeshes, and nothing else */
    uint64_t mesh_at;    /* how far the upload is */
    uint32_t morph_at;
} noh_gl_model;

/* What one kind draws by one node. */
typedef struct noh_gl_item {
    noh_gl_model *model;
    uint32_t first_pool; /* of the kind's pools, among the meshes of model->morph */
    noh_gl_skin *skin;
} noh_gl_item;

/* Whether an actor has a slot, and the mesh targets: 0: it is drawn without them. */
static inline int noh_gl_has_tile(const noh_gl_item *item, const noh_stage_shown *shown)
{
    return item->model->morph && shown->slot.pool != NOH_NONE;
}

/* 0: all weights are 0, so the mesh is not morphed and its vertices need not look up deltas. */
int noh_gl_any_weight(const float *weights, uint32_t count);
/* Wrinkles of an actor's expression, for crowds. For an actor drawn alone the draw sets them. */
void noh_gl_upload_regions(const noh_stage_mesh *mesh, const noh_gl_item *item, uint32_t place, const float *weights);

/* With motion a slot is a pair of tiles: one has the present sums, the other the sums before the last change. */
#define NOH_SIDE_SECOND 1u  /* the second one has the present sums */
#define NOH_SIDE_CHANGED 2u /* the last frame showed the sums of the other one */

/* The instance of model->morph that an actor's slot is. before: of the last frame */
static inline uint32_t noh_gl_tile_of(const noh_gl_item *item, const noh_stage_shown *shown, int before)
{
    const uint8_t *sides = item->model->sides;
    const uint32_t tiles = sides ? 2u : 1u;
    const uint32_t tile = noh_gl_morph_instance(item->model->morph, item->first_pool + shown->slot.pool,
                                                tiles * shown->slot.slot);
    const unsigned side = sides ? sides[tile / 2u] : 0u;
    return tile + ((side & NOH_SIDE_SECOND) ^ (before && side & NOH_SIDE_CHANGED ? 1u : 0u));
}

static inline uint32_t noh_gl_item_tile(const noh_gl_item *item, const noh_stage_shown *shown)
{
    return noh_gl_tile_of(item, shown, 0);
}

/* The triangles that a set of garments leaves of a kind's meshes (stage_cover.c). */
typedef struct noh_gl_cover {
    uint32_t garments;      /* bit k: a garment of kind k; 0: the buffers are not filled */
    uint32_t frame;         /* number of the last frame in which an actor had it */
    noh_gl_buffer *indices; /* [mesh_count] none where no garment hides anything */
} noh_gl_cover;

/* An actor in the last frame that it was seen in, with motion (stage_motion.c). */
typedef struct noh_gl_last {
    uint32_t frame, place, hidden_meshes;
    noh_lod_slot slot;
    float world[12];
    /* of the frame that is shown: */
    uint32_t known;         /* bit i: what mesh i showed in the frame before is known */
    int same_slot;          /* its tiles are the same */
    float world_before[12]; /* less this frame's origin */
} noh_gl_last;

/* Views of a frame. */
typedef struct noh_gl_views {
    double origin[3]; /* what they are relative to, and all shifts of it */
    uint32_t count;
    float view_projection[NOH_STAGE_VIEWS_MAX][16];
} noh_gl_views;

/* How far the upload of a kind that came into its slot is. */
typedef struct noh_gl_filling {
    uint32_t item, picture; /* the next mesh; then the next texture of all sets */
    uint64_t mesh_at;       /* of the mesh */
    uint32_t at;            /* of its delta tiles, or of the texture */
    int done;
} noh_gl_filling;

/* A texture whose levels come by need (stage_gl_textures.c). */
typedef struct noh_gl_streamed {
    noh_texture texture;
    uint32_t kind, picture; /* of its first owner */
    uint32_t first, tail;   /* the finest level that is there; that is always there */
    uint32_t wanted;        /* the finest that the last frame needed */
    noh_gl_texture next;    /* another object for it, which frames fill; no name: none */
    uint32_t next_first, at;
} noh_gl_streamed;

/* Of a picture of a kind. */
typedef struct noh_gl_stream {
    float texels; /* of level 0 in a metre of the kind's meshes; < 0: none shows it */
    uint16_t own; /* 1 + index of its noh_gl_streamed, 0: it is whole */
} noh_gl_stream;

typedef struct noh_gl_kind {
    noh_gl_last *last;         /* [actor_count] with motion; else NULL */
    noh_gl_cover *covers;      /* [cover_count] */
    noh_gl_item *items;        /* [mesh_count] */
    noh_gl_texture *pictures;  /* [1 + texture_set_count][textures of the pack]: those that others own, too */
    noh_gl_streamed *streamed; /* of the stage */
    noh_gl_stream *streams;    /* of each of `pictures`; NULL: all are whole */
    /* of a slot; the arrays above are NULL while it is empty */
    uint8_t *slot;        /* [room.drawn_bytes] NULL: the kind stays */
    uint32_t first_model; /* [room.mesh_count] of its own */
    noh_gl_filling filling;
} noh_gl_kind;

/* A stage that shares, linked by its ledger. */
typedef struct noh_gl_sharing {
    noh_stage *stage;
    struct noh_gl_sharing *next;
    uint32_t context; /* noh_gl_ledger.contexts when its objects were made */
} noh_gl_sharing;

typedef struct noh_stage_gl {
    noh_gl_device device;
    noh_gl_kind *kinds;
    noh_gl_model *models;
    noh_gl_sharing *sharing; /* NULL: it does not share */
    uint32_t model_count, mesh_count;
    noh_mesh *meshes; /* [mesh_count] full, for renderers: of the models of kinds that stay, then of all kinds that the
                       * slots were planned for */
    noh_gl_streamed *streamed; /* [streamed_count] */
    uint32_t streamed_count;
    noh_gl_renderer_desc renderer_desc; /* without meshes and shaders */
    unsigned programs[2];               /* of the sums of slots; 0: none needs it, or its context was lost */
    uint8_t needs_program[2];
    noh_gl_renderer *renderer;
    void *variants;        /* [variants_bytes] of the renderer, if there is one */
    size_t variants_bytes; /* of any renderer of all meshes */
    noh_gl_light *light;   /* NULL: none */
    const noh_lighting *lighting;
    noh_gl_views *views;        /* [2] with motion: of the frame that is shown, and of the one before; else NULL */
    noh_lighting lighting_less; /* `lighting`, its shadow's matrix less the origin of what is drawn */
} noh_stage_gl;

struct noh_stage_shader {
    noh_gl_renderer renderer;
};

/* A pass of a view that is under way. */
typedef struct noh_gl_drawing {
    const noh_stage *s;
    const noh_stage_gl *gl;
    const noh_stage_kind *k;
    const noh_gl_kind *on_gl;
    noh_gl_renderer *renderer;
    uint32_t view;
    int pass;
    noh_gl_before before; /* with motion */
} noh_gl_drawing;

/* ---- the last frame (stage_motion.c), all of it only with motion ---- */

/* In a job, once an actor's matrices of now are written: its palettes of the last frame. Returns whether a row changed.
 */
int noh_gl_motion_pose(const noh_stage *s, const noh_stage_kind *k, uint32_t index);
/* Before the uploads of a frame; for one mesh of an actor, after its weights were set; after all. */
void noh_gl_motion_begin(const noh_stage *s);
void noh_gl_motion_upload(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t mesh);
void noh_gl_motion_end(const noh_stage *s);
/* Choose the tile of a pair that new weights go to. */
void noh_gl_motion_turn(const noh_gl_item *item, const noh_stage_shown *shown, const float *weights, uint32_t count);
/* World matrix and deltas of an actor's mesh in the last frame; where it is not known, of now. Returns 0 without
 * deltas: *morph is then not written. */
int noh_gl_motion_of(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t mesh, float world[12],
                     noh_gl_morph_binding *morph);
/* The view projection of the last frame's view, for positions of now. */
void noh_gl_motion_view(const noh_stage *s, uint32_t view, float view_projection[16]);

/* A lighting whose shadow's matrix takes positions less `origin`. */
void noh_gl_lighting_less(const noh_lighting *lighting, const float origin[3], noh_lighting *out);

/* The opaque meshes of one actor, drawn by a renderer of all meshes of the stage. End it with noh_gl_draw_end.
 * errors  as noh_stage_decals_draw: nothing has begun */
typedef struct noh_gl_alone {
    noh_gl_drawing drawing;
    uint32_t place, mesh_count;
} noh_gl_alone;
noh_result noh_gl_begin_alone(const noh_stage *stage, noh_gl_renderer *renderer, uint32_t view, noh_actor actor,
                              noh_gl_alone *alone, noh_error *error);
/* The index-th mesh: its number in the pack; the levels that it shows, 1, or 2 while it fades; the mesh at one of the
 * actor's levels, as it is drawn; drawn, with whatever render state was set since. */
uint32_t noh_gl_alone_mesh(const noh_gl_alone *alone, uint32_t index);
uint32_t noh_gl_alone_shares(const noh_gl_alone *alone, uint32_t index, noh_stage_part shares[2]);
noh_mesh noh_gl_alone_level(const noh_gl_alone *alone, uint32_t index, uint32_t level);
void noh_gl_draw_alone(noh_gl_alone *alone, uint32_t index, const noh_stage_part *share);

/* Kinds of one actor are drawn by the programs of single instances. */
static inline int noh_gl_is_crowd(const noh_stage_kind *kind)
{
    return kind->desc->actor_count > 1u;
}

/* ---- who shares what ---- */

/* An item of a kind: numbered over all kinds of a desc. */
typedef struct noh_gl_site {
    uint32_t kind, item;
} noh_gl_site;

/* The next item after *site, over all kinds; 0 at the end. Begin with kind and item UINT32_MAX. */
int noh_gl_next_site(const noh_stage_plan *plan, uint32_t kind_count, noh_gl_site *site);
/* The first site that draws the same mesh of the same pack from the same level on, and may share with this one. */
noh_gl_site noh_gl_owner(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site);

/* ---- levels that come later ---- */

/* Makes the copy for noh_gl_model.room in `memory`: noh_gl_room_size bytes, aligned to 16. */
size_t noh_gl_room_size(const noh_mesh *mesh);
noh_mesh noh_gl_room_make(const noh_mesh *mesh, const noh_mesh *coarse, void *memory);
/* Make the mesh of a model: of a slot empty, else with what the kind's own pack has; with buffers of others where it
 * shares.
 * mesh  where nothing comes later */
noh_result noh_gl_model_make_mesh(const noh_stage_gl *gl, noh_gl_model *model, const noh_mesh *mesh, int slot,
                                  noh_error *error);
/* Its mesh is what its accumulators' finished vertices are drawn by. */
noh_result noh_gl_model_set_mesh(const noh_gl_model *model, noh_error *error);
/* ---- slots (stage_gl_slot.c) ---- */

/* The kinds that a slot of a desc was planned for, one after another; 0 past the last. */
typedef struct noh_gl_candidate {
    const noh_pack *pack;
    uint32_t actor_count, mesh_count;
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
} noh_gl_candidate;
int noh_gl_candidate_at(const noh_stage_desc *desc, uint32_t kind, uint32_t index, noh_gl_candidate *out);
noh_mesh noh_gl_candidate_mesh(const noh_stage_desc *desc, const noh_gl_candidate *of, uint32_t index);
/* How many meshes they have in all; into meshes[], where it is not NULL. */
uint32_t noh_gl_candidate_meshes(const noh_stage_desc *desc, noh_mesh *meshes);
/* What the renderer must be able to do for them. */
void noh_gl_candidates_want(const noh_stage_desc *desc, noh_gl_renderer_desc *want);
void noh_gl_candidates_list(const noh_stage_desc *desc, const noh_gl_renderer_desc *want, noh_gl_variant_list *list);
noh_result noh_gl_slots_compile(const noh_stage_desc *asked, noh_stage_gl *gl, uint32_t path, noh_error *error);
void noh_gl_slots_forget_programs(noh_stage_gl *gl, const noh_gl_device *device);
/* Compile the programs of a lost context again. */
noh_result noh_gl_slots_recompile(noh_stage_gl *gl, const noh_stage_desc *desc, uint32_t path, noh_error *error);
/* Make what draws it. slot_come, after init, refuses a kind whose programs are missing. */
noh_result noh_gl_slot_open(noh_stage *s, uint32_t kind, noh_error *error);
noh_result noh_gl_slot_come(noh_stage *s, uint32_t kind, noh_error *error);
/* Fill it at once. */
noh_result noh_gl_slot_fill_all(noh_stage *s, uint32_t kind, noh_error *error);
int noh_gl_slot_fill(noh_stage *s, uint32_t kind, uint32_t *bytes);
/* At the begin of a frame: kinds that are filled are drawn from now on. */
void noh_gl_slots_show(noh_stage *s);
void noh_gl_slot_close(noh_stage *s, uint32_t kind);
/* What a kind takes, made where `gl` is not NULL (stage_gl.c).
 * memory  [bytes] NULL: only measured */
noh_result noh_gl_visit_slot(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_caps *caps,
                             noh_stage_gl *gl, uint32_t kind, void *memory, noh_kind_room *room, uint32_t *morph_path,
                             noh_error *error);

/* errors  ARG the stage has no `gpu` (stage_gl_draw.c) */
noh_result noh_gl_stage_check(const noh_stage *stage, noh_error *error);

/* ---- what stages share (stage_gl_share.c) ---- */

static inline int noh_gl_shares(const noh_stage_gl *gl)
{
    return !NOH_PAGE && gl->sharing;
}

/* All but the last only where a stage shares. In and out; errors  ARG it has objects of the ledger's context */
void noh_gl_share_join(noh_stage *stage);
void noh_gl_share_leave(const noh_stage *stage);
noh_result noh_gl_share_check_restore(const noh_stage_gl *gl, noh_error *error);
/* What other models and pictures have, filled; NULL: nothing. */
const noh_gl_mesh *noh_gl_shared_mesh(const noh_stage_gl *gl, const noh_mesh *mesh);
const noh_gl_texture *noh_gl_shared_tiles(const noh_stage_gl *gl, const noh_gl_tiles_key *key);
/* Before the objects of a model are deleted: it forgets those that others have, too. */
void noh_gl_share_let_go(const noh_stage_gl *gl, noh_gl_model *model);
/* What the peers of a desc have of a site's model. */
#define NOH_PEER_MESH 1u
#define NOH_PEER_TILES 2u
unsigned noh_gl_peers_have(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_caps *caps,
                           noh_gl_site site, int direct);

/* Make the mesh and accumulators of a model again in a new context, with the levels that it had. */
noh_result noh_gl_model_restore(const noh_stage *stage, noh_gl_model *model, int slot, noh_error *error);
int noh_gl_load(noh_stage *stage, uint32_t load_kind, int anew, uint32_t *bytes);
void noh_gl_use(noh_stage *stage, uint32_t load_kind, int loaded);

/* ---- covers ---- */

/* The bytes of the covers of a kind. */
uint64_t noh_gl_covers_bytes(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind);
/* Make the buffers of all kinds that have none, also in a new context; delete them: NOH_NONE: of all kinds. */
noh_result noh_gl_covers_create(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_device *device,
                                noh_gl_kind *kinds, noh_error *error);
void noh_gl_covers_delete(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_device *device,
                          noh_gl_kind *kinds, uint32_t kind);
/* Once a frame: give each seen actor the cover of its garments. */
void noh_gl_choose_covers(noh_stage *stage);

/* ---- textures ---- */

/* The textures of a kind's sets that no kind before it has, no set before theirs: their bytes; `shared`: those that
 * peers have, which are not in `bytes`.
 * errors  UNSUPPORTED a texture has blocks that the context does not support */
noh_result noh_gl_pictures_plan(const noh_stage_desc *desc, uint32_t kind, const noh_gl_caps *caps, uint64_t *bytes,
                                uint64_t *shared, noh_error *error);
uint32_t noh_gl_pictures_count(const noh_kind_desc *kind); /* of all sets */
/* Make the textures of all kinds that stay (NOH_NONE), also in a new context; of a slot: make them without pixels, fill
 * them by a piece. Delete the textures of a kind, or of all kinds (NOH_NONE). */
noh_result noh_gl_pictures_create(const noh_stage_desc *desc, const noh_stage_gl *gl, uint32_t kind, noh_error *error);
int noh_gl_pictures_fill(const noh_stage_desc *desc, const noh_stage_gl *gl, uint32_t kind, noh_gl_filling *f,
                         uint32_t *bytes);
void noh_gl_pictures_delete(const noh_stage_desc *desc, const noh_gl_device *device, const noh_stage_gl *gl,
                            uint32_t kind);

/* A texture of a kind's mesh pack, in one of the kind's sets. */
typedef struct noh_gl_picture_site {
    uint32_t kind, set, texture;
} noh_gl_picture_site;

/* Advance to the next one of all kinds before `end`; 0 at the end. Begin with texture UINT32_MAX. */
int noh_gl_next_picture(const noh_stage_desc *desc, uint32_t end, noh_gl_picture_site *where);
/* The first site with the same texture; may be the site itself. */
noh_gl_picture_site noh_gl_picture_owner(const noh_stage_desc *desc, noh_gl_picture_site where);
int noh_gl_owns_picture(const noh_stage_desc *desc, noh_gl_picture_site where, noh_texture *texture);
uint32_t noh_gl_picture_index(const noh_stage_desc *desc, noh_gl_picture_site where); /* in noh_gl_kind.pictures */
int noh_gl_is_streamed(const noh_stage_desc *desc, noh_gl_picture_site where, const noh_texture *texture);
/* How many are streamed.
 * errors  ARG texture_reserve is too small (need: the bytes) */
noh_result noh_gl_textures_plan(const noh_stage_desc *desc, const noh_gl_caps *caps, uint32_t *count, noh_error *error);
void noh_gl_textures_open(const noh_stage_desc *desc, noh_stage_gl *gl); /* before they are made */
void noh_gl_textures_stream(noh_stage *stage, uint32_t *bytes);

/* The meshes and slots of all sites that an owner serves. Borrowed by `out`. */
typedef struct noh_gl_tiles {
    noh_mesh meshes[NOH_MODEL_POOLS_MAX];
    uint32_t counts[NOH_MODEL_POOLS_MAX];
    uint32_t count;
    noh_mesh coarse; /* where `comes_later` */
    int comes_later;
    int vertices; /* 1: the path cpu finishes the vertices of the whole stage */
} noh_gl_tiles;

void noh_gl_tiles_of(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site owner, noh_gl_tiles *out);
/* The index of a site's first pool in the tiles of its owner. */
uint32_t noh_gl_first_pool(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site);
/* A level of a mesh, without its transfer where that is not drawn. */
noh_mesh noh_gl_as_lit(const noh_stage_desc *desc, const noh_mesh *mesh, uint32_t level);
noh_mesh noh_gl_site_mesh(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site); /* finest level */
/* The finest that is in the kind's own pack. Returns 0 where that is the finest of all: none comes later. */
int noh_gl_site_coarse(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site, noh_mesh *coarse);
noh_gl_morph_desc noh_gl_site_morph(const noh_stage_desc *desc, const noh_gl_tiles *tiles);

/* The plan of a site's model. Its tiles take kilobytes of stack, so it is never inlined. */
NOH_NEVER_INLINE noh_result noh_gl_site_plan(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site owner,
                                             const noh_gl_caps *caps, int without_direct, noh_gl_morph_plan *out,
                                             noh_error *error);

/* Whether the stage's path is `direct`. One renderer draws the whole stage, so `auto` takes it for all meshes or none:
 * where it is the cheapest for each. That is settled before bounds make the plan smaller, or each step might change
 * the path. */
int noh_gl_sums_in_draws(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_caps *caps);

#endif
