/* crowd_test.c: a scene's steps, its dump, and what is said about it. */
#include "crowd_test.h"

#include <stdarg.h>
#include <stdio.h>

#include "cli/json.h"
#include "cli/message.h"
#include "convert/base/byte_buffer.h"
#include "platform.h"

static void print_to(byte_buffer *out, const char *format, ...)
{
    char line[192];
    va_list args;
    va_start(args, format);
    const int count = vsnprintf(line, sizeof line, format, args);
    va_end(args);
    buffer_append(out, line, count < (int)sizeof line ? (size_t)count : sizeof line - 1);
}

static void dump_step(byte_buffer *out, const crowd_scene *s)
{
    for (uint32_t i = 0; i < crowd_scene_agents(s); i++) {
        const noh_crowd_agent *a = crowd_scene_agent(s, i);
        print_to(out, "%u,%u,%.7g,%.7g,%.7g,%.7g,%.7g\n", crowd_scene_steps(s), i, (double)a->position[0],
                 (double)a->position[1], (double)a->velocity[0], (double)a->velocity[1], (double)a->radius);
    }
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

static int print_json(const crowd_scene *s)
{
    const crowd_measures *m = crowd_scene_measures(s);
    char hash[16];
    json j = json_begin();
    json_integer(&j, "agents", crowd_scene_agents(s));
    json_number(&j, "seconds", (double)crowd_scene_steps(s) / 30.0);
    json_time(&j, "half_s", m->half);
    json_time(&j, "done_s", m->done);
    json_number(&j, "overlap_max_pct", 100.0 * m->overlap_max);
    json_number(&j, "overlapped_pct", share((double)m->overlapped, m->agent_steps));
    json_number(&j, "progress_pct", share(m->progress, m->under_way));
    json_number(&j, "stuck_max_s", (double)m->stuck_max / 30.0);
    json_number(&j, "held_max_s", (double)m->held_max / 30.0);
    json_number(&j, "ns_per_agent_step", crowd_scene_cpu_ns(s) / (double)m->agent_steps);
    json_integer(&j, "bytes", crowd_scene_bytes(s));
    json_integer(&j, "field_bytes", crowd_scene_field_bytes(s));
    snprintf(hash, sizeof hash, "%08x", noh_crowd_hash(crowd_scene_crowd(s)));
    json_text(&j, "hash", hash);
    return json_end(&j);
}

static int print_text(const char *name, const crowd_scene *s)
{
    const crowd_measures *m = crowd_scene_measures(s);
    printf("%s: %u agents, %.4g s", name, crowd_scene_agents(s), (double)crowd_scene_steps(s) / 30.0);
    if (m->done >= 0.0) printf("; half of them there after %.1f s, all after %.1f", m->half, m->done);
    printf("\n  overlapped by at most %.1f %% of two radii, by more than 5 %% in %.4f %% of all agents' steps\n",
           100.0 * m->overlap_max, share((double)m->overlapped, m->agent_steps));
    printf("  progress %.1f %%; none stood still for more than %.1f s with room in front, %.1f s at all\n",
           share(m->progress, m->under_way), (double)m->stuck_max / 30.0, (double)m->held_max / 30.0);
    if (crowd_scene_field_bytes(s)) printf("  %zu bytes of flow fields\n", crowd_scene_field_bytes(s));
    printf("  %.0f ns an agent and step, %zu bytes, %.1f an agent; hash %08x\n",
           crowd_scene_cpu_ns(s) / (double)m->agent_steps, crowd_scene_bytes(s),
           (double)crowd_scene_bytes(s) / (double)crowd_scene_agents(s), noh_crowd_hash(crowd_scene_crowd(s)));
    return 0;
}

int crowd_test_run(const crowd_scene_options *options, const char *dump, int as_json)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    crowd_scene *s = NULL;
    int status = crowd_scene_open(options, &s);
    if (status) return status;
    if (dump) print_to(&out, "frame,agent,x,z,vx,vz,radius\n");
    while (crowd_scene_step(s)) {
        if (dump) dump_step(&out, s);
    }
    if (dump) status = write_dump(dump, &out);
    if (!status) status = as_json ? print_json(s) : print_text(options->name, s);
    buffer_free(&out);
    crowd_scene_close(s);
    return status;
}
