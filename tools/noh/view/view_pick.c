#include "view/view_pick.h"

#include <stdio.h>
#include <string.h>

#include "noh/base.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/pack.h"

/* The world transform of the joint that carries the point, or of its actor. */
static void hook(const view_pick *p, const view_model *m, float matrix[12])
{
    noh_stage *s = m->figure->stage;
    noh_actor_mesh mesh;
    if (p->hit.joint != NOH_NONE && noh_actor_joint(s, p->hit.actor, p->hit.joint, matrix, NULL) == NOH_OK) {
        return;
    }
    memset(matrix, 0, 12 * sizeof *matrix);
    matrix[0] = matrix[5] = matrix[10] = 1.0f;
    for (uint32_t i = 0; noh_actor_mesh_at(s, p->hit.actor, i, &mesh, NULL, NULL) == NOH_OK; i++) {
        if (mesh.mesh == p->hit.mesh) {
            memcpy(matrix, mesh.world, sizeof mesh.world);
            return;
        }
    }
}

/* A point of the world as seen from a matrix of 3 rows of 4, which may scale. */
static void into(const float m[12], const float point[3], float out[3])
{
    float d[3], square[3] = { 0.0f, 0.0f, 0.0f };
    for (int r = 0; r < 3; r++) d[r] = point[r] - m[4 * r + 3];
    for (int c = 0; c < 3; c++) {
        out[c] = 0.0f;
        for (int r = 0; r < 3; r++) {
            out[c] += m[4 * r + c] * d[r];
            square[c] += m[4 * r + c] * m[4 * r + c];
        }
        out[c] = square[c] > 0.0f ? out[c] / square[c] : 0.0f;
    }
}

void view_pick_at(view_pick *p, view_model *m, const orbit *o, float x, float y)
{
    noh_stage_view view;
    noh_gl_camera camera;
    float origin[3], direction[3], matrix[12];
    orbit_camera(o, &camera);
    memset(&view, 0, sizeof view);
    memcpy(view.view_projection, camera.view_projection, sizeof view.view_projection);
    p->is_on = noh_view_ray(&view, x, y, m->canvas.width, m->canvas.height, origin, direction) &&
               noh_stage_pick(m->figure->stage, origin, direction, 1e9f, &p->hit, NULL) == NOH_OK;
    if (!p->is_on) {
        return;
    }
    for (p->kind = 0; m->figure->actors[p->kind].id != p->hit.actor.id;) p->kind++;
    hook(p, m, matrix);
    into(matrix, p->hit.point, p->local);
}

void view_pick_point(const view_pick *p, const view_model *m, float point[3])
{
    float matrix[12];
    hook(p, m, matrix);
    for (int r = 0; r < 3; r++) {
        const float *row = matrix + 4 * r;
        point[r] = row[0] * p->local[0] + row[1] * p->local[1] + row[2] * p->local[2] + row[3];
    }
}

void view_pick_text(const view_pick *p, const view_model *m, char *text, size_t bytes)
{
    const noh_pack *pack = &m->file.pack;
    const char *material = "", *joint = NULL;
    noh_mesh mesh;
    float point[3];
    (void)noh_pack_mesh_at(pack, p->hit.mesh, &mesh, NULL);
    if (mesh.submeshes[p->hit.submesh].material < pack->material_count) {
        material = noh_pack_string(pack, pack->materials[mesh.submeshes[p->hit.submesh].material].name);
    }
    if (p->hit.joint != NOH_NONE) {
        joint = noh_stage_name(m->figure->stage, p->kind, NOH_NAME_JOINT, p->hit.joint);
    }
    view_pick_point(p, m, point);
    snprintf(text, bytes, "mesh '%s', submesh %u '%s', triangle %u, %s%s%s, at %.4g %.4g %.4g", mesh.name,
             p->hit.submesh, material, p->hit.triangle, joint ? "joint '" : "no joint", joint ? joint : "",
             joint ? "'" : "", (double)point[0], (double)point[1], (double)point[2]);
}
