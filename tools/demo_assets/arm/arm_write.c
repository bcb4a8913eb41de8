#include "arm_write.h"

#include "arms.h"
#include "hand.h"
#include "shared/grab.h"
#include "shared/writer.h"
#include "shared/quat.h"

#include <stdlib.h>

/* What has been written so far. */
typedef struct {
    Writer w;
    Buffer nodes, roots, meshes, skins, samplers[CLIP_COUNT], channels[CLIP_COUNT];
    int node_count, root_count, skin_count, channel_count[CLIP_COUNT], times;
    ArmCensus census;
} File;

static const char *comma(int count)
{
    return count ? ",\n" : "";
}

/* ---- meshes ---- */

static void write_weights(File *file, const Shape *shape)
{
    int *joints = grab(NULL, HOLDERS * shape->count, (int)sizeof *joints);
    for (int i = 0; i < HOLDERS * shape->count; i++) {
        joints[i] = shape->weight[i] > 0 ? i % HOLDERS : 0;
    }
    int joint = write_joints(&file->w, joints, shape->count);
    int weight = write_floats(&file->w, shape->weight, shape->count, "VEC4", HOLDERS, TARGET_ARRAY);
    buffer_print(&file->meshes, ",\"JOINTS_0\":%d,\"WEIGHTS_0\":%d", joint, weight);
    free(joints);
}

/* Frees the shape; returns the mesh's number. */
static int add_mesh(File *file, const char *name, Shape shape, int is_skinned)
{
    Writer *w = &file->w;
    int position = write_vectors(w, shape.position, shape.count, 1);
    int normal = write_vectors(w, shape.normal, shape.count, 0);
    int colour = write_vectors(w, shape.colour, shape.count, 0);
    buffer_print(&file->meshes,
                 "%s{\"name\":\"%s\",\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"COLOR_0\":%d",
                 comma(file->census.meshes), name, position, normal, colour);
    if (is_skinned) {
        write_weights(file, &shape);
    }
    buffer_print(&file->meshes, "},\"indices\":%d,\"material\":0}]}",
                 write_indices(w, shape.indices, shape.index_count));
    file->census.vertices += shape.count;
    file->census.triangles += shape.index_count / 3;
    shape_free(&shape);
    return file->census.meshes++;
}

/* ---- nodes ---- */

/* child: -1 for none. Returns the node's number. */
static int add_node(File *file, const char *name, V3 bone, int child)
{
    buffer_print(&file->nodes, "%s{\"name\":\"%s\",\"translation\":[%.9g,%.9g,%.9g]", comma(file->node_count), name,
                 bone.x, bone.y, bone.z);
    if (child >= 0) {
        buffer_print(&file->nodes, ",\"children\":[%d]", child);
    }
    return file->node_count++;
}

static void add_root(File *file, int node)
{
    buffer_print(&file->roots, file->root_count++ ? ",%d" : "%d", node);
}

/* At a steady pace to the peak and three times as fast back; slerp gives the frames between. */
static void add_turn(File *file, int clip, int node, double turn)
{
    static const double way[] = { 0, 1.0 / 3, 2.0 / 3, 1, 0 };
    double values[4 * 5];
    for (int i = 0; i < 5; i++) {
        Quat q = quat_about(clip_axis(clip), way[i] * turn);
        values[4 * i] = q.x;
        values[4 * i + 1] = q.y;
        values[4 * i + 2] = q.z;
        values[4 * i + 3] = q.w;
    }
    int n = file->channel_count[clip]++, output = write_floats(&file->w, values, 5, "VEC4", 4, TARGET_NONE);
    buffer_print(&file->samplers[clip], "%s{\"input\":%d,\"output\":%d}", comma(n), file->times, output);
    buffer_print(&file->channels[clip], "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"rotation\"}}", comma(n),
                 n, node);
}

/* ---- the arms ---- */

static void add_segments(File *file)
{
    for (int i = 0; i < SEGMENT_COUNT; i++) {
        const Segment *segment = segment_number(i);
        int is_last = i == SEGMENT_COUNT - 1;
        int mesh = add_mesh(file, segment->name, tube_build(&segment->tube, &segment->dye), 0);
        int node = add_node(file, segment->name, segment->bone, is_last ? -1 : file->node_count + 1);
        buffer_print(&file->nodes, ",\"mesh\":%d}", mesh);
        if (i == 0) {
            add_root(file, node);
        } else {
            add_turn(file, BEND, node, segment_turn);
        }
    }
    file->census.joints += SEGMENT_COUNT;
}

/* Returns the skin's number. No joint is turned in the bind pose. */
static int add_skin(File *file, const Arm *arm, int first_node)
{
    double matrices[HOLDERS * 16] = { 0 };
    for (int i = 0; i < arm->tube.joint_count; i++) {
        double *m = &matrices[16 * i];
        m[0] = m[5] = m[10] = m[15] = 1;
        m[13] = -arm->tube.joint_at[i];
    }
    int accessor = write_floats(&file->w, matrices, arm->tube.joint_count, "MAT4", 16, TARGET_NONE);
    buffer_print(&file->skins, "%s{\"name\":\"%s\",\"skeleton\":%d,\"inverseBindMatrices\":%d,\"joints\":[",
                 comma(file->skin_count), arm->name, first_node, accessor);
    for (int i = 0; i < arm->tube.joint_count; i++) {
        buffer_print(&file->skins, i ? ",%d" : "%d", first_node + i);
    }
    buffer_print(&file->skins, "]}");
    return file->skin_count++;
}

static void add_arm(File *file, const Arm *arm)
{
    const Tube *tube = &arm->tube;
    int first = file->node_count;
    Buffer name = { 0 };
    for (int i = 0; i < tube->joint_count; i++) {
        V3 bone = i ? v3(0, tube->joint_at[i] - tube->joint_at[i - 1], 0) : arm->stand;
        name.count = 0;
        buffer_print(&name, "%s_%d", arm->name, i);
        buffer_pad(&name, name.count + 1, 0);
        int node = add_node(file, (const char *)name.bytes, bone, i + 1 < tube->joint_count ? first + i + 1 : -1);
        buffer_print(&file->nodes, "}");
        if (i) {
            add_turn(file, arm->clip, node, arm->turn);
        }
    }
    buffer_free(&name);
    int skin = add_skin(file, arm, first), mesh = add_mesh(file, arm->name, tube_build(tube, &arm->dye), 1);
    buffer_print(&file->nodes, ",\n{\"name\":\"%s\",\"mesh\":%d,\"skin\":%d}", arm->name, mesh, skin);
    add_root(file, first);
    add_root(file, file->node_count++);
    file->census.joints += tube->joint_count;
}

static void add_hands(File *file)
{
    static const char *const names[] = { "stream_a", "stream_b" };
    for (int open = 0; open < 2; open++) {
        int mesh = add_mesh(file, names[open], hand_shape(open, &hand_dye), 0);
        add_root(file, add_node(file, names[open], hand_stand(open), -1));
        buffer_print(&file->nodes, ",\"mesh\":%d}", mesh);
    }
}

/* ---- the file ---- */

static void join(Buffer *json, const char *before, Buffer *part, const char *after)
{
    buffer_print(json, "%s", before);
    buffer_append(json, part);
    buffer_print(json, "%s", after);
    buffer_free(part);
}

static void write_animations(File *file, Buffer *json)
{
    buffer_print(json, "\"animations\":[\n");
    for (int clip = 0; clip < CLIP_COUNT; clip++) {
        buffer_print(json, "%s{\"name\":\"%s\",\"extras\":{\"loop\":true},\n", comma(clip), clip_name(clip));
        join(json, "\"samplers\":[", &file->samplers[clip], "],\n");
        join(json, "\"channels\":[", &file->channels[clip], "]}");
    }
    buffer_print(json, "],\n");
    file->census.animations = CLIP_COUNT;
}

ArmCensus arm_write(Buffer *out)
{
    static const double times[] = { 0, 0.5, 1, 1.5, 2 };
    File file = { 0 };
    Buffer json = { 0 };
    file.times = write_scalars(&file.w, times, 5, 1);
    add_segments(&file);
    for (int i = 0; i < ARM_COUNT; i++) {
        add_arm(&file, arm_number(i));
    }
    add_hands(&file);
    buffer_print(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh demo_assets\"},\n\"scene\":0,");
    join(&json, "\"scenes\":[{\"nodes\":[", &file.roots, "]}],\n");
    join(&json, "\"nodes\":[\n", &file.nodes, "],\n");
    join(&json, "\"skins\":[\n", &file.skins, "],\n");
    buffer_print(&json, "\"materials\":[");
    material_write(&json, 1, "arm", 0.60, 1);
    join(&json, "],\n\"meshes\":[\n", &file.meshes, "],\n");
    write_animations(&file, &json);
    writer_finish(&file.w, &json, out);
    buffer_free(&json);
    return file.census;
}
