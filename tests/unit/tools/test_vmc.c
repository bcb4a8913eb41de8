/* A captured person (tools/noh/capture): packets of OSC as its specification has them, and any other bytes; the VMC
 * protocol's messages; its bones on skeletons of other axes, proportions and names. */
#include "capture/osc.h"
#include "capture/vmc.h"
#include "capture/vmc_rig.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "support/support.h"

/* ---- packets ---- */

typedef struct packet {
    uint8_t bytes[4096];
    size_t count;
} packet;

static void put_text(packet *p, const char *text)
{
    const size_t size = (strlen(text) + 4u) & ~(size_t)3u;
    memset(p->bytes + p->count, 0, size);
    memcpy(p->bytes + p->count, text, strlen(text));
    p->count += size;
}

static void put_int(packet *p, uint32_t n)
{
    for (int i = 3; i >= 0; i--) p->bytes[p->count++] = (uint8_t)(n >> 8 * i);
}

static void put_float(packet *p, float f)
{
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    put_int(p, bits);
}

/* types: as OSC has them, of texts and floats; the texts first. */
static void put_message(packet *p, const char *address, const char *types, const char *text, const float *numbers)
{
    put_text(p, address);
    put_text(p, types);
    for (const char *t = types + 1; *t; t++) {
        if (*t == 's') put_text(p, text);
        if (*t == 'f') put_float(p, *numbers++);
    }
}

static size_t begin_element(packet *p)
{
    put_int(p, 0);
    return p->count;
}

static void end_element(packet *p, size_t from)
{
    packet size = { { 0 }, 0 };
    put_int(&size, (uint32_t)(p->count - from));
    memcpy(p->bytes + from - 4, size.bytes, 4);
}

static void begin_bundle(packet *p)
{
    put_text(p, "#bundle");
    put_int(p, 0);
    put_int(p, 1);
}

static void put_bone(packet *p, const char *bone, const float numbers[7])
{
    const size_t from = begin_element(p);
    put_message(p, "/VMC/Ext/Bone/Pos", ",sfffffff", bone, numbers);
    end_element(p, from);
}

static void every_type_is_read(void **state)
{
    packet p = { { 0 }, 0 };
    osc_reader r;
    osc_message m;
    const char *text = NULL;
    float n[2];
    (void)state;
    put_text(&p, "/a/b");
    put_text(&p, ",sifhdTFNb");
    put_text(&p, "four");
    put_int(&p, (uint32_t)-7);
    put_float(&p, 1.5f);
    put_int(&p, UINT32_MAX), put_int(&p, (uint32_t)-9); /* h */
    put_int(&p, 0x40040000u), put_int(&p, 0);           /* d: 2.5 */
    put_int(&p, 3), put_text(&p, "xyz");                /* b */
    osc_begin(&r, p.bytes, p.count);
    assert_int_equal(osc_next(&r, &m), OSC_MESSAGE);
    assert_string_equal(m.address, "/a/b");
    assert_int_equal(m.count, 9);
    assert_true(osc_text(&m, 0, &text));
    assert_string_equal(text, "four");
    assert_false(osc_text(&m, 1, &text));
    assert_true(osc_numbers(&m, 1, 2, n));
    assert_true(n[0] == -7.0f && n[1] == 1.5f);
    assert_true(osc_numbers(&m, 3, 2, n));
    assert_true(n[0] == -9.0f && n[1] == 2.5f);
    assert_true(osc_numbers(&m, 5, 2, n));
    assert_true(n[0] == 1.0f && n[1] == 0.0f);
    assert_false(osc_numbers(&m, 6, 2, n));
    assert_false(osc_numbers(&m, 8, 2, n));
    assert_int_equal(osc_next(&r, &m), OSC_END);
}

static void bundles_hold_bundles(void **state)
{
    packet p = { { 0 }, 0 };
    osc_reader r;
    osc_message m;
    size_t outer;
    (void)state;
    begin_bundle(&p);
    outer = begin_element(&p);
    begin_bundle(&p);
    for (int i = 0; i < 2; i++) {
        const size_t from = begin_element(&p);
        put_message(&p, i ? "/two" : "/one", ",", NULL, NULL);
        end_element(&p, from);
    }
    end_element(&p, outer);
    outer = begin_element(&p);
    put_text(&p, "no address");
    end_element(&p, outer);
    outer = begin_element(&p);
    put_text(&p, "/three");
    end_element(&p, outer);
    osc_begin(&r, p.bytes, p.count);
    assert_int_equal(osc_next(&r, &m), OSC_MESSAGE);
    assert_string_equal(m.address, "/one");
    assert_int_equal(osc_next(&r, &m), OSC_MESSAGE);
    assert_string_equal(m.address, "/two");
    assert_int_equal(osc_next(&r, &m), OSC_DAMAGED);
    assert_int_equal(osc_next(&r, &m), OSC_MESSAGE);
    assert_string_equal(m.address, "/three");
    assert_int_equal(osc_next(&r, &m), OSC_END);
    assert_int_equal(osc_next(&r, &m), OSC_END);
}

static void too_deep_a_bundle_is_damage(void **state)
{
    packet p = { { 0 }, 0 };
    osc_reader r;
    osc_message m;
    size_t from[OSC_DEPTH_MAX + 2];
    (void)state;
    for (size_t i = 0; i < OSC_DEPTH_MAX + 2; i++) {
        from[i] = i ? begin_element(&p) : 0;
        begin_bundle(&p);
    }
    for (size_t i = OSC_DEPTH_MAX + 1; i > 0; i--) end_element(&p, from[i]);
    osc_begin(&r, p.bytes, p.count);
    assert_int_equal(osc_next(&r, &m), OSC_DAMAGED);
    assert_int_equal(osc_next(&r, &m), OSC_END);
}

/* Bytes behind the last element that are no size: by how much the bundle is longer than what it holds. */
static void a_bundle_that_ends_in_a_size(void **state)
{
    (void)state;
    for (size_t more = 1; more <= 4; more++) {
        packet p = { { 0 }, 0 };
        osc_reader r;
        osc_message m;
        size_t from;
        begin_bundle(&p);
        from = begin_element(&p);
        put_text(&p, "/one");
        end_element(&p, from);
        memset(p.bytes + p.count, 0xff, sizeof p.bytes - p.count);
        memcpy(p.bytes + p.count + 4, "#bundle", 8); /* past the end */
        osc_begin(&r, p.bytes, p.count + more);
        assert_int_equal(osc_next(&r, &m), OSC_MESSAGE);
        assert_int_equal(osc_next(&r, &m), OSC_DAMAGED);
        assert_int_equal(osc_next(&r, &m), OSC_END);
        assert_int_equal(r.at, p.count + more);
    }
}

/* ---- the protocol ---- */

static void put_value(packet *p, const char *name, float weight)
{
    const size_t from = begin_element(p);
    put_message(p, "/VMC/Ext/Blend/Val", ",sf", name, &weight);
    end_element(p, from);
}

static void expressions_wait_for_apply(void **state)
{
    static vmc v;
    packet p = { { 0 }, 0 };
    size_t from;
    (void)state;
    memset(&v, 0, sizeof v);
    begin_bundle(&p);
    put_value(&p, "Joy", 0.25f);
    put_value(&p, "A", 7.0f);
    put_value(&p, "jawOpen", NAN);
    vmc_take(&v, p.bytes, p.count);
    assert_int_equal(v.value_count, 2);
    assert_true(v.values[0].value == 0.0f);
    assert_int_equal(v.bad, 1);
    p.count = 0;
    begin_bundle(&p);
    from = begin_element(&p);
    put_message(&p, "/VMC/Ext/Blend/Apply", ",", NULL, NULL);
    end_element(&p, from);
    from = begin_element(&p);
    put_message(&p, "/VMC/Ext/OK", ",f", NULL, &(float){ 1.0f });
    end_element(&p, from);
    vmc_take(&v, p.bytes, p.count);
    assert_true(v.values[0].value == 0.25f && v.values[1].value == 1.0f);
    assert_int_equal(v.packets, 2);
    assert_int_equal(v.messages, 4);
    assert_int_equal(v.unread, 1);
    assert_int_equal(v.bad, 1);
}

static void wrong_messages_are_counted(void **state)
{
    static const float none[7] = { 0 }, turned[7] = { 1, 2, 3, 0, 0, 0, 2 }, far[7] = { 1e9f, 0, 0, 0, 0, 0, 1 };
    static vmc v;
    packet p = { { 0 }, 0 };
    (void)state;
    memset(&v, 0, sizeof v);
    begin_bundle(&p);
    put_bone(&p, "Tail", turned); /* no bone of the protocol */
    put_bone(&p, "Hips", none);   /* no rotation */
    put_bone(&p, "Hips", far);
    put_bone(&p, "Head", turned);
    vmc_take(&v, p.bytes, p.count);
    assert_int_equal(v.bad, 3);
    assert_false(v.bones[VMC_HIPS].is_known);
    assert_true(v.bones[10].is_known && v.bones[10].rotation[3] == 1.0f && v.bones[10].position[2] == 3.0f);
    for (uint32_t i = 0; i < 2 * VMC_VALUES_MAX; i++) {
        char name[16];
        p.count = 0;
        begin_bundle(&p);
        (void)snprintf(name, sizeof name, "v%u", i);
        put_value(&p, name, 0.5f);
        vmc_take(&v, p.bytes, p.count);
    }
    assert_int_equal(v.value_count, VMC_VALUES_MAX);
    assert_int_equal(v.bad, 3 + VMC_VALUES_MAX);
}

/* Cut and damaged in every way; each lies in a block of its own size, so that sanitizers see what is read past it. */
static void any_bytes_are_read(void **state)
{
    static const float numbers[7] = { 1, 2, 3, 0, 0, 0, 1 };
    static vmc v;
    packet p = { { 0 }, 0 };
    uint32_t seed = 1, total = 0;
    (void)state;
    begin_bundle(&p);
    put_bone(&p, "Hips", numbers);
    put_value(&p, "Joy", 1.0f);
    put_bone(&p, "Head", numbers);
    for (uint32_t round = 0; round < 60000u; round++) {
        const size_t count = round <= p.count ? round : p.count;
        uint8_t *bytes = malloc(count + !count);
        assert_non_null(bytes);
        memcpy(bytes, p.bytes, count);
        for (uint32_t i = 0; round > p.count && i < 1u + round % 3u; i++) {
            seed = seed * 1664525u + 1013904223u;
            bytes[(seed >> 8) % count] = round % 5u ? (uint8_t)(seed >> 24) : (uint8_t)(seed >> 24 & 3u);
        }
        memset(&v, 0, sizeof v);
        vmc_take(&v, bytes, count);
        total += v.messages + v.bad;
        assert_true(v.messages + v.bad <= count / 4u + 1u);
        free(bytes);
    }
    assert_true(total > 60000u);
}

/* ---- skeletons ---- */

enum {
    ROOT,
    HIPS,
    UPPER_LEG_L,
    LOWER_LEG_L,
    FOOT_L,
    UPPER_LEG_R,
    UPPER_ARM_L,
    LOWER_ARM_L,
    HAND_L,
    UPPER_ARM_R,
    LOWER_ARM_R,
    HAND_R,
    JOINTS
};
static const uint16_t parents[JOINTS] = { NOH_JOINT_ROOT, ROOT,        HIPS, LOWER_LEG_L - 1, LOWER_LEG_L, HIPS, HIPS,
                                          UPPER_ARM_L,    LOWER_ARM_L, HIPS, UPPER_ARM_R,     LOWER_ARM_R };

/* In a T, facing +z, in model space. */
static const float places[JOINTS][3] = {
    { 0, 0, 0 },       { 0, 1, 0 },       { 0.1f, 1, 0 },    { 0.1f, 0.5f, 0 },  { 0.1f, 0.1f, 0 },  { -0.1f, 1, 0 },
    { 0.2f, 1.5f, 0 }, { 0.5f, 1.5f, 0 }, { 0.8f, 1.5f, 0 }, { -0.2f, 1.5f, 0 }, { -0.5f, 1.5f, 0 }, { -0.8f, 1.5f, 0 }
};
static const char *const mixamo[JOINTS] = { "Armature",           "mixamorig:Hips",         "mixamorig:LeftUpLeg",
                                            "mixamorig:LeftLeg",  "mixamorig:LeftFoot",     "mixamorig:RightUpLeg",
                                            "mixamorig:LeftArm",  "mixamorig:LeftForeArm",  "mixamorig:LeftHand",
                                            "mixamorig:RightArm", "mixamorig:RightForeArm", "mixamorig:RightHand" };

/* A skeleton with these places; each joint's axes are turned at random, and it is scaled and turned about y as a whole. */
static void make_skeleton(noh_transform *bind, const float at[JOINTS][3], float scale, int back, uint32_t seed)
{
    float turned[JOINTS][4];
    for (uint32_t j = 0; j < JOINTS; j++) {
        float way[3], above[4] = { 0, 0, 0, 1 }, inverse[4];
        for (int i = 0; i < 4; i++) {
            seed = seed * 1664525u + 1013904223u;
            turned[j][i] = (float)(seed >> 8) / 8388608.0f - 1.0f;
        }
        noh_quat_normalize(turned[j]);
        for (int i = 0; i < 3; i++) {
            way[i] = scale * (at[j][i] - (j ? at[parents[j]][i] : 0.0f));
            if (back && i != 1) way[i] = -way[i];
            bind[j].scale[i] = 1.0f;
        }
        if (j) memcpy(above, turned[parents[j]], sizeof above);
        noh_quat_conjugate(above, inverse);
        noh_quat_mul(inverse, turned[j], bind[j].rotation);
        noh_quat_rotate(inverse, way, bind[j].translation);
    }
}

static void place_of(const noh_transform *local, uint32_t joint, float out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t j = joint; j != NOH_JOINT_ROOT; j = parents[j]) {
        noh_quat_rotate(local[j].rotation, out, out);
        for (int i = 0; i < 3; i++) out[i] += local[j].translation[i];
    }
}

static void expect_place(const noh_transform *local, uint32_t joint, float x, float y, float z)
{
    float at[3];
    place_of(local, joint, at);
    if (fabsf(at[0] - x) + fabsf(at[1] - y) + fabsf(at[2] - z) > 1e-4f)
        fail_msg("joint %u is at %g %g %g", joint, (double)at[0], (double)at[1], (double)at[2]);
}

static void set_bone(vmc *v, uint32_t bone, float px, float py, float pz, float x, float y, float z, float degrees)
{
    const float half = degrees * 0.00872664626f;
    const float b[7] = { px, py, pz, x * sinf(half), y * sinf(half), z * sinf(half), cosf(half) };
    v->bones[bone].is_known = 1;
    memcpy(v->bones[bone].position, b, sizeof v->bones[bone].position);
    memcpy(v->bones[bone].rotation, b + 3, sizeof v->bones[bone].rotation);
}

/* In Unity a positive turn about z lowers the left arm, which is at -x, and about y turns the figure to its right. */
static void bones_turn_as_they_were_sent(void **state)
{
    noh_transform bind[JOINTS], local[JOINTS];
    const noh_skeleton skeleton = { JOINTS, parents, bind, NULL };
    static vmc v;
    vmc_rig rig;
    (void)state;
    for (int back = 0; back < 2; back++) {
        const float s = back ? -2.0f : 2.0f; /* twice as large as the sender, whose legs are 0.9 long */
        memset(&v, 0, sizeof v);
        make_skeleton(bind, places, 2.0f, back, 7);
        memcpy(local, bind, sizeof local);
        vmc_rig_make(&rig, &skeleton, mixamo);
        assert_int_equal(rig.bone_count, JOINTS - 1);
        vmc_rig_pose(&rig, &v, local);
        assert_memory_equal(local, bind, sizeof local); /* nothing was received */
        set_bone(&v, VMC_UPPER_ARM, -0.2f, 0, 0, 0, 0, 1, 90);
        set_bone(&v, VMC_LOWER_ARM, -0.3f, 0, 0, 0, 0, 1, 0);
        vmc_rig_pose(&rig, &v, local);
        expect_place(local, HAND_L, s * 0.2f, 2.0f * 0.9f, 0);
        expect_place(local, HAND_R, s * -0.8f, 2.0f * 1.5f, 0);
        set_bone(&v, VMC_LOWER_ARM, -0.3f, 0, 0, 0, 1, 0, 90);
        vmc_rig_pose(&rig, &v, local); /* its elbow bends: forwards before the arm was lowered about the shoulder */
        expect_place(local, HAND_L, s * 0.2f, 2.0f * 1.2f, s * 0.3f);
        set_bone(&v, VMC_LOWER_LEG, 0, -0.5f, 0, 0, 0, 1, 0);
        set_bone(&v, VMC_FOOT, 0, -0.4f, 0, 0, 0, 1, 0);
        set_bone(&v, VMC_HIPS, 0.5f, 0.75f, 1, 0, 1, 0, 90); /* to its right, which is +x in Unity */
        vmc_rig_pose(&rig, &v, local);
        expect_place(local, HIPS, s * -0.5f, 2.0f * 0.75f, s * 1.0f);
        expect_place(local, HAND_R, s * -0.5f, 2.0f * 1.25f, s * 0.2f);
        set_bone(&v, VMC_HIPS, 0, 1, 0, 0, 1, 0, 0);
        v.root = v.bones[VMC_HIPS];
        v.root.position[2] = 3.0f;
        v.root.position[1] = 0.0f;
        vmc_rig_pose(&rig, &v, local);
        expect_place(local, HIPS, 0, 2.0f, s * 3.0f);
    }
}

/* Arms at 45 degrees rise to a T before the bone turns; a sender's T is the model's. */
static void arms_that_hang_are_raised(void **state)
{
    noh_transform bind[JOINTS], local[JOINTS];
    const noh_skeleton skeleton = { JOINTS, parents, bind, NULL };
    float at[JOINTS][3];
    static vmc v;
    vmc_rig rig;
    (void)state;
    memcpy(at, places, sizeof at);
    for (uint32_t side = 0; side < 2; side++) {
        for (uint32_t j = 1; j < 3; j++) {
            const uint32_t joint = (side ? UPPER_ARM_R : UPPER_ARM_L) + j;
            at[joint][0] = (side ? -1.0f : 1.0f) * (0.2f + 0.2f * (float)j);
            at[joint][1] = 1.5f - 0.2f * (float)j;
        }
    }
    make_skeleton(bind, (const float(*)[3])at, 1.0f, 0, 3);
    memcpy(local, bind, sizeof local);
    memset(&v, 0, sizeof v);
    vmc_rig_make(&rig, &skeleton, mixamo);
    set_bone(&v, VMC_UPPER_ARM, 0, 0, 0, 0, 0, 1, 0);
    set_bone(&v, VMC_LOWER_ARM, 0, 0, 0, 0, 0, 1, 0);
    vmc_rig_pose(&rig, &v, local);
    expect_place(local, HAND_L, 0.2f + 0.4f * sqrtf(2.0f), 1.5f, 0);
    expect_place(local, HAND_R, -0.6f, 1.1f, 0); /* it was not sent: it stays */
}

/* VRM 1.0 calls a thumb's first bone its metacarpal; Unity, and VRM 0.0, its proximal. */
static void thumbs_of_both_versions(void **state)
{
    static const uint16_t chain[3] = { NOH_JOINT_ROOT, 0, 1 };
    static const char *const names[2][3] = {
        { "leftThumbMetacarpal", "leftThumbProximal", "leftThumbDistal" },
        { "leftThumbProximal", "leftThumbIntermediate", "leftThumbDistal" },
    };
    noh_transform bind[3];
    const noh_skeleton skeleton = { 3, chain, bind, NULL };
    vmc_rig rig;
    (void)state;
    memset(bind, 0, sizeof bind);
    for (uint32_t j = 0; j < 3; j++)
        bind[j].rotation[3] = bind[j].scale[0] = bind[j].scale[1] = bind[j].scale[2] = 1.0f;
    for (int i = 0; i < 2; i++) {
        vmc_rig_make(&rig, &skeleton, names[i]);
        assert_int_equal(rig.bone_count, 3);
        for (uint32_t j = 0; j < 3; j++) {
            static const char *const wanted[3] = { "LeftThumbProximal", "LeftThumbIntermediate", "LeftThumbDistal" };
            assert_string_equal(vmc_bone_names[rig.bones[j].bone], wanted[rig.bones[j].joint]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_is_read),          cmocka_unit_test(bundles_hold_bundles),
        cmocka_unit_test(too_deep_a_bundle_is_damage), cmocka_unit_test(a_bundle_that_ends_in_a_size),
        cmocka_unit_test(expressions_wait_for_apply),  cmocka_unit_test(wrong_messages_are_counted),
        cmocka_unit_test(any_bytes_are_read),          cmocka_unit_test(bones_turn_as_they_were_sent),
        cmocka_unit_test(arms_that_hang_are_raised),   cmocka_unit_test(thumbs_of_both_versions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
