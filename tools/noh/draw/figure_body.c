/* figure_body.c: the gaze and the ground of a figure. */
#include "figure_body.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/message.h"
#include "figure.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "tool_shaders.gen.h"

#define STEP_HEIGHT 0.17f /* metres */
#define STEP_DEPTH 0.3f
#define STEPS_FROM 0.6f
#define STAIRS_HALF 0.9f
#define LANDING 6.0f
#define HIGHEST 5000.0f         /* metres, above all ground */
#define SLOPE_RAD 0.3490658504f /* 20 degrees, downhill along +z */
#define FLOATS 9u               /* of a corner: position, normal, colour */

/* ---- options ---- */

static int parse_point(const char *text, float point[3])
{
    char copy[128], *at = copy;
    if (strlen(text) >= sizeof copy) return 1;
    snprintf(copy, sizeof copy, "%s", text);
    for (int i = 0; i < 3; i++) {
        char *comma = strchr(at, ',');
        double value;
        if ((i < 2) != (comma != NULL)) return 1;
        if (comma) *comma = '\0';
        if (tool_number(at, &value) || !(fabs(value) <= 1e6)) return 1;
        point[i] = (float)value;
        at = comma ? comma + 1 : at;
    }
    return 0;
}

/* A file has a dot or a folder in its name. */
static int read_land(const char *path, figure_body *b)
{
    if (!strchr(path, '.') && !strchr(path, '/')) {
        return tool_usage("--ground must be stairs, slope or a file (.noh, .png, .glb), not '%s'", path);
    }
    return ground_file_open(&b->land, path);
}

int figure_body_parse(const body_options *o, figure_body *b, int *wanted)
{
    memset(b, 0, sizeof *b);
    b->looks = o->look_at != NULL;
    b->has_ground = o->ground != NULL;
    b->name = o->ground;
    *wanted = b->looks || b->has_ground;
    if (o->look_at && parse_point(o->look_at, b->point)) {
        return tool_usage("--look-at must be X,Y,Z in the pack's unit, each at most 1e6, not '%s'", o->look_at);
    }
    return o->ground && strcmp(o->ground, "stairs") != 0 && strcmp(o->ground, "slope") != 0 ? read_land(o->ground, b)
                                                                                            : 0;
}

void figure_body_free(figure_body *b)
{
    ground_file_close(&b->land);
}

/* ---- the world ---- */

static void lay_stairs(figure_body *b)
{
    for (uint32_t i = 0; i < FIGURE_STEPS; i++) {
        noh_obb *box = &b->boxes[i];
        box->half[0] = STAIRS_HALF * b->metre;
        box->half[1] = 0.5f * STEP_HEIGHT * b->metre * (float)(i + 1u);
        box->half[2] = 0.5f * (STEP_DEPTH * (float)(FIGURE_STEPS - 1u - i) + LANDING) * b->metre;
        box->centre[1] = box->half[1];
        box->centre[2] = (STEPS_FROM + STEP_DEPTH * (float)i) * b->metre + box->half[2];
        box->rotation[3] = 1.0f;
    }
    b->world.boxes = b->boxes;
    b->world.box_count = FIGURE_STEPS;
}

static void lay_land(figure_body *b)
{
    b->field = b->land.field;
    for (int i = 0; i < 3; i++) b->field.origin[i] *= b->metre;
    b->field.spacing *= b->metre;
    b->field.scale *= b->metre;
    b->world.field = &b->field;
}

static void lay_ground(figure_body *b)
{
    if (b->land.field.heights) {
        lay_land(b);
        return;
    }
    b->planes[0].normal[1] = 1.0f;
    b->world.planes = b->planes;
    b->world.plane_count = 1;
    if (strcmp(b->name, "stairs") == 0) {
        lay_stairs(b);
    } else {
        b->planes[0].normal[1] = cosf(SLOPE_RAD);
        b->planes[0].normal[2] = sinf(SLOPE_RAD);
    }
}

float figure_body_height(const figure_body *b, const float at[3])
{
    const noh_ground ground = { &b->world, NULL, NULL };
    const float from[3] = { at[0], HIGHEST * b->metre, at[2] };
    float normal[3];
    const float distance = b->has_ground ? noh_ground_below(&ground, from, 2.0f * HIGHEST * b->metre, normal) : -1.0f;
    return distance >= 0.0f ? from[1] - distance : 0.0f;
}

/* ---- parts ---- */

/* A kind without joints that look has a face, whose eyes look; it does nothing else. */
static int add_face(figure_body *b, noh_kind_desc *kind, uint32_t k, noh_error *error)
{
    if (!figure_find_eyes(kind, &b->faces[k], error)) return 0;
    b->faces[k].flags = NOH_FACE_CALM;
    kind->face = noh_face_module(&b->faces[k]);
    b->has_faces = 1;
    return 1;
}

static int add_to(figure_body *b, noh_kind_desc *kind, uint32_t k, noh_error *error)
{
    noh_ragdoll_source source;
    const noh_skeleton_header *header;
    uint32_t count = 0;
    memset(&source, 0, sizeof source);
    source.pack = kind->mesh;
    source.skeleton = kind->skeleton;
    if (noh_pack_skeleton_at(kind->mesh, kind->skeleton, &source.joints, &header, error)) return 0;
    source.metres = (float)header->unit_cm / 100.0f;
    b->metre = 1.0f / source.metres;
    if (b->looks && (kind->face.type || !noh_gaze_rig_make(kind->mesh, kind->skeleton, &b->gazes[k], error) ||
                     add_face(b, kind, k, error))) {
        b->parts[k][count++] = noh_gaze_modifier(&b->gazes[k]);
    }
    if (b->has_ground && !noh_feet_rig_make(&source, &b->feet[k].rig, error)) {
        b->feet[k].ground.world = &b->world;
        b->parts[k][count++] = noh_feet_modifier(&b->feet[k]);
        kind->root_axes = NOH_ROOT_GROUND;
    }
    kind->modifiers = count ? b->parts[k] : NULL;
    kind->modifier_count = count;
    return count == (uint32_t)(b->looks + b->has_ground);
}

int figure_body_add(figure_body *b, const char *file, noh_kind_desc *kinds, uint32_t kind_count)
{
    noh_error error = { NOH_OK, "no skeleton", 0, 0 };
    int can = 0;
    b->metre = 1.0f;
    for (uint32_t k = 0; k < kind_count; k++) {
        if (kinds[k].skeleton == NOH_NONE && b->looks && (kinds[k].face.type || add_face(b, &kinds[k], k, &error))) {
            can |= !b->has_ground;
        }
        if (kinds[k].skeleton != NOH_NONE) can |= add_to(b, &kinds[k], k, &error);
    }
    if (!can) {
        return tool_fail(file, "%s: %s", b->has_ground ? "--ground" : "--look-at", error.what);
    }
    if (b->has_ground) lay_ground(b);
    return 0;
}

int figure_body_place(const figure_body *b, noh_stage *stage, const noh_kind_desc *kinds, const noh_actor *actors,
                      uint32_t kind_count)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < kind_count; k++) {
        noh_place place;
        if (b->looks && kinds[k].face.type && noh_actor_look_at(stage, actors[k], b->point, &error)) {
            return tool_fail_error("--look-at", &error);
        }
        if (b->looks && !kinds[k].face.type && kinds[k].modifier_count) {
            const uint32_t after = strcmp(kinds[k].modifiers[0].name, "stand") == 0; /* figure_add_rest */
            noh_gaze *g = noh_actor_modifier(stage, actors[k], after);
            memcpy(g->point, b->point, sizeof g->point);
            g->looks = 1;
        }
        if (!b->has_ground) continue;
        if (noh_actor_place(stage, actors[k], &place, &error)) return tool_fail_error("--ground", &error);
        place.position[1] = figure_body_height(b, place.position);
        if (noh_actor_set_place(stage, actors[k], &place, &error)) return tool_fail_error("--ground", &error);
    }
    return 0;
}

/* ---- drawn ---- */

static float *put_quad(float *out, const float p[4][3], const float normal[3], float shade)
{
    static const int order[6] = { 0, 1, 2, 0, 2, 3 };
    for (int i = 0; i < 6; i++) {
        memcpy(out, p[order[i]], 12);
        memcpy(out + 3, normal, 12);
        out[6] = out[7] = out[8] = shade;
        out += FLOATS;
    }
    return out;
}

#define TILES 48u /* of the floor and the slope, each way, half a metre each */
#define QUADS (TILES * TILES + 4u * FIGURE_STEPS)

/* The floor, or a slope that falls by `fall` for each metre along z. */
static float *put_plane(const figure_body *b, float fall, float *out)
{
    const float half = 0.5f * b->metre;
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        const uint32_t row = i / TILES, column = i % TILES;
        const float z = half * ((float)row - 0.5f * (float)TILES), x = half * ((float)column - 0.5f * (float)TILES);
        const float y = -fall * z, end = -fall * (z + half);
        const float p[4][3] = { { x, y, z }, { x, end, z + half }, { x + half, end, z + half }, { x + half, y, z } };
        out = put_quad(out, p, b->planes[0].normal, (row + column) % 2u ? 0.26f : 0.31f);
    }
    return out;
}

/* Half-metre squares of terrain, as far as it reaches. The normal is taken at the middle. */
static float *put_land(const figure_body *b, float *out)
{
    static const float corner[4][2] = { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } };
    const float half = 0.5f * b->metre;
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        const uint32_t row = i / TILES, column = i % TILES;
        const float x = half * ((float)column - 0.5f * (float)TILES), z = half * ((float)row - 0.5f * (float)TILES);
        float p[4][3], normal[3], middle;
        int there = noh_field_height(&b->field, x + 0.5f * half, z + 0.5f * half, &middle, normal);
        for (int k = 0; k < 4 && there; k++) {
            p[k][0] = x + half * corner[k][0];
            p[k][2] = z + half * corner[k][1];
            there = noh_field_height(&b->field, p[k][0], p[k][2], &p[k][1], NULL);
        }
        if (there) out = put_quad(out, (const float(*)[3])p, normal, (row + column) % 2u ? 0.26f : 0.31f);
    }
    return out;
}

/* The front, top and sides of each step. */
static float *put_steps(const figure_body *b, float *out)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f }, front[3] = { 0.0f, 0.0f, -1.0f }, left[3] = { 1.0f, 0.0f, 0.0f },
                       right[3] = { -1.0f, 0.0f, 0.0f };
    const float w = STAIRS_HALF * b->metre, riser = STEP_HEIGHT * b->metre, depth = STEP_DEPTH * b->metre;
    for (uint32_t i = 0; i < FIGURE_STEPS; i++) {
        const float y = riser * (float)(i + 1u), z = STEPS_FROM * b->metre + depth * (float)i;
        const float end = i + 1u < FIGURE_STEPS ? z + depth : z + LANDING * b->metre;
        const float face[4][3] = { { -w, y - riser, z }, { -w, y, z }, { w, y, z }, { w, y - riser, z } };
        const float tread[4][3] = { { -w, y, z }, { -w, y, end }, { w, y, end }, { w, y, z } };
        const float flank[4][3] = { { w, 0.0f, z }, { w, y, z }, { w, y, end }, { w, 0.0f, end } };
        out = put_quad(out, face, front, 0.22f);
        out = put_quad(out, tread, up, i % 2u ? 0.46f : 0.38f);
        const float other[4][3] = { { -w, 0.0f, z }, { -w, y, z }, { -w, y, end }, { -w, 0.0f, end } };
        out = put_quad(out, flank, left, 0.30f);
        out = put_quad(out, other, right, 0.30f);
    }
    return out;
}

static void describe_vertices(figure_body *b, const float *vertices)
{
    const noh_gl_api *gl = &b->g->gl;
    gl->GenVertexArrays(1, &b->vertex_array);
    gl->GenBuffers(1, &b->buffer);
    gl->BindVertexArray(b->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, b->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(sizeof(float) * FLOATS * b->corners), vertices, GL_STATIC_DRAW);
    for (GLuint i = 0; i < 3; i++) {
        gl->EnableVertexAttribArray(i);
        gl->VertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, FLOATS * sizeof(float), (const void *)(uintptr_t)(12u * i));
    }
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

int figure_body_open_gl(figure_body *b, gpu *g)
{
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    float *vertices;
    if (!b->has_ground || !g) return 0;
    memset(&desc, 0, sizeof desc);
    desc.name = "ground";
    desc.vertex = &noh_shader_bones_vert;
    desc.fragment = &noh_shader_bones_frag;
    if (noh_gl_program_create(&g->gl, &desc, &b->program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("--ground", &error);
    }
    b->g = g;
    vertices = malloc(sizeof(float) * FLOATS * 6u * QUADS);
    if (!vertices) return tool_fail("--ground", "out of memory");
    float *end = b->world.field ? put_land(b, vertices)
                                : put_plane(b, b->world.box_count ? 0.0f : tanf(SLOPE_RAD), vertices);
    if (b->world.box_count) end = put_steps(b, end);
    b->corners = (uint32_t)((size_t)(end - vertices) / FLOATS);
    describe_vertices(b, vertices);
    free(vertices);
    return 0;
}

void figure_body_close_gl(figure_body *b)
{
    if (!b->g) return;
    noh_gl_program_delete(&b->g->gl, NULL, &b->program);
    b->g->gl.DeleteBuffers(1, &b->buffer);
    b->g->gl.DeleteVertexArrays(1, &b->vertex_array);
    b->g = NULL;
    b->corners = 0;
}

void figure_body_draw(const figure_body *b, const noh_stage_view *seen)
{
    if (!b->g || !b->corners) return;
    const noh_gl_api *gl = &b->g->gl;
    gl->UseProgram(b->program);
    gl->UniformMatrix4fv(gl->GetUniformLocation(b->program, "u_view_projection"), 1, GL_FALSE, seen->view_projection);
    gl->Uniform3fv(gl->GetUniformLocation(b->program, "u_key"), 1, seen->light);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS);
    gl->BindVertexArray(b->vertex_array);
    gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)b->corners);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->Disable(GL_DEPTH_TEST);
}
