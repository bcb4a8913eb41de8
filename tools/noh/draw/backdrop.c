/* backdrop.c: the picture's background as light. */
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"
#include "gl/gl_program.h"
#include "tool_shaders.gen.h"

#define PIECES_MAX 8u

int backdrop_open(backdrop *b, gpu *g)
{
    static const char *const samplers[] = { "noh_environment" };
    static const char precision[] = "precision highp float;\n#define NOH_LIT\n";
    const char *pieces[PIECES_MAX] = { precision, noh_gl_shader_text("common_fade.glsl"),
                                       noh_gl_shader_text("common_fragment.glsl"),
                                       noh_gl_shader_text("common_environment.glsl") };
    noh_gl_source fragment = noh_shader_backdrop_frag;
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(b, 0, sizeof *b);
    memset(&desc, 0, sizeof desc);
    for (uint32_t i = 0; i < fragment.piece_count && 4u + i < PIECES_MAX; i++) pieces[4u + i] = fragment.pieces[i];
    fragment.piece_count += 4u;
    fragment.pieces = pieces;
    desc.name = "backdrop";
    desc.vertex = &noh_shader_backdrop_vert;
    desc.fragment = &fragment;
    desc.samplers = samplers;
    desc.sampler_count = 1;
    if (noh_gl_program_create(&g->gl, &desc, &b->program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("backdrop", &error);
    }
    g->gl.GenVertexArrays(1, &b->vertex_array);
    b->g = g;
    return 0;
}

void backdrop_close(backdrop *b)
{
    b->g->gl.DeleteVertexArrays(1, &b->vertex_array);
    noh_gl_program_delete(&b->g->gl, NULL, &b->program);
    memset(b, 0, sizeof *b);
}

/* Rays through the lower left corner, and what a width and a height add, of the length at which they reach one plane.
 */
static void corner_rays(const noh_gl_camera *camera, float rays[3][4])
{
    static const float corners[3][2] = { { -0.5f, 0.5f }, { 0.5f, 0.5f }, { -0.5f, -0.5f } };
    const noh_stage_view view = figure_view(camera, 1);
    float origin[3], forward[3] = { 0.0f, 0.0f, -1.0f };
    memset(rays, 0, 12 * sizeof(float));
    (void)noh_view_ray(&view, 0.0f, 0.0f, 1, 1, origin, forward);
    for (int i = 0; i < 3; i++) {
        float d[3] = { 0.0f, 0.0f, -1.0f }, along;
        (void)noh_view_ray(&view, corners[i][0], corners[i][1], 1, 1, origin, d);
        along = d[0] * forward[0] + d[1] * forward[1] + d[2] * forward[2];
        for (int k = 0; k < 3; k++) rays[i][k] = d[k] / along - (i ? rays[0][k] : 0.0f);
    }
}

void backdrop_draw(const backdrop *b, const lighting *l, const noh_gl_light *on_gl, const noh_gl_camera *camera)
{
    const noh_gl_api *gl = &b->g->gl;
    float rows[NOH_LIGHTING_ROWS][4], rays[3][4];
    noh_lighting_pack(&l->told, 0, rows);
    corner_rays(camera, rays);
    gl->UseProgram(b->program);
    gl->Uniform4fv(gl->GetUniformLocation(b->program, "noh_lighting"), (GLsizei)NOH_LIGHTING_ROWS, rows[0]);
    gl->Uniform4fv(gl->GetUniformLocation(b->program, "u_rays"), 3, rays[0]);
    gl->Uniform4f(gl->GetUniformLocation(b->program, "u_kind"), l->background == BACKGROUND_LIGHT ? 1.0f : 0.0f, 0.0f,
                  0.0f, 0.0f);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_CUBE_MAP, on_gl->cube.name);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    gl->Disable(GL_CULL_FACE);
    gl->BindVertexArray(b->vertex_array);
    gl->DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    gl->BindVertexArray(0);
    gl->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    gl->UseProgram(0);
}
