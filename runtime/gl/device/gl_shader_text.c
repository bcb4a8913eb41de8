/* gl_shader_text.c: GLSL files by name. tools/embed made the strings. */
#include "core/base/name_internal.h"
#include "noh/gl_device.h"

#include <stddef.h>

#include "core/base/assert_internal.h"
#include "shaders.gen.h"

const char *noh_gl_shader_text(const char *name)
{
    static const struct {
        const char *name, *text;
    } texts[] = { { "common_delta.glsl", noh_shader_common_delta_glsl },
                  { "common_walk.glsl", noh_shader_common_walk_glsl },
                  { "common_layers.glsl", noh_shader_common_layers_glsl },
                  { "common_attributes.glsl", noh_shader_common_attributes_glsl },
                  { "common_skin.glsl", noh_shader_common_skin_glsl },
                  { "common_face.glsl", noh_shader_common_face_glsl },
                  { "common_transfer.glsl", noh_shader_common_transfer_glsl },
                  { "common_vertex.glsl", noh_shader_common_vertex_glsl },
                  { "common_fade.glsl", noh_shader_common_fade_glsl },
                  { "common_fragment.glsl", noh_shader_common_fragment_glsl },
                  { "common_environment.glsl", noh_shader_common_environment_glsl },
                  { "common_wrinkle.glsl", noh_shader_common_wrinkle_glsl },
                  { "common_material.glsl", noh_shader_common_material_glsl },
                  { "common_complexion.glsl", noh_shader_common_complexion_glsl },
                  { "common_scatter.glsl", noh_shader_common_scatter_glsl },
                  { "common_eye.glsl", noh_shader_common_eye_glsl },
                  { "common_light.glsl", noh_shader_common_light_glsl } };
    NOH_ASSERT(name);
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        if (noh_names_equal(name, texts[i].name)) {
            return texts[i].text;
        }
    }
    return NULL;
}
