#define _POSIX_C_SOURCE 200809L
#include "view/view_capture.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cli/message.h"
#include "convert/base/names.h"
#include "convert/base/vrm_expression.h"

#define PACKET_BYTES 65536u
#define PACKETS_MAX 1024u /* in a frame; the others wait */

/* ---- the socket ---- */

static int parse_where(const char *where, struct sockaddr_in *out)
{
    char address[32] = "127.0.0.1";
    const char *colon = strrchr(where, ':'), *port = colon ? colon + 1 : where;
    char *end;
    const unsigned long number = strtoul(port, &end, 10);
    memset(out, 0, sizeof *out);
    out->sin_family = AF_INET;
    out->sin_port = htons((uint16_t)number);
    if (colon && (size_t)(colon - where) < sizeof address)
        (void)snprintf(address, sizeof address, "%.*s", (int)(colon - where), where);
    return *port < '0' || *port > '9' || *end || number > 65535u || inet_pton(AF_INET, address, &out->sin_addr) != 1;
}

static int fail(view_capture *c, const char *where)
{
    const int status = tool_fail("--vmc", "%s cannot be listened at: %s", where, strerror(errno));
    if (c->socket >= 0) (void)close(c->socket);
    return status;
}

/* ---- what moves the model ---- */

static void drive(noh_modifier_work *work)
{
    const view_captured_kind *kind = work->user;
    const view_capture *c = kind->capture;
    const view_model *m = c->linked;
    if (!m) return;
    if (work->skeleton->joint_count && kind->rig.joint_count == work->skeleton->joint_count)
        vmc_rig_pose(&kind->rig, &c->vmc, work->local);
    for (uint32_t t = 0; t < m->target_count; t++) {
        const uint32_t index = m->targets[t].floats[kind->kind];
        if (c->moved[t] && index != NOH_NONE) (void)noh_modifier_set_float(work, index, c->weights[t]);
    }
}

int view_capture_open(view_capture *c, const char *where)
{
    struct sockaddr_in at;
    socklen_t size = sizeof at;
    char address[INET_ADDRSTRLEN];
    memset(c, 0, sizeof *c);
    if (parse_where(where, &at)) {
        return tool_usage("--vmc must be PORT or ADDRESS:PORT, such as 39539 or 0.0.0.0:39539, not '%s'", where);
    }
    c->socket = socket(AF_INET, SOCK_DGRAM, 0);
    if (c->socket < 0 || fcntl(c->socket, F_SETFL, O_NONBLOCK) || bind(c->socket, (struct sockaddr *)&at, sizeof at) ||
        getsockname(c->socket, (struct sockaddr *)&at, &size) ||
        !inet_ntop(AF_INET, &at.sin_addr, address, sizeof address)) {
        return fail(c, where);
    }
    c->is_open = 1;
    (void)snprintf(c->where, sizeof c->where, "%s:%u", address, (unsigned)ntohs(at.sin_port));
    for (uint32_t k = 0; k < NOH_STAGE_KINDS_MAX; k++) {
        c->kinds[k].capture = c;
        c->kinds[k].kind = k;
        c->drivers[k].name = "capture";
        c->drivers[k].modify = drive;
        c->drivers[k].user = &c->kinds[k];
    }
    printf("listens for VMC at %s\n", c->where);
    fflush(stdout);
    return 0;
}

void view_capture_forget(view_capture *c)
{
    free(c->weights);
    free(c->moved);
    c->weights = NULL;
    c->moved = NULL;
    c->linked = NULL;
}

void view_capture_close(view_capture *c)
{
    view_capture_forget(c);
    if (c->is_open) (void)close(c->socket);
    c->is_open = 0;
}

/* ---- names ---- */

static void make_rig(view_capture *c, const view_model *m, uint32_t k)
{
    const noh_kind_desc *kind = &m->figure->kinds[k];
    noh_skeleton skeleton;
    const char **names;
    memset(&c->kinds[k].rig, 0, sizeof c->kinds[k].rig);
    if (noh_pack_skeleton_at(kind->mesh, kind->skeleton, &skeleton, NULL, NULL)) return;
    names = calloc(skeleton.joint_count + 1u, sizeof *names);
    for (uint32_t j = 0; names && j < skeleton.joint_count; j++) {
        names[j] = noh_stage_name(m->figure->stage, k, NOH_NAME_JOINT, j);
    }
    if (names) vmc_rig_make(&c->kinds[k].rig, &skeleton, names);
    free(names);
}

/* The channels of an expression of VRM; an emotion has two. */
static void find_channels(const char *name, uint32_t channels[2])
{
    const char *channel = vrm_expression_channel(name, 0);
    channels[0] = channels[1] = NOH_NONE;
    if (!channel) channel = vrm_expression_channel(name, 1);
    if (!channel) return;
    for (uint32_t i = 0; i < NOH_CHANNEL_COUNT; i++) {
        if (strcmp(channel, noh_face_channel_name(i)) == 0) channels[0] = i;
    }
    if (strcmp(channel, "blink") == 0) {
        channels[0] = NOH_CHANNEL_BLINK_LEFT;
        channels[1] = NOH_CHANNEL_BLINK_RIGHT;
    } else if (channels[0] != NOH_NONE && channels[0] >= NOH_CHANNEL_UPPER && channels[0] < NOH_CHANNEL_MOUTH) {
        channels[1] = channels[0] + NOH_EMOTION_COUNT;
    }
}

static int is_linked(const view_capture *c, uint32_t channel)
{
    for (uint32_t i = 0; i < c->link_count; i++) {
        if (c->links[i].channel == channel) return 1;
    }
    return 0;
}

/* A target of the name; or else the expression's channels; or else a target that means the same. */
static void link_value(view_capture *c, const view_model *m, uint32_t i)
{
    view_captured_value *value = &c->values[i];
    char means[NOH_NAME_BYTES_MAX], other[NOH_NAME_BYTES_MAX];
    const char *name = c->vmc.values[i].name;
    value->target = NOH_NONE;
    find_channels(name, value->channels);
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (strcmp(m->targets[t].name, name) == 0) value->target = t;
    }
    if (value->target != NOH_NONE || is_linked(c, value->channels[0]) || is_linked(c, value->channels[1]) ||
        !names_find(NAME_TARGET, name, means, NULL)) {
        return;
    }
    for (uint32_t t = 0; t < m->target_count && value->target == NOH_NONE; t++) {
        if (names_find(NAME_TARGET, m->targets[t].name, other, NULL) && strcmp(means, other) == 0) value->target = t;
    }
}

static void link_model(view_capture *c, const view_model *m)
{
    if (c->linked == m && c->linked_values == c->vmc.value_count) return;
    if (c->linked != m) {
        view_capture_forget(c);
        c->weights = calloc(m->target_count + 1u, sizeof *c->weights);
        c->moved = calloc(m->target_count + 1u, 1);
        if (!c->weights || !c->moved) return;
        c->link_count = view_recipe_links(m, c->links);
        for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) make_rig(c, m, k);
        c->linked_values = 0;
        c->linked = m;
    }
    for (; c->linked_values < c->vmc.value_count; c->linked_values++) link_value(c, m, c->linked_values);
}

/* ---- weights ---- */

static void set_weights(view_capture *c)
{
    float channels[NOH_CHANNEL_COUNT] = { 0.0f };
    const uint32_t count = c->linked->target_count;
    memset(c->weights, 0, count * sizeof *c->weights);
    memset(c->moved, 0, count);
    for (uint32_t i = 0; i < c->linked_values; i++) {
        const view_captured_value *value = &c->values[i];
        const float weight = c->vmc.values[i].value;
        if (value->target != NOH_NONE) {
            c->weights[value->target] = fminf(c->weights[value->target] + weight, 1.0f);
            c->moved[value->target] = 1;
            continue;
        }
        for (int n = 0; n < 2; n++) {
            if (value->channels[n] == NOH_NONE) continue;
            channels[value->channels[n]] += weight;
            for (uint32_t l = 0; l < c->link_count; l++) {
                if (c->links[l].channel == value->channels[n]) c->moved[c->links[l].target] = 1;
            }
        }
    }
    noh_face_apply(c->links, c->link_count, channels, c->weights);
}

/* ---- a frame ---- */

int view_capture_poll(view_capture *c, view_model *m)
{
    static uint8_t packet[PACKET_BYTES];
    const uint32_t bad = c->vmc.bad, packets = c->vmc.packets;
    if (!c->is_open) return 0;
    for (uint32_t i = 0; i < PACKETS_MAX; i++) {
        const ssize_t bytes = recv(c->socket, packet, sizeof packet, 0);
        if (bytes < 0) break;
        vmc_take(&c->vmc, packet, (size_t)bytes);
    }
    link_model(c, m);
    if (c->linked && c->vmc.packets != packets) {
        set_weights(c);
        m->touched = 1;
    }
    return !bad && c->vmc.bad
               ? tool_fail("--vmc",
                           "a message is damaged, or has a bone, a number or a name that the protocol does not: "
                           "such messages are left out and counted")
               : 0;
}

void view_capture_print(const view_capture *c, FILE *out)
{
    uint32_t known = 0, moved = 0, joints = 0;
    if (!c->is_open) return;
    for (uint32_t b = 0; b < VMC_BONES; b++) known += c->vmc.bones[b].is_known != 0;
    for (uint32_t k = 0; c->linked && k < c->linked->figure->stage_desc.kind_count; k++)
        joints += c->kinds[k].rig.bone_count;
    for (uint32_t t = 0; c->linked && t < c->linked->target_count; t++) moved += c->moved[t];
    fprintf(out,
            "capture: %u bones for %u joints, %u expressions for %u targets, %u messages, %u left out, %u unread\n",
            known, joints, c->vmc.value_count, moved, c->vmc.messages, c->vmc.bad, c->vmc.unread);
}
