#include "info_joints.h"

#include <stdio.h>

#include "cli/message.h"
#include "stage/modules/springs_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_motion.h"
#include "noh/modules.h"
#include "noh/pack.h"

void info_print_levels(const noh_pack *pack, uint32_t skeleton)
{
    uint32_t count;
    const uint32_t *levels = noh_pack_joint_levels(pack, skeleton, &count);
    for (uint32_t i = 1; i < count; i++) {
        printf("%s%u", i == 1 ? ", at coarser levels " : i + 1 == count ? " or " : ", ", levels[i]);
    }
}

void info_json_levels(json *j, const noh_pack *pack, uint32_t skeleton)
{
    uint32_t count;
    const uint32_t *levels = noh_pack_joint_levels(pack, skeleton, &count);
    json_open(j, "levels", '[');
    for (uint32_t i = 0; i < count; i++) {
        json_integer(j, NULL, levels[i]);
    }
    json_close(j, ']');
}

static const char *joint_name(const noh_pack *pack, uint32_t skeleton, uint32_t joint)
{
    const char *name = noh_pack_joint_name(pack, skeleton, joint);
    return name ? name : "";
}

static uint32_t depth_of(const noh_skeleton *s, uint32_t joint)
{
    uint32_t depth = 0;
    for (; s->parents[joint] != NOH_JOINT_ROOT; depth++) joint = s->parents[joint];
    return depth;
}

/* Joints have an order of their own (coarser levels use the first ones), so each line names the parent. */
void info_print_joints(const noh_pack *pack, uint32_t skeleton)
{
    noh_skeleton s;
    noh_pack_skeleton_at(pack, skeleton, &s, NULL, NULL);
    for (uint32_t i = 0; i < s.joint_count; i++) {
        printf("  %3u %*s%s", i, (int)(2u * (depth_of(&s, i) % 24u)), "", joint_name(pack, skeleton, i));
        if (s.parents[i] != NOH_JOINT_ROOT) printf(" (%s)", joint_name(pack, skeleton, s.parents[i]));
        printf("\n");
    }
}

void info_json_joints(json *j, const noh_pack *pack, uint32_t skeleton)
{
    noh_skeleton s;
    noh_pack_skeleton_at(pack, skeleton, &s, NULL, NULL);
    json_open(j, "joint_list", '[');
    for (uint32_t i = 0; i < s.joint_count; i++) {
        json_open(j, NULL, '{');
        json_text(j, "name", joint_name(pack, skeleton, i));
        if (s.parents[i] == NOH_JOINT_ROOT) {
            json_null(j, "parent");
        } else {
            json_text(j, "parent", joint_name(pack, skeleton, s.parents[i]));
        }
        json_close(j, '}');
    }
    json_close(j, ']');
}

static double seconds(uint32_t tick)
{
    return tick / (double)NOH_TICKS_PER_SECOND;
}

void info_print_keys(const noh_pack *pack, const noh_pack_clip *clip)
{
    for (uint32_t i = 0; i < clip->header->event_count; i++) {
        printf("    %.4f s '%s'\n", seconds(clip->events[i].tick), noh_pack_string(pack, clip->events[i].name));
    }
    for (uint32_t i = 0; i < clip->header->marker_count; i++) {
        printf("    %.4f s marker '%s'\n", seconds(clip->markers[i].tick),
               noh_pack_string(pack, clip->markers[i].name));
    }
}

static void json_key(json *j, const noh_pack *pack, uint32_t tick, uint32_t name)
{
    json_open(j, NULL, '{');
    json_number(j, "seconds", seconds(tick));
    json_text(j, "name", noh_pack_string(pack, name));
    json_close(j, '}');
}

void info_json_keys(json *j, const noh_pack *pack, const noh_pack_clip *clip)
{
    json_open(j, "event_list", '[');
    for (uint32_t i = 0; i < clip->header->event_count; i++) {
        json_key(j, pack, clip->events[i].tick, clip->events[i].name);
    }
    json_close(j, ']');
    json_open(j, "marker_list", '[');
    for (uint32_t i = 0; i < clip->header->marker_count; i++) {
        json_key(j, pack, clip->markers[i].tick, clip->markers[i].name);
    }
    json_close(j, ']');
}

void info_print_springs(const noh_pack *pack, uint32_t skeleton)
{
    noh_springs_desc d;
    size_t state, scratch;
    if (!noh_springs_of_pack(pack, skeleton, &d)) return;
    noh_springs_measure(&d, &state, &scratch);
    printf("  springs: %u joint%s in %u chain%s, %u collider%s, %zu bytes an actor\n", d.row_count, plural(d.row_count),
           d.chain_count, plural(d.chain_count), d.collider_count, plural(d.collider_count), state);
    for (uint32_t i = 0; i < d.chain_count; i++) {
        const noh_spring_chain *c = &d.chains[i];
        const noh_spring_row *row = &d.rows[c->first_row];
        printf("    %-24s %3u joint%s, stiffness %.3g, drag %.3g, gravity %.3g %.3g %.3g, radius %.3g m\n",
               joint_name(pack, skeleton, row->joint), c->row_count, plural(c->row_count), (double)row->stiffness,
               (double)row->drag, (double)row->gravity[0], (double)row->gravity[1], (double)row->gravity[2],
               (double)row->radius);
    }
    for (uint32_t i = 0; i < d.collider_count; i++) {
        printf("    %-24s collider, radius %.3g m\n", joint_name(pack, skeleton, d.colliders[i].joint),
               (double)d.colliders[i].radius);
    }
}

static void json_chain(json *j, const noh_pack *pack, uint32_t skeleton, const noh_springs_desc *d, uint32_t chain)
{
    const noh_spring_chain *c = &d->chains[chain];
    json_open(j, NULL, '{');
    json_open(j, "joints", '[');
    for (uint32_t i = c->first_row; i < c->first_row + c->row_count; i++) {
        json_text(j, NULL, joint_name(pack, skeleton, d->rows[i].joint));
    }
    json_close(j, ']');
    json_number(j, "stiffness", (double)d->rows[c->first_row].stiffness);
    json_number(j, "drag", (double)d->rows[c->first_row].drag);
    json_open(j, "collides", '[');
    for (uint32_t i = 0; i < d->collider_count; i++) {
        if (c->collides >> i & 1u) json_integer(j, NULL, i);
    }
    json_close(j, ']');
    json_close(j, '}');
}

void info_json_springs(json *j, const noh_pack *pack, uint32_t skeleton)
{
    noh_springs_desc d;
    size_t state, scratch;
    if (!noh_springs_of_pack(pack, skeleton, &d)) {
        json_null(j, "springs");
        return;
    }
    noh_springs_measure(&d, &state, &scratch);
    json_open(j, "springs", '{');
    json_integer(j, "bytes_per_actor", state);
    json_open(j, "chains", '[');
    for (uint32_t i = 0; i < d.chain_count; i++) json_chain(j, pack, skeleton, &d, i);
    json_close(j, ']');
    json_open(j, "colliders", '[');
    for (uint32_t i = 0; i < d.collider_count; i++) {
        json_open(j, NULL, '{');
        json_text(j, "joint", joint_name(pack, skeleton, d.colliders[i].joint));
        json_number(j, "radius_m", (double)d.colliders[i].radius);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_close(j, '}');
}

/* Centimetres per unit of a clip's errors, which are metres where it has no skeleton. */
static double unit_cm(const noh_pack *pack, const noh_pack_clip *clip)
{
    noh_skeleton skeleton;
    const noh_skeleton_header *header;
    return noh_pack_skeleton_at(pack, clip->header->skeleton, &skeleton, &header, NULL) == NOH_OK
               ? (double)header->unit_cm
               : 100.0;
}

void info_print_errors(const noh_pack *pack, const noh_pack_clip *clip)
{
    const noh_clip_header *h = clip->header;
    const double unit = unit_cm(pack, clip);
    uint32_t count;
    const uint32_t *levels = noh_pack_joint_levels(pack, h->skeleton, &count);
    printf("  if played with less: off by at most %.3g, %.3g, %.3g cm at 30, 15, 8 Hz", unit * (double)h->update_rate_error[1],
           unit * (double)h->update_rate_error[2], unit * (double)h->update_rate_error[3]);
    for (uint32_t i = 1; i < h->joint_error_count; i++) {
        printf("%s %.3g", i == 1 ? ";" : ",", unit * (double)clip->joint_errors[i]);
    }
    for (uint32_t i = 1; i < h->joint_error_count; i++) {
        printf("%s %u", i == 1 ? " cm with" : ",", levels[i]);
    }
    if (h->joint_error_count > 1) {
        fputs(h->joint_error_count == 2 && levels[1] == 1 ? " joint" : " joints", stdout);
    }
    if (h->error_shell > 0.0f) {
        printf(" (%.3g cm from the joints)", unit * (double)h->error_shell);
    }
    printf("\n");
}

void info_json_errors(json *j, const noh_pack *pack, const noh_pack_clip *clip)
{
    const noh_clip_header *h = clip->header;
    const double unit = unit_cm(pack, clip);
    json_open(j, "rate_errors_cm", '[');
    for (uint32_t i = 0; i < NOH_CLIP_UPDATE_RATES; i++) {
        json_number(j, NULL, unit * (double)h->update_rate_error[i]);
    }
    json_close(j, ']');
    json_open(j, "joint_errors_cm", '[');
    for (uint32_t i = 0; i < h->joint_error_count; i++) {
        json_number(j, NULL, unit * (double)clip->joint_errors[i]);
    }
    json_close(j, ']');
    json_number(j, "error_shell_cm", unit * (double)h->error_shell);
}
