/* plain.h: a program and vertex buffers of the game's own, for own_renderer.c. */
#ifndef NOH_EXAMPLES_PLAIN_H
#define NOH_EXAMPLES_PLAIN_H

#include <stddef.h>

#include <GLES3/gl32.h>

#include "noh/gl_device.h"
#include "noh/pack.h"

static const char plain_vertex[] =
    "#version 300 es\n"
    "layout(location = 0) in vec3 position; layout(location = 1) in vec3 normal; layout(location = 4) in vec4 color;\n"
    "uniform mat4 u_view_projection; uniform vec4 u_world[3]; out vec3 v_normal; out vec4 v_color;\n"
    "void main() {\n"
    "    vec4 p = vec4(position, 1.0);\n"
    "    v_normal = vec3(dot(u_world[0].xyz, normal), dot(u_world[1].xyz, normal), dot(u_world[2].xyz, normal));\n"
    "    v_color = color;\n"
    "    gl_Position = u_view_projection * vec4(dot(u_world[0], p), dot(u_world[1], p), dot(u_world[2], p), 1.0);\n"
    "}\n";
static const char plain_fragment[] =
    "#version 300 es\nprecision highp float;\n"
    "uniform vec4 u_color; uniform vec3 u_light; uniform vec3 u_pixels; in vec3 v_normal; in vec4 v_color; out vec4 o;\n"
    "void main() {\n"
    "    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));\n"
    "    vec4 color = u_color * v_color;\n" /* two draws fade from one level to another, each in its part of the pixels */
    "    if (color.a < u_pixels.z || noise < u_pixels.x || noise >= u_pixels.y) discard;\n"
    "    o = vec4(color.rgb * (0.35 + 0.65 * max(dot(normalize(v_normal), u_light), 0.0)), color.a);\n"
    "}\n";

static GLuint plain_program;

static GLint plain_at(const noh_gl_api *gl, const char *name)
{
    return gl->GetUniformLocation(plain_program, name);
}

/* Make the program and use it, and bind buffers for noh_vertex and indices; 0: it does not link. */
static int plain_make(const noh_gl_api *gl)
{
    const char *texts[2] = { plain_vertex, plain_fragment };
    const GLuint made = gl->CreateProgram();
    GLuint buffers[2];
    GLint linked = 0;
    for (int i = 0; i < 2; i++) {
        const GLuint shader = gl->CreateShader(i ? GL_FRAGMENT_SHADER : GL_VERTEX_SHADER);
        gl->ShaderSource(shader, 1, &texts[i], NULL);
        gl->CompileShader(shader);
        gl->AttachShader(made, shader);
    }
    gl->LinkProgram(made);
    gl->GetProgramiv(made, GL_LINK_STATUS, &linked);
    gl->GenBuffers(2, buffers);
    gl->BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    for (GLuint i = 0; i < 5u; i += i ? 3u : 1u) { /* positions, normals, colours */
        const size_t offsets[5] = { offsetof(noh_vertex, position), offsetof(noh_vertex, normal), 0, 0,
                                    offsetof(noh_vertex, color) };
        gl->EnableVertexAttribArray(i);
        gl->VertexAttribPointer(i, i == 4u ? 4 : 3, GL_FLOAT, GL_FALSE, sizeof(noh_vertex), (const void *)offsets[i]);
    }
    gl->UseProgram(made);
    plain_program = made;
    return linked;
}

#endif
