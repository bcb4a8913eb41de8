/* crowd_test.c: a scene's steps, dump and report. */
#include "crowd_test.h"

#include <stdio.h>

#include "cli/json.h"
#include "cli/message.h"
#include "convert/base/byte_buffer.h"
#include "place_life.h"
#include "platform.h"

#define PLACE_S 60.0

/* The results of the agents. */
typedef struct result {
    const char *name;
    uint32_t agents, steps, hash;
    size_t bytes, field_bytes; /* field_bytes: of these, flow fields */
    double cpu_ns;
    const crowd_measures *measures;
} result;

static void dump_agent(byte_buffer *out, uint32_t step, uint32_t index, const noh_crowd_agent *a)
{
    buffer_print(out, "%u,%u,%.7g,%.7g,%.7g,%.7g,%.7g\n", step, index, (double)a->position[0], (double)a->position[1],
                 (double)a->velocity[0], (double)a->velocity[1], (double)a->radius);
}

static int write_dump(const char *path, const byte_buffer *out)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (out->failed || noh_file_write(path, out->bytes, out->count, &error)) {
        return tool_fail(path, "cannot write: %s", out->failed ? "out of memory" : error.what);
    }
    return 0;
}

static double share(double part, uint64_t of)
{
    return of ? 100.0 * part / (double)of : 0.0;
}

static void json_time(json *j, const char *key, double seconds)
{
    if (seconds >= 0.0)
        json_number(j, key, seconds);
    else
        json_null(j, key);
}

static int print_json(const result *r)
{
    const crowd_measures *m = r->measures;
    char hash[16];
    json j = json_begin();
    json_integer(&j, "agents", r->agents);
    json_number(&j, "seconds", (double)r->steps / 30.0);
    json_time(&j, "half_s", m->half);
    json_time(&j, "done_s", m->done);
    json_number(&j, "overlap_max_pct", 100.0 * m->overlap_max);
    json_number(&j, "overlapped_pct", share((double)m->overlapped, m->agent_steps));
    json_number(&j, "progress_pct", share(m->progress, m->under_way));
    json_number(&j, "stuck_max_s", (double)m->stuck_max / 30.0);
    json_number(&j, "held_max_s", (double)m->held_max / 30.0);
    json_number(&j, "ns_per_agent_step", r->cpu_ns / (double)m->agent_steps);
    json_integer(&j, "bytes", r->bytes);
    json_integer(&j, "field_bytes", r->field_bytes);
    snprintf(hash, sizeof hash, "%08x", r->hash);
    json_text(&j, "hash", hash);
    return json_end(&j);
}

static int print_text(const result *r)
{
    const crowd_measures *m = r->measures;
    printf("%s: %u agents, %.4g s", r->name, r->agents, (double)r->steps / 30.0);
    if (m->done >= 0.0) printf("; half arrived after %.1f s, all after %.1f", m->half, m->done);
    printf("\n  overlapped by at most %.1f %% of two radii, by more than 5 %% in %.4f %% of all agents' steps\n",
           100.0 * m->overlap_max, share((double)m->overlapped, m->agent_steps));
    printf("  progress %.1f %%; longest stop %.1f s with room in front, %.1f s in all\n",
           share(m->progress, m->under_way), (double)m->stuck_max / 30.0, (double)m->held_max / 30.0);
    if (r->field_bytes) printf("  %zu bytes of flow fields\n", r->field_bytes);
    printf("  %.0f ns an agent and step, %zu bytes, %.1f an agent; hash %08x\n", r->cpu_ns / (double)m->agent_steps,
           r->bytes, (double)r->bytes / (double)r->agents, r->hash);
    return 0;
}

static int report(const result *r, byte_buffer *out, const char *dump, int as_json)
{
    const int status = dump ? write_dump(dump, out) : 0;
    buffer_free(out);
    if (status) return status;
    return as_json ? print_json(r) : print_text(r);
}

int crowd_test_run(const crowd_scene_options *options, const char *dump, int as_json)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    crowd_scene *s = NULL;
    int status = crowd_scene_open(options, &s);
    if (status) return status;
    if (dump) buffer_print(&out, "frame,agent,x,z,vx,vz,radius\n");
    while (crowd_scene_step(s)) {
        for (uint32_t i = 0; i < crowd_scene_agents(s) && dump; i++) {
            dump_agent(&out, crowd_scene_steps(s), i, crowd_scene_agent(s, i));
        }
    }
    const result r = { options->name,         crowd_scene_agents(s),
                       crowd_scene_steps(s),  noh_crowd_hash(crowd_scene_crowd(s)),
                       crowd_scene_bytes(s),  crowd_scene_field_bytes(s),
                       crowd_scene_cpu_ns(s), crowd_scene_measures(s) };
    status = report(&r, &out, dump, as_json);
    crowd_scene_close(s);
    return status;
}

static int run_place(const crowd_scene_options *options, const place_file *place, const char *dump, int as_json)
{
    const uint32_t steps = (uint32_t)((options->seconds > 0.0 ? options->seconds : PLACE_S) * 30.0 + 0.5);
    byte_buffer out = { NULL, 0, 0, 0 };
    place_life *l = NULL;
    int status = place_life_open(place, options->agents, options->seed, &l);
    if (status) return status;
    if (dump) buffer_print(&out, "frame,agent,x,z,vx,vz,radius\n");
    while (place_life_steps(l) < steps) {
        place_life_step(l);
        for (uint32_t i = 0; i < place_life_agents(l) && dump; i++) {
            dump_agent(&out, place_life_steps(l), i, place_life_agent(l, i));
        }
    }
    const result r = { options->name,        place_life_agents(l),  place_life_steps(l),
                       place_life_hash(l),   place_life_bytes(l),   0,
                       place_life_cpu_ns(l), place_life_measures(l) };
    status = report(&r, &out, dump, as_json);
    place_life_close(l);
    return status;
}

int crowd_place_run(const crowd_scene_options *options, const noh_field *ground, const char *dump, int as_json)
{
    place_file *place = NULL;
    int status = place_read(options->name, &place);
    if (!status) place->ground = ground;
    if (!status) status = run_place(options, place, dump, as_json);
    place_free(place);
    return status;
}
