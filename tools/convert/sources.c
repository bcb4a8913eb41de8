#include "sources.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "choices.h"
#include "convert/clips/bvh_read.h"
#include "convert/clips/face_csv.h"
#include "convert/clips/markers.h"
#include "convert/base/file_kind.h"
#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"
#include "convert/clips/resample.h"
#include "convert/clips/shape_match.h"
#include "convert/fbx/fbx_read.h"
#include "convert/model/identity_join.h"
#include "convert/model/lip_target.h"
#include "convert/model/mesh_place.h"
#include "convert/model/model_attach.h"
#include "convert/model/model_extra.h"
#include "convert/mocap/clean.h"
#include "convert/model/two_stream.h"
#include "convert/obj/obj_read.h"
#include "convert/retarget/bones.h"
#include "convert/retarget/retarget_set.h"
#include "convert/model/surface_kind.h"
#include "convert/skin/eye_split.h"

#define BONES_RATIO 2.0 /* a larger ratio of bone lengths means another unit, not another person */

/* ---- reading ---- */

static int resample_set(raw_set *set, double sample_rate_hz, model_error *error)
{
    for (uint32_t i = 0; i < set->clip_count; i++) {
        raw_clip resampled;
        if (raw_clip_resample(&set->clips[i], sample_rate_hz, &resampled, error)) {
            return 1;
        }
        raw_clip_clear(&set->clips[i]);
        set->clips[i] = resampled;
    }
    return 0;
}

static int turn(raw_set *set, const source_options *options, model_error *error)
{
    double degrees = options->turn.degrees;
    if (options->turn.rest_first_frame && raw_rest_from_frame(set, 0)) {
        return model_fail(error, "", "--rest first-frame: no clip moves the skeleton's joints");
    }
    if (raw_stand_up(set) && options->skin.report) fprintf(options->skin.report, "+z is up: it was turned to +y\n");
    if (options->turn.faces_ahead) {
        if (raw_facing(&set->skeleton, &degrees)) {
            return model_fail(
                error, "",
                "--facing auto: no joints are named left and right, or they lie above each other: give --facing DEG");
        }
        degrees = -degrees;
        if (options->skin.report) fprintf(options->skin.report, "turned by %.1f degrees to face +z\n", degrees);
    }
    if (degrees != 0.0) raw_turn(set, degrees);
    return 0;
}

/* Of a file of clips alone. */
static int read_set(const char *path, file_reader reader, const source_options *options, raw_set **out,
                    model_error *error)
{
    const bvh_options bvh = { options->unit_cm, 0 };
    switch (reader) {
    case READER_RCL: return rcl_read(path, out, error);
    case READER_FACE: return face_csv_read(path, out, error);
    case READER_TRC: return trc_read(path, options->unit_cm, out, error);
    case READER_C3D: return c3d_read(path, options->unit_cm, out, error);
    default: return bvh_read(path, &bvh, out, error);
    }
}

static int read_clip_file(const char *path, file_reader reader, const source_options *options, source *s,
                          model_error *error)
{
    if (read_set(path, reader, options, &s->single, error)) return 1;
    s->m = model_new();
    s->sets = malloc(sizeof *s->sets);
    if (!s->m || !s->sets) {
        return model_fail_memory(error);
    }
    s->sets[0] = s->single;
    s->set_count = 1;
    if (turn(s->single, options, error)) return 1;
    if (clean_set(s->single, options->clean, options->skin.report, options->warnings)) return model_fail_memory(error);
    return options->sample_rate_hz > 0.0 ? resample_set(s->single, options->sample_rate_hz, error) : 0;
}

static int read_model(const char *path, const source_options *options, model **out, model_error *error)
{
    const obj_options obj = { options->unit_cm, options->targets };
    const fbx_options fbx = { options->unit_cm, &options->extras };
    const file_kind *kind = file_kind_of(path);
    const file_reader reader = kind ? kind->reader : READER_GLTF;
    switch (reader) {
    case READER_FBX: return fbx_read(path, &fbx, out, error);
    case READER_OBJ: return obj_read(path, &obj, out, error);
    case READER_GLTF: return model_read_gltf_with(path, &options->extras, out, error);
    default:
        return model_fail(error, "", "this is %s, not a model: %s", kind->what,
                          kind->instead ? kind->instead : "noh build MODEL FILE adds its clips to a model");
    }
}

/* Add the meshes of other files to a model that has meshes. */
static int attach_all(const source_options *options, model *m, model_error *error)
{
    for (uint32_t i = 0; i < options->attached_count && m->mesh_count; i++) {
        model *other = NULL;
        model_error own = { "", "" };
        int failed = read_model(options->attached[i], options, &other, &own) ||
                     model_attach(m, other, options->attach_joint, options->attached[i], &own);
        model_free(other);
        if (failed) return model_fail(error, options->attached[i], "%s", own.what);
    }
    return 0;
}

static int add_lips(model *m, FILE *report, model_error *error)
{
    char why[LIP_WHY_BYTES];
    if (lip_target_add(m, report, why, error)) return 1;
    return why[0] && model_warn(m, "--lips: %s; f and v use its recipe", why) ? model_fail_memory(error) : 0;
}

static int read_model_file(const char *path, const source_options *options, source *s, model_error *error)
{
    sample_options sampling = { options->sample_rate_hz };
    if (read_model(path, options, &s->m, error) || attach_all(options, s->m, error)) {
        return 1;
    }
    if (options->extras.count && s->m->mesh_count) {
        s->m->extras = options->extras;
        if (extras_check(s->m, error)) return 1;
    }
    for (uint32_t i = 0; i < options->two_stream_count; i++) {
        if (two_stream_join(s->m, options->two_streams[i], error)) {
            return 1;
        }
    }
    if (options->identity && s->m->mesh_count && identity_join(s->m, options->identity, error)) {
        return 1;
    }
    if (surface_kinds_of_objects(s->m) || meshes_upright(s->m)) return model_fail_memory(error);
    if (options->split_eyes && s->m->mesh_count && eyes_split(s->m, options->skin.report, error)) {
        return 1;
    }
    if (options->lips && s->m->mesh_count && add_lips(s->m, options->skin.report, error)) {
        return 1;
    }
    if (choices_shape(s->m, options->choices, options->skin.report, error)) return 1;
    if (seams_close(s->m, options->seam, options->skin.report, error)) {
        return 1;
    }
    if (options->skin.rigid_faces && skins_of_faces(s->m)) return model_fail_memory(error);
    if (clips_from_model(s->m, &sampling, &s->made, error) || skins_bind(s->m, s->made, &options->skin, error)) {
        return 1;
    }
    s->sets = malloc(((size_t)s->made->set_count + 1u) * sizeof *s->sets); /* with room for `single` */
    if (!s->sets) {
        return model_fail_memory(error);
    }
    s->set_count = s->made->set_count;
    for (uint32_t i = 0; i < s->set_count; i++) {
        if (clean_set(s->made->sets[i], options->clean, options->skin.report, options->warnings))
            return model_fail_memory(error);
    }
    if (s->set_count) memcpy(s->sets, s->made->sets, s->set_count * sizeof *s->sets);
    return 0;
}

/* Games, graphs, ragdolls and clips of other files find joints by name. */
static int warn_of_joint_names(source *s, const raw_skeleton *k)
{
    const char *first = NULL;
    uint32_t count = 0;
    for (uint32_t j = 1; j < k->joint_count; j++) {
        const char *name = k->joints[j].name;
        uint32_t before = 0;
        while (before < j && name && (!k->joints[before].name || strcmp(k->joints[before].name, name) != 0)) before++;
        if (!name || !*name || before == j) continue;
        if (!count++) first = name;
    }
    return count && model_warn(s->m,
                               "joint name '%.80s' is used more than once (%u joints repeat a name): a name finds only "
                               "one of them; give each its own name",
                               first, count);
}

int source_read(const char *path, const source_options *options, source *s, model_error *error)
{
    const file_kind *kind = file_kind_of(path);
    memset(s, 0, sizeof *s);
    if (kind && kind->reader >= READER_BVH ? read_clip_file(path, kind->reader, options, s, error)
                                           : read_model_file(path, options, s, error))
        return 1;
    for (uint32_t i = 0; i < s->set_count; i++) {
        if (warn_of_joint_names(s, &s->sets[i]->skeleton)) return model_fail_memory(error);
    }
    return 0;
}

void source_free(source *s)
{
    model_clips_free(s->made);
    raw_set_free(s->single);
    model_free(s->m);
    free(s->sets);
    memset(s, 0, sizeof *s);
}

int source_has_joint(const source *s, const char *name)
{
    for (uint32_t i = 0; i < s->set_count; i++) {
        const raw_skeleton *k = &s->sets[i]->skeleton;
        for (uint32_t j = 0; j < k->joint_count; j++) {
            if (strcmp(k->joints[j].name, name) == 0) return 1;
        }
    }
    return 0;
}

/* ---- which skeleton ---- */

static const char *joint_name(const raw_skeleton *s, uint32_t joint)
{
    return joint == MODEL_NONE ? "none" : s->joints[joint].name ? s->joints[joint].name : "";
}

/* " --partial ...", where --partial fits the set, which is then changed: it is refused anyway. */
static const char *partial_advice(raw_set *set, const raw_skeleton *to)
{
    const joint_match_options in_part = { .partial = 1 };
    model_error unused;
    char *report;
    const int fits = joint_match_set(set, to, &in_part, &report, &unused) == JOINTS_MATCHED;
    free(report);
    return fits ? " --partial uses the joints that both have;" : "";
}

static int fail_skeletons(const raw_skeleton *base, const char *base_path, raw_set *set, model_error *error)
{
    const raw_skeleton *other = &set->skeleton;
    const uint32_t count = other->joint_count;
    uint32_t least = base->joint_count < count ? base->joint_count : count;
    for (uint32_t j = 0; j < least; j++) {
        const char *there = joint_name(base, j);
        if (strcmp(joint_name(other, j), there) != 0) {
            char here[41];
            (void)snprintf(here, sizeof here, "%s", joint_name(other, j));
            return model_fail(error, "",
                              "its skeleton differs from %.80s: joint %u is '%s' here and '%.40s' there;%s "
                              "--rename FILE maps names, --retarget FILE says which joints are a person's bones",
                              base_path, j, here, there, partial_advice(set, base));
        }
        if (other->joints[j].parent != base->joints[j].parent) {
            return model_fail(
                error, "",
                "its skeleton differs from %.80s: the parent of joint '%.30s' is '%.30s' here and '%.30s' there",
                base_path, there, joint_name(other, other->joints[j].parent), joint_name(base, base->joints[j].parent));
        }
    }
    return model_fail(error, "",
                      "its skeleton differs from %.80s: it has %u joints here and %u there;%s --rename FILE maps names",
                      base_path, count, base->joint_count, partial_advice(set, base));
}

/* The first of the base's skeletons that has joints. NULL: none has. */
static const raw_skeleton *first_skeleton(const source *base)
{
    for (uint32_t i = 0; i < base->set_count; i++) {
        if (base->sets[i]->skeleton.joint_count) return &base->sets[i]->skeleton;
    }
    return NULL;
}

/* Find the base's set that has the same joints as `from`. */
static int find_set(const source *base, const char *base_path, raw_set *from, raw_set **to, model_error *error)
{
    const raw_skeleton *first = first_skeleton(base);
    for (uint32_t i = 0; i < base->set_count; i++) {
        const raw_skeleton *s = &base->sets[i]->skeleton;
        if (s->joint_count && raw_skeleton_hash(s) == raw_skeleton_hash(&from->skeleton)) {
            *to = base->sets[i];
            return 0;
        }
    }
    return first ? fail_skeletons(first, base_path, from, error)
                 : model_fail(error, "",
                              "it animates a skeleton, and %.150s has none: give a model with a skeleton first",
                              base_path);
}

/* A set for clips without joints: any of the base's, or a new one. */
static int any_set(source *base, raw_set **to, model_error *error)
{
    if (base->set_count == 0) {
        base->single = raw_set_new(0, 0);
        if (!base->single) {
            return model_fail_memory(error);
        }
        base->single->skeleton.unit_cm = 100.0;
        base->sets[0] = base->single;
        base->set_count = 1;
    }
    *to = base->sets[0];
    return 0;
}

/* ---- moving clips ---- */

static uint32_t find_node(const model *m, const raw_floats *floats)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        const model_node *node = &m->nodes[n];
        if (node->mesh != MODEL_NONE && m->meshes[node->mesh].target_count == floats->width &&
            strcmp(node->name, floats->name) == 0) {
            return n;
        }
    }
    return MODEL_NONE;
}

/* Assign the clip's weights to the base's nodes; weights of nodes that the base lacks are left out. */
static int bind_weights(source *base, const char *base_path, raw_clip *clip, model_error *error)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < clip->float_count; i++) {
        raw_floats floats = clip->floats[i];
        uint32_t node = floats.node == MODEL_NONE ? MODEL_NONE : find_node(base->m, &floats);
        if (floats.node != MODEL_NONE && node == MODEL_NONE) {
            int failed = model_warn(base->m,
                                    "clip '%s': %s has no node '%s' with %u targets: its weights were left out",
                                    clip->name, base_path, floats.name, floats.width);
            free(floats.name);
            free(floats.values);
            free(floats.radius);
            memset(&clip->floats[i], 0, sizeof floats);
            if (failed) return model_fail_memory(error);
            continue;
        }
        floats.node = node;
        memset(&clip->floats[i], 0, sizeof floats);
        clip->floats[kept++] = floats;
    }
    clip->float_count = kept;
    return 0;
}

static int has_clip(const raw_set *set, const char *name)
{
    for (uint32_t c = 0; c < set->clip_count; c++) {
        if (strcmp(set->clips[c].name, name) == 0) {
            return 1;
        }
    }
    return 0;
}

/* To FILE/NAME. */
static int rename_clip(raw_clip *clip, const char *path, model_error *error)
{
    const char *slash = strrchr(path, '/'), *stem = slash ? slash + 1 : path, *dot = strrchr(stem, '.');
    size_t length = dot ? (size_t)(dot - stem) : strlen(stem), bytes = length + strlen(clip->name) + 2;
    char *name = malloc(bytes);
    if (!name) {
        return model_fail_memory(error);
    }
    snprintf(name, bytes, "%.*s/%s", (int)length, stem, clip->name);
    free(clip->name);
    clip->name = name;
    return 0;
}

/* Files of one name, such as a/walk.bvh and b/walk.bvh: the next free number goes behind the clip's name. */
static int number_clip(source *base, const raw_set *to, raw_clip *clip, model_error *error)
{
    const size_t bytes = strlen(clip->name) + 16u;
    char *wanted = clip->name, *name = malloc(bytes);
    int failed;
    if (!name) return model_fail_memory(error);
    for (uint32_t n = 2; n == 2 || has_clip(to, name); n++) snprintf(name, bytes, "%s_%u", wanted, (unsigned)n);
    clip->name = name;
    failed = model_warn(base->m, "two clips are named '%.80s': the second is clip '%.80s'", wanted, name);
    free(wanted);
    return failed ? model_fail_memory(error) : 0;
}

static void scale_translations(raw_clip *clip, double scale)
{
    for (size_t i = 0; i < (size_t)clip->frame_count * clip->joint_count * 3u; i++) {
        clip->translations[i] = (float)((double)clip->translations[i] * scale);
    }
}

/* Move a clip to the end of a set; an empty one stays behind. */
static int move_clip(raw_clip *clip, raw_set *to, model_error *error)
{
    raw_clip *grown = realloc(to->clips, ((size_t)to->clip_count + 1u) * sizeof *grown);
    clip->source = NULL; /* its nodes are another file's */
    if (!grown) {
        return model_fail_memory(error);
    }
    to->clips = grown;
    to->clips[to->clip_count++] = *clip;
    memset(clip, 0, sizeof *clip);
    return 0;
}

static int join_clip(source *base, const char *base_path, raw_set *from, raw_clip *clip, const char *path,
                     uint32_t *joined, model_error *error)
{
    raw_set *to = NULL;
    if (clip->joint_count ? find_set(base, base_path, from, &to, error) : any_set(base, &to, error)) {
        return 1;
    }
    if (base->m->mesh_count && clip->float_count && clip->floats[0].node == MODEL_NONE &&
        shapes_match(base->m, base_path, clip)) {
        return model_fail_memory(error);
    }
    if (bind_weights(base, base_path, clip, error) || (has_clip(to, clip->name) && rename_clip(clip, path, error))) {
        return 1;
    }
    if (has_clip(to, clip->name) && number_clip(base, to, clip, error)) return 1;
    if (clip->joint_count == 0 && clip->float_count == 0) {
        return 0; /* none of it was kept */
    }
    *joined += 1;
    scale_translations(clip, from->skeleton.unit_cm / to->skeleton.unit_cm);
    return move_clip(clip, to, error);
}

/* Clips of one humanoid on the first of the base's skeletons. */
static int retarget_joints(const source *base, raw_set *from, const joint_match_options *options, model_error *error)
{
    const char *map = options->retarget && strcmp(options->retarget, "auto") != 0 ? options->retarget : NULL;
    const raw_skeleton *to = from->skeleton.joint_count ? first_skeleton(base) : NULL;
    if (!to || retarget_same(&from->skeleton, to)) return 0;
    return retarget_set(from, to, map, options->report, error);
}

static int is_person(const raw_skeleton *skeleton)
{
    uint16_t bones[NOH_BONES];
    bones_find(skeleton, bones);
    return bones_are_a_person(bones);
}

/* Give a set the joints of the first of the base's skeletons that they can be matched with; a person that matches none
 * is retargeted, unless the caller says how its joints are matched. */
static int match_joints(source *base, raw_set *from, const char *path, const joint_match_options *options,
                        model_error *error)
{
    joint_match match = JOINTS_DIFFER;
    const raw_skeleton *to;
    for (uint32_t i = 0; i < base->set_count; i++) {
        if (raw_skeleton_hash(&base->sets[i]->skeleton) == raw_skeleton_hash(&from->skeleton)) return 0;
    }
    for (uint32_t i = 0; i < base->set_count && match == JOINTS_DIFFER; i++) {
        char *report;
        int failed;
        match = joint_match_set(from, &base->sets[i]->skeleton, options, &report, error);
        failed = report && match == JOINTS_MATCHED && model_warn(base->m, "%s: %s", path, report);
        free(report);
        if (failed) return model_fail_memory(error);
    }
    if (match != JOINTS_DIFFER || options->partial || options->names) return match == JOINTS_FAILED;
    to = first_skeleton(base);
    if (!to || !is_person(&from->skeleton) || !is_person(to)) return 0;
    if (retarget_joints(base, from, options, error)) return 1;
    return model_warn(
               base->m,
               "%s: its skeleton is another one, so its clips were retargeted, which moves the bones of a person "
               "alone (--partial moves all joints that both have; --retarget auto hides this warning)",
               path)
               ? model_fail_memory(error)
               : 0;
}

/* ---- warnings ---- */

/* How much longer a clip's bones are than the skeleton's that it is to move, the clip in the unit of `from`: the sum of
 * all. 1 where there is nothing to compare. */
static double bones_ratio(const raw_set *from, const raw_clip *clip, const raw_skeleton *to)
{
    double own = 0.0, theirs = 0.0;
    if (clip->joint_count != to->joint_count || clip->frame_count == 0u) return 1.0;
    for (uint32_t j = 0; j < to->joint_count; j++) {
        const float *a = clip->translations + 3u * (size_t)j, *b = to->joints[j].translation;
        if (to->joints[j].parent == MODEL_NONE || to->joints[to->joints[j].parent].parent == MODEL_NONE) continue;
        own += sqrt((double)a[0] * (double)a[0] + (double)a[1] * (double)a[1] + (double)a[2] * (double)a[2]);
        theirs += sqrt((double)b[0] * (double)b[0] + (double)b[1] * (double)b[1] + (double)b[2] * (double)b[2]);
    }
    return own > 0.0 && theirs > 0.0 ? own * from->skeleton.unit_cm / (theirs * to->unit_cm) : 1.0;
}

/* Clips of a body of another size make the mesh as large as that. Before clips are moved. */
static int warn_of_bones(source *base, const char *base_path, const raw_set *from, const char *path)
{
    for (uint32_t i = 0; i < base->set_count && from->clip_count; i++) {
        const raw_skeleton *to = &base->sets[i]->skeleton;
        const double ratio = to->joint_count && raw_skeleton_hash(to) == raw_skeleton_hash(&from->skeleton)
                                 ? bones_ratio(from, &from->clips[0], to)
                                 : 1.0;
        if (ratio >= 1.0 / BONES_RATIO && ratio <= BONES_RATIO) continue;
        return model_warn(
            base->m,
            "%s: its bones are %.3g times as long as in %s, and the clips scale the body to match; --unit-cm %.3g "
            "(now %.3g) makes them equal",
            path, ratio, base_path, from->skeleton.unit_cm / ratio, from->skeleton.unit_cm);
    }
    return 0;
}

/* Warnings from reading the other file. Sizes are compared with the base's. */
static int keep_warnings(source *base, const char *base_path, const source *other, const char *path)
{
    for (uint32_t i = 0; i < other->m->warning_count; i++) {
        if (model_warn(base->m, "%s: %s", path, other->m->warnings[i])) return 1;
    }
    for (uint32_t i = 0; i < other->set_count; i++) {
        const raw_set *set = other->sets[i];
        if ((set->warning && model_warn(base->m, "%s: %s", path, set->warning)) ||
            warn_of_bones(base, base_path, set, path))
            return 1;
    }
    return 0;
}

int source_join(source *base, const char *base_path, source *other, const char *other_path,
                const joint_match_options *options, model_error *error)
{
    const int retargets = options->retarget || other->m->for_any_body;
    uint32_t joined = 0;
    for (uint32_t i = 0; i < other->set_count; i++) {
        if (retargets ? retarget_joints(base, other->sets[i], options, error)
                      : match_joints(base, other->sets[i], other_path, options, error)) {
            return 1;
        }
    }
    if (keep_warnings(base, base_path, other, other_path)) return model_fail_memory(error);
    for (uint32_t i = 0; i < other->set_count; i++) {
        for (uint32_t c = 0; c < other->sets[i]->clip_count; c++) {
            if (join_clip(base, base_path, other->sets[i], &other->sets[i]->clips[c], other_path, &joined, error)) {
                return 1;
            }
        }
    }
    if (joined == 0) {
        return model_fail(error, "", "it has no clips to add to %.150s", base_path);
    }
    if (other->m->mesh_count &&
        model_warn(base->m, "%s: only its clips were used: the meshes come from %s", other_path, base_path)) {
        return model_fail_memory(error);
    }
    return 0;
}
