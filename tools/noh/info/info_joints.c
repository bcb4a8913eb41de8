#include "info_joints.h"

#include <stdio.h>

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
    printf("  off by at most %.3g, %.3g, %.3g cm at 30, 15, 8 Hz", unit * (double)h->update_rate_error[1],
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
