#include "tint.h"

#include <string.h>

#include "noh/format.h"
#include "surface_kind.h"

static int is_of_a_body(uint32_t surface)
{
    return surface == NOH_SURFACE_SKIN || surface == NOH_SURFACE_EYE || surface == NOH_SURFACE_TEETH;
}

int tint_is_taken(const model_material *m)
{
    if (m->tint != MODEL_TINT_BY_SURFACE) return m->tint == MODEL_TINT_ON;
    return !is_of_a_body(m->surface) && !is_of_a_body(surface_kind_of_name(m->name));
}

int tint_assign(model *m, const char *assignment, model_error *error)
{
    const char *equals = strrchr(assignment, '=');
    const size_t length = equals ? (size_t)(equals - assignment) : 0u;
    const int on = equals && strcmp(equals, "=on") == 0;
    int found = 0;
    if (!on && !(equals && strcmp(equals, "=off") == 0)) {
        return model_fail(error, "", "--tint must be MATERIAL=on or MATERIAL=off, not '%.80s'", assignment);
    }
    for (uint32_t i = 0; i < m->material_count; i++) {
        const char *name = m->materials[i].name;
        if (strlen(name) == length && memcmp(name, assignment, length) == 0) {
            m->materials[i].tint = on ? MODEL_TINT_ON : MODEL_TINT_OFF;
            found = 1;
        }
    }
    return found ? 0
                 : model_fail(error, "", "--tint: no material is named '%.*s'; noh info lists a pack's materials",
                              (int)length, assignment);
}
