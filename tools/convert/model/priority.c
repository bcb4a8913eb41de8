#include "priority.h"

#include <stdlib.h>
#include <string.h>

int priority_assign(model *m, const char *assignment, model_error *error)
{
    const char *equals = strrchr(assignment, '=');
    const size_t length = equals ? (size_t)(equals - assignment) : 0u;
    char *end = NULL;
    const long priority = equals ? strtol(equals + 1, &end, 10) : 0;
    int found = 0;
    if (!equals || end == equals + 1 || *end || priority < -128 || priority > 127) {
        return model_fail(error, "", "--priority must be MATERIAL=N, N from -128 to 127, not '%.80s'", assignment);
    }
    for (uint32_t i = 0; i < m->material_count; i++) {
        const char *name = m->materials[i].name;
        if (strlen(name) == length && memcmp(name, assignment, length) == 0) {
            m->materials[i].priority = (int16_t)priority;
            found = 1;
        }
    }
    return found ? 0
                 : model_fail(error, "", "--priority: no material is named '%.*s'; noh info lists a pack's materials",
                              (int)length, assignment);
}
