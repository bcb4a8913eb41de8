#include "body.h"

#include "ambient.h"
#include "shared/grab.h"
#include "parts.h"
#include "subdivide.h"

#include <math.h>
#include <stdlib.h>

static Cage build_cage(void)
{
    Cage cage = { 0 };
    Borders borders;
    torso_build(&cage, &borders);
    head_build(&cage, borders.neck);
    for (int side = 0; side < SIDES; side++) {
        int wrist[ARM_RING], ankle[LEG_RING];
        cage.mirrored = side == RIGHT;
        sleeve_build(&cage, side, borders.arm[side], wrist);
        hand_build(&cage, side, wrist);
        skirt_build(&cage, side, borders.leg[side], ankle);
        foot_build(&cage, side, ankle);
    }
    cage.mirrored = 0;
    return cage;
}

Cage body_surface(void)
{
    Cage cage = build_cage(), once = subdivide(&cage), twice = subdivide(&once);
    cage_free(&cage);
    cage_free(&once);
    /* Soles are flat. */
    for (int i = 0; i < twice.vertex_count; i++) {
        twice.vertices[i].at.y = fmax(twice.vertices[i].at.y, 0);
    }
    return twice;
}

/* Each corner adds its face's direction there, times the corner's area. */
V3 *surface_normals(const Cage *surface)
{
    V3 *normals = grab(NULL, surface->vertex_count, (int)sizeof *normals);
    for (int i = 0; i < surface->vertex_count; i++) {
        normals[i] = v3(0, 0, 0);
    }
    for (int f = 0; f < surface->face_count; f++) {
        const int *corner = surface->faces[f].corner;
        for (int i = 0; i < 4; i++) {
            V3 at = surface->vertices[corner[i]].at;
            V3 next = v3_sub(surface->vertices[corner[(i + 1) % 4]].at, at);
            V3 last = v3_sub(surface->vertices[corner[(i + 3) % 4]].at, at);
            normals[corner[i]] = v3_add(normals[corner[i]], v3_cross(next, last));
        }
    }
    for (int i = 0; i < surface->vertex_count; i++) {
        normals[i] = v3_unit(normals[i]);
    }
    return normals;
}

/* --- weights --- */

static Grip strongest(const Hold *hold)
{
    Grip grip = { { 0 }, { 0 } };
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        int place = HELD_BY;
        while (place > 0 && hold->by[joint] > grip.weight[place - 1]) {
            place--;
        }
        for (int i = HELD_BY - 1; i > place; i--) {
            grip.joint[i] = grip.joint[i - 1];
            grip.weight[i] = grip.weight[i - 1];
        }
        if (place < HELD_BY) {
            grip.joint[place] = joint;
            grip.weight[place] = hold->by[joint];
        }
    }
    return grip;
}

Grip grip_of(const Hold *hold)
{
    Grip grip = strongest(hold);
    double sum = 0, rest = 65536;
    for (int i = 0; i < HELD_BY; i++) {
        sum += grip.weight[i];
    }
    for (int i = HELD_BY - 1; i > 0; i--) {
        double steps = floor(grip.weight[i] / sum * 65536 + 0.5);
        /* Weights below 1/256 are dropped. */
        steps = steps < 256 ? 0 : steps;
        grip.weight[i] = steps / 65536;
        grip.joint[i] = steps > 0 ? grip.joint[i] : 0;
        rest -= steps;
    }
    grip.weight[0] = rest / 65536;
    return grip;
}

/* --- pieces --- */

/* A corner of a face: corners that agree in all but the face become one vertex of the file. */
typedef struct {
    int vertex, paint;
    double u, v;
    int face, corner;
} Corner;

static int compare(double a, double b)
{
    return (a > b) - (a < b);
}

static int corner_agreement(const Corner *a, const Corner *b)
{
    int order = compare(a->vertex, b->vertex);
    order = order ? order : compare(a->paint, b->paint);
    order = order ? order : compare(a->u, b->u);
    return order ? order : compare(a->v, b->v);
}

static int corner_order(const void *left, const void *right)
{
    const Corner *a = left, *b = right;
    int order = corner_agreement(a, b);
    order = order ? order : compare(a->face, b->face);
    return order ? order : compare(a->corner, b->corner);
}

static int collect_corners(const Cage *surface, int material, Corner *corners)
{
    int count = 0;
    for (int f = 0; f < surface->face_count; f++) {
        const CageFace *face = &surface->faces[f];
        for (int i = 0; i < 4 && paint_material(face->paint) == material; i++) {
            /* Equal texture coordinates may differ by rounding. */
            double u = floor(face->u[i] * 65536 + 0.5) / 65536, v = floor(face->v[i] * 65536 + 0.5) / 65536;
            Corner corner = { face->corner[i], (int)face->paint, u, v, f, i };
            corners[count++] = corner;
        }
    }
    qsort(corners, (size_t)count, sizeof *corners, corner_order);
    return count;
}

void piece_grab(Piece *piece, int corners)
{
    piece->position = grab(NULL, corners, (int)sizeof(V3));
    piece->normal = grab(NULL, corners, (int)sizeof(V3));
    piece->colour = grab(NULL, corners, (int)sizeof(V3));
    piece->texture = grab(NULL, 2 * corners, (int)sizeof(double));
    piece->grip = grab(NULL, corners, (int)sizeof(Grip));
    piece->indices = grab(NULL, corners / 4 * 6, (int)sizeof(uint32_t));
}

static void add_vertex(Piece *piece, const Cage *surface, const V3 *normals, const double *open, const Corner *corner)
{
    int n = piece->count++;
    const CageVertex *vertex = &surface->vertices[corner->vertex];
    piece->position[n] = vertex->at;
    piece->normal[n] = normals[corner->vertex];
    piece->colour[n] = paint_colour((Paint)corner->paint, vertex->at, open[corner->vertex]);
    piece->texture[2 * n] = corner->u;
    piece->texture[2 * n + 1] = corner->v;
    piece->grip[n] = grip_of(&vertex->hold);
}

static void add_face(Piece *piece, const uint32_t corner[4])
{
    static const int order[6] = { 0, 1, 2, 0, 2, 3 };
    for (int i = 0; i < 6; i++) {
        piece->indices[piece->index_count++] = corner[order[i]];
    }
}

Piece piece_build(const Cage *surface, const V3 *normals, const double *open, int material)
{
    Piece piece = { 0 };
    Corner *corners = grab(NULL, 4 * surface->face_count, (int)sizeof *corners);
    uint32_t *vertex_of = grab(NULL, 4 * surface->face_count, (int)sizeof *vertex_of);
    int count = collect_corners(surface, material, corners);
    piece_grab(&piece, count);
    for (int i = 0; i < count; i++) {
        if (i == 0 || corner_agreement(&corners[i - 1], &corners[i])) {
            add_vertex(&piece, surface, normals, open, &corners[i]);
        }
        vertex_of[4 * corners[i].face + corners[i].corner] = (uint32_t)piece.count - 1;
    }
    for (int f = 0; f < surface->face_count; f++) {
        if (paint_material(surface->faces[f].paint) == material) {
            add_face(&piece, &vertex_of[4 * f]);
        }
    }
    free(corners);
    free(vertex_of);
    return piece;
}

Body body_build(void)
{
    Body body;
    Cage surface = body_surface();
    V3 *normals = surface_normals(&surface);
    double *open = ambient_bake(&surface, normals);
    for (int i = 0; i < MATERIAL_COUNT; i++) {
        body.pieces[i] = piece_build(&surface, normals, open, i);
    }
    free(normals);
    free(open);
    cage_free(&surface);
    return body;
}

void piece_free(Piece *piece)
{
    free(piece->position);
    free(piece->normal);
    free(piece->colour);
    free(piece->texture);
    free(piece->grip);
    free(piece->indices);
}

void body_free(Body *body)
{
    for (int i = 0; i < MATERIAL_COUNT; i++) {
        piece_free(&body->pieces[i]);
    }
}
