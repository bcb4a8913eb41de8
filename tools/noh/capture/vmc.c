#include "vmc.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "capture/osc.h"

/* In the order of Unity's HumanBodyBones. */
const char *const vmc_bone_names[VMC_BONES] = {
    "Hips",
    "LeftUpperLeg",
    "RightUpperLeg",
    "LeftLowerLeg",
    "RightLowerLeg",
    "LeftFoot",
    "RightFoot",
    "Spine",
    "Chest",
    "Neck",
    "Head",
    "LeftShoulder",
    "RightShoulder",
    "LeftUpperArm",
    "RightUpperArm",
    "LeftLowerArm",
    "RightLowerArm",
    "LeftHand",
    "RightHand",
    "LeftToes",
    "RightToes",
    "LeftEye",
    "RightEye",
    "Jaw",
    "LeftThumbProximal",
    "LeftThumbIntermediate",
    "LeftThumbDistal",
    "LeftIndexProximal",
    "LeftIndexIntermediate",
    "LeftIndexDistal",
    "LeftMiddleProximal",
    "LeftMiddleIntermediate",
    "LeftMiddleDistal",
    "LeftRingProximal",
    "LeftRingIntermediate",
    "LeftRingDistal",
    "LeftLittleProximal",
    "LeftLittleIntermediate",
    "LeftLittleDistal",
    "RightThumbProximal",
    "RightThumbIntermediate",
    "RightThumbDistal",
    "RightIndexProximal",
    "RightIndexIntermediate",
    "RightIndexDistal",
    "RightMiddleProximal",
    "RightMiddleIntermediate",
    "RightMiddleDistal",
    "RightRingProximal",
    "RightRingIntermediate",
    "RightRingDistal",
    "RightLittleProximal",
    "RightLittleIntermediate",
    "RightLittleDistal",
    "UpperChest",
};

static vmc_bone *bone_named(vmc *v, const char *name)
{
    for (uint32_t b = 0; b < VMC_BONES; b++) {
        if (strcmp(vmc_bone_names[b], name) == 0) return &v->bones[b];
    }
    return NULL;
}

/* "name" x y z qx qy qz qw; of the root may follow more. A rotation of any length but 0. */
static int take_bone(const osc_message *m, vmc_bone *out)
{
    float n[7], length;
    if (!out || !osc_numbers(m, 1, 7, n)) return 0;
    length = sqrtf(n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6]);
    if (!(length > 1e-3f)) return 0;
    memcpy(out->position, n, sizeof out->position);
    for (int i = 0; i < 4; i++) out->rotation[i] = n[3 + i] / length;
    out->is_known = 1;
    return 1;
}

static vmc_value *value_named(vmc *v, const char *name)
{
    vmc_value *added = &v->values[v->value_count];
    for (uint32_t i = 0; i < v->value_count; i++) {
        if (strcmp(v->values[i].name, name) == 0) return &v->values[i];
    }
    if (v->value_count == VMC_VALUES_MAX || !name[0] || strlen(name) >= sizeof added->name) return NULL;
    memset(added, 0, sizeof *added);
    (void)snprintf(added->name, sizeof added->name, "%s", name);
    v->value_count++;
    return added;
}

static int take_value(vmc *v, const osc_message *m, const char *name)
{
    float weight;
    vmc_value *value = osc_numbers(m, 1, 1, &weight) ? value_named(v, name) : NULL;
    if (!value) return 0;
    value->next = weight < 0.0f ? 0.0f : weight > 1.0f ? 1.0f : weight;
    return 1;
}

/* Returns 0 where a message is wrong. */
static int take_message(vmc *v, const osc_message *m)
{
    const char *name = "";
    const int has_name = osc_text(m, 0, &name);
    if (strcmp(m->address, "/VMC/Ext/Bone/Pos") == 0) return has_name && take_bone(m, bone_named(v, name));
    if (strcmp(m->address, "/VMC/Ext/Root/Pos") == 0) return has_name && take_bone(m, &v->root);
    if (strcmp(m->address, "/VMC/Ext/Blend/Val") == 0) return has_name && take_value(v, m, name);
    if (strcmp(m->address, "/VMC/Ext/Blend/Apply") == 0) {
        for (uint32_t i = 0; i < v->value_count; i++) v->values[i].value = v->values[i].next;
        return 1;
    }
    v->unread++;
    return 1;
}

void vmc_take(vmc *v, const uint8_t *bytes, size_t count)
{
    osc_reader reader;
    osc_message message;
    osc_kind kind;
    v->packets++;
    osc_begin(&reader, bytes, count);
    while ((kind = osc_next(&reader, &message)) != OSC_END) {
        if (kind == OSC_DAMAGED || !take_message(v, &message))
            v->bad++;
        else
            v->messages++;
    }
}
