#include "info_hair.h"

#include <stdio.h>

#include "noh/body.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

void info_print_hair(const noh_pack *pack)
{
    noh_haircut cut;
    const noh_actor_hair_desc one = { .cut = &cut, .head_max = 1, .near_max = 1, .in_state = 1 };
    if (noh_haircut_open(pack, &cut, NULL)) return;
    printf("hair: %u control hairs of %u points, %u patches, %u spheres, %u strips of %u segments, %s%s\n",
           cut.header->hair_count, cut.header->point_count, cut.header->patch_count, cut.header->sphere_count,
           cut.header->strip_count, cut.header->segment_count, cut.joint[0] ? "carried by " : "carried by the actor",
           cut.joint);
    printf("  on a stage %u bytes an actor; drawn with %zu bytes on the CPU, %llu on the GPU\n",
           noh_actor_hair_modifier(&one).state_bytes, noh_actor_hair_size(&one) + noh_stage_hair_size(&one),
           (unsigned long long)noh_stage_hair_bytes(&one));
}

void info_json_hair(json *j, const noh_pack *pack)
{
    noh_haircut cut;
    const noh_actor_hair_desc one = { .cut = &cut, .head_max = 1, .near_max = 1, .in_state = 1 };
    if (noh_haircut_open(pack, &cut, NULL)) {
        json_null(j, "hair");
        return;
    }
    json_open(j, "hair", '{');
    if (cut.joint[0]) {
        json_text(j, "joint", cut.joint);
    } else {
        json_null(j, "joint");
    }
    json_integer(j, "hairs", cut.header->hair_count);
    json_integer(j, "points", cut.header->point_count);
    json_integer(j, "patches", cut.header->patch_count);
    json_integer(j, "spheres", cut.header->sphere_count);
    json_integer(j, "strips", cut.header->strip_count);
    json_integer(j, "segments", cut.header->segment_count);
    json_integer(j, "actor_bytes", noh_actor_hair_modifier(&one).state_bytes);
    json_integer(j, "cpu_bytes", noh_actor_hair_size(&one) + noh_stage_hair_size(&one));
    json_integer(j, "gpu_bytes", noh_stage_hair_bytes(&one));
    json_close(j, '}');
}
