#include "place_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/input_file.h"
#include "convert/base/nearest.h"
#include "convert/base/text_scan.h"

#define FAR 1e5
#define TICKS_PER_S 48000.0

typedef struct reader {
    text_scan s;
    place_file *place;
    uint32_t line; /* of the first word of this one */
    const char *form;
    int has_area, has_agents;
    uint32_t object_lines[NOH_SMART_OBJECTS_MAX];
} reader;

/* ---- words ---- */

static int is_over(reader *r)
{
    text_scan ahead = r->s;
    text_word word;
    return text_take_on_line(&ahead, &word) == 0 && !word.size;
}

static int number(reader *r, const char *what, double least, double most, float *out)
{
    text_word word;
    double value;
    if (text_take_on_line(&r->s, &word)) return 1;
    if (!word.size) return text_fail(&r->s, r->line, "%s is missing: %s", what, r->form);
    if (text_number(&r->s, word, &value)) return 1;
    if (!(value >= least && value <= most)) {
        return text_fail(&r->s, r->line, "%s is %g: it must be %g to %g", what, value, least, most);
    }
    *out = (float)value;
    return 0;
}

static int seconds(reader *r, const char *what, double least, uint32_t *ticks)
{
    float s = 0.0f;
    if (number(r, what, least, 3600.0, &s)) return 1;
    *ticks = (uint32_t)((double)s * TICKS_PER_S + 0.5);
    return 0;
}

static int point(reader *r, float at[2])
{
    return number(r, "X", -FAR, FAR, &at[0]) || number(r, "Z", -FAR, FAR, &at[1]);
}

/* X0 Z0 X1 Z1, of any two corners. */
static int area(reader *r, place_area *out)
{
    float a[2] = { 0.0f, 0.0f }, b[2] = { 0.0f, 0.0f };
    if (point(r, a) || point(r, b)) return 1;
    for (int i = 0; i < 2; i++) {
        out->low[i] = a[i] < b[i] ? a[i] : b[i];
        out->high[i] = a[i] < b[i] ? b[i] : a[i];
        if (!(out->high[i] > out->low[i])) return text_fail(&r->s, r->line, "the area has no extent: %s", r->form);
    }
    return 0;
}

static int name(reader *r, const char *what, char **out)
{
    text_word word;
    if (text_take_on_line(&r->s, &word)) return 1;
    if (!word.size) return text_fail(&r->s, r->line, "%s is missing: %s", what, r->form);
    *out = text_copy(word);
    return *out ? 0 : text_fail(&r->s, r->line, "out of memory");
}

/* Room for one more, cleared; NULL after an error. */
static void *grown(reader *r, void **array, uint32_t *count, uint32_t most, size_t each, const char *what)
{
    char *more;
    if (*count == most) {
        (void)text_fail(&r->s, r->line, "there are more than %u %s", most, what);
        return NULL;
    }
    more = realloc(*array, (*count + 1u) * each);
    if (!more) {
        (void)text_fail(&r->s, r->line, "out of memory");
        return NULL;
    }
    *array = more;
    memset(more + *count * each, 0, each);
    return more + (*count)++ * each;
}

static int is_full(reader *r, uint32_t count, uint32_t most, const char *what)
{
    return count == most ? text_fail(&r->s, r->line, "there are more than %u %s", most, what) : 0;
}

/* ---- lines ---- */

static int read_area(reader *r)
{
    if (r->has_area) return text_fail(&r->s, r->line, "the area is given twice");
    r->has_area = 1;
    return area(r, &r->place->area);
}

static int read_wall(reader *r)
{
    noh_crowd_obstacle *o = grown(r, (void **)&r->place->obstacles, &r->place->obstacle_count, NOH_CROWD_OBSTACLES_MAX,
                                  sizeof *o, "walls and posts");
    float thickness = 0.0f;
    if (!o || point(r, o->from) || point(r, o->to)) return 1;
    if (!is_over(r) && number(r, "THICKNESS", 0.0, FAR, &thickness)) return 1;
    o->radius = 0.5f * thickness;
    return 0;
}

static int read_post(reader *r)
{
    noh_crowd_obstacle *o = grown(r, (void **)&r->place->obstacles, &r->place->obstacle_count, NOH_CROWD_OBSTACLES_MAX,
                                  sizeof *o, "walls and posts");
    if (!o || point(r, o->from)) return 1;
    memcpy(o->to, o->from, sizeof o->to);
    return number(r, "RADIUS", 1e-3, FAR, &o->radius);
}

static int read_step(reader *r)
{
    place_file *p = r->place;
    if (is_full(r, p->step_count, PLACE_STEPS_MAX, "steps")) return 1;
    place_step *step = &p->steps[p->step_count++];
    return area(r, &step->area) || number(r, "HEIGHT", -100.0, 100.0, &step->height);
}

static int read_spawn(reader *r)
{
    place_file *p = r->place;
    return is_full(r, p->spawn_count, PLACE_SPAWNS_MAX, "areas to spawn in") || area(r, &p->spawns[p->spawn_count++]);
}

static int read_goal(reader *r)
{
    place_file *p = r->place;
    if (is_full(r, p->goal_count, PLACE_GOALS_MAX, "goals")) return 1;
    place_goal *goal = &p->goals[p->goal_count++];
    goal->radius = 1.0f;
    if (point(r, goal->at)) return 1;
    return is_over(r) ? 0 : number(r, "RADIUS", 0.0, FAR, &goal->radius);
}

static int read_agents(reader *r)
{
    place_file *p = r->place;
    if (r->has_agents) return text_fail(&r->s, r->line, "agents are given twice");
    r->has_agents = 1;
    if (number(r, "RADIUS", 0.05, 1.5, &p->radius)) return 1;
    if (number(r, "SLOWEST", 0.05, 15.0 * (double)p->radius, &p->speed[0])) return 1;
    return number(r, "FASTEST", (double)p->speed[0], 15.0 * (double)p->radius, &p->speed[1]);
}

static int read_need(reader *r)
{
    place_file *p = r->place;
    const uint32_t n = p->smart.need_count;
    if (is_full(r, n, NOH_SMART_NEEDS_MAX, "needs") || name(r, "NAME", &p->need_names[n])) return 1;
    p->smart.need_count++;
    for (uint32_t i = 0; i < n; i++) {
        if (strcmp(p->need_names[i], p->need_names[n]) == 0) {
            return text_fail(&r->s, r->line, "the need '%.40s' is given twice", p->need_names[n]);
        }
    }
    return number(r, "GROWTH", 0.0, 10.0, &p->smart.growth[n]);
}

static int find_need(reader *r, uint32_t *need)
{
    const place_file *p = r->place;
    char *wanted = NULL;
    int status = name(r, "NEED", &wanted);
    if (status || !wanted) return 1;
    for (*need = 0; *need < p->smart.need_count && strcmp(p->need_names[*need], wanted) != 0; ++*need) {}
    if (*need == p->smart.need_count) {
        const char *near = nearest_name(wanted, (const char *const *)p->need_names, p->smart.need_count);
        status = text_fail(&r->s, r->line, "no line above gives the need '%.40s'%s%.40s%s", wanted,
                           near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
    }
    free(wanted);
    return status;
}

static int read_object(reader *r)
{
    place_file *p = r->place;
    char *unused = NULL;
    r->object_lines[p->smart.object_count < NOH_SMART_OBJECTS_MAX ? p->smart.object_count : 0] = r->line;
    noh_smart_object *o = grown(r, (void **)&p->objects, &p->smart.object_count, NOH_SMART_OBJECTS_MAX, sizeof *o,
                                "objects");
    if (!o) return 1;
    o->first_slot = p->smart.slot_count;
    const int status = name(r, "NAME", &unused);
    free(unused); /* names are for readers of the file only */
    return status || find_need(r, &o->need) || number(r, "RATE", 1e-3, 1e3, &o->rate) ||
           seconds(r, "GOING_S", 1.0, &o->going_ticks);
}

static int take_clip(reader *r, uint32_t *clip)
{
    place_file *p = r->place;
    char *wanted = NULL;
    if (name(r, "CLIP", &wanted) || !wanted) return 1;
    if (strcmp(wanted, "-") == 0) { /* none */
        free(wanted);
        return 0;
    }
    for (*clip = 0; *clip < p->clip_count && strcmp(p->clips[*clip], wanted) != 0; ++*clip) {}
    if (*clip < p->clip_count) {
        free(wanted);
    } else {
        if (p->clip_count == PLACE_CLIPS_MAX) {
            free(wanted);
            return text_fail(&r->s, r->line, "there are more than %u clips", PLACE_CLIPS_MAX);
        }
        p->clips[p->clip_count++] = wanted;
    }
    ++*clip;
    return 0;
}

static int read_slot(reader *r)
{
    place_file *p = r->place;
    float degrees = 0.0f;
    if (!p->smart.object_count) return text_fail(&r->s, r->line, "a slot must follow the line of its object");
    noh_smart_slot *slot = grown(r, (void **)&p->slots, &p->smart.slot_count, NOH_SMART_SLOTS_MAX, sizeof *slot,
                                 "slots");
    if (!slot) return 1;
    p->objects[p->smart.object_count - 1u].slot_count++;
    if (point(r, slot->at) || number(r, "FACING", -360.0, 360.0, &degrees)) return 1;
    slot->face[0] = (float)sin((double)degrees * 0.017453292519943295);
    slot->face[1] = (float)cos((double)degrees * 0.017453292519943295);
    slot->use_ticks = (uint32_t)(20.0 * TICKS_PER_S);
    if (is_over(r)) return 0;
    if (seconds(r, "USE_S", 0.1, &slot->use_ticks)) return 1;
    if (is_over(r)) return 0;
    if (take_clip(r, &slot->use_clip)) return 1;
    if (is_over(r)) return 0;
    return take_clip(r, &slot->enter_clip) || seconds(r, "ENTER_S", 0.0, &slot->enter_ticks) ||
           take_clip(r, &slot->leave_clip) || seconds(r, "LEAVE_S", 0.0, &slot->leave_ticks);
}

static const struct {
    const char *word, *form;
    int (*read)(reader *r);
} lines[] = {
    { "area", "write `area X0 Z0 X1 Z1`", read_area },
    { "wall", "write `wall X0 Z0 X1 Z1 [THICKNESS]`", read_wall },
    { "post", "write `post X Z RADIUS`", read_post },
    { "step", "write `step X0 Z0 X1 Z1 HEIGHT`", read_step },
    { "spawn", "write `spawn X0 Z0 X1 Z1`", read_spawn },
    { "goal", "write `goal X Z [RADIUS]`", read_goal },
    { "agents", "write `agents RADIUS SLOWEST FASTEST`", read_agents },
    { "need", "write `need NAME GROWTH`", read_need },
    { "object", "write `object NAME NEED RATE GOING_S`", read_object },
    { "slot", "write `slot X Z FACING [USE_S [CLIP [ENTER ENTER_S LEAVE LEAVE_S]]]`", read_slot },
};
#define LINES (sizeof lines / sizeof lines[0])

static int unknown(reader *r, text_word word)
{
    const char *words[LINES], *near;
    char shown[TEXT_SHOWN];
    for (size_t i = 0; i < LINES; i++) words[i] = lines[i].word;
    near = nearest_name(text_show(word, shown), words, LINES);
    return text_fail(&r->s, r->line, "a place has no line '%s'%s%s%s", shown, near ? "; did you mean '" : "",
                     near ? near : "", near ? "'?" : "");
}

static int read_line(reader *r)
{
    text_word word;
    if (text_take_on_line(&r->s, &word)) return 1;
    if (!word.size) return 0;
    r->line = word.line;
    for (size_t i = 0; i < LINES; i++) {
        if (!text_is(word, lines[i].word)) continue;
        r->form = lines[i].form;
        if (lines[i].read(r)) return 1;
        return is_over(r) ? 0 : text_fail(&r->s, r->line, "one word too many: %s", r->form);
    }
    return unknown(r, word);
}

/* ---- the whole ---- */

static int is_within(const place_area *outer, const float at[2])
{
    return at[0] >= outer->low[0] && at[0] <= outer->high[0] && at[1] >= outer->low[1] && at[1] <= outer->high[1];
}

static int check_inside(reader *r)
{
    const place_file *p = r->place;
    for (uint32_t i = 0; i < p->spawn_count; i++) {
        if (!is_within(&p->area, p->spawns[i].low) || !is_within(&p->area, p->spawns[i].high)) {
            return text_fail(&r->s, 0, "spawn %u is not within the area", i + 1u);
        }
    }
    for (uint32_t i = 0; i < p->goal_count; i++) {
        if (!is_within(&p->area, p->goals[i].at)) {
            return text_fail(&r->s, 0, "goal %u is not within the area", i + 1u);
        }
    }
    for (uint32_t i = 0; i < p->smart.slot_count; i++) {
        if (!is_within(&p->area, p->slots[i].at)) {
            return text_fail(&r->s, 0, "slot %u is not within the area", i + 1u);
        }
    }
    return 0;
}

static int check(reader *r)
{
    const place_file *p = r->place;
    r->line = 0;
    if (!r->has_area) return text_fail(&r->s, 0, "the place has no area: add a line `area X0 Z0 X1 Z1`");
    if (!p->spawn_count) return text_fail(&r->s, 0, "agents have nowhere to enter: add a line `spawn X0 Z0 X1 Z1`");
    if (!p->goal_count && !p->smart.object_count) {
        return text_fail(&r->s, 0, "agents have no destination: add a line `goal X Z`, or objects");
    }
    for (uint32_t i = 0; i < p->smart.object_count; i++) {
        if (!p->objects[i].slot_count) {
            r->line = r->object_lines[i];
            return text_fail(&r->s, r->line, "this object has no slot: add a line `slot X Z FACING` below it");
        }
    }
    return check_inside(r);
}

int place_parse(const char *text, size_t size, place_file **out, uint32_t *line, model_error *error)
{
    reader *r = calloc(1, sizeof *r);
    place_file *p = calloc(1, sizeof *p);
    int status = 1;
    *out = NULL;
    *line = 0;
    if (r && p) {
        text_start(&r->s, text, size, error);
        r->place = p;
        p->radius = 0.25f;
        p->speed[0] = 1.0f;
        p->speed[1] = 1.4f;
        for (status = 0; !status && text_next_line(&r->s);) {
            r->line = r->s.line;
            status = read_line(r);
        }
        if (!status) status = check(r);
        *line = r->line;
    } else {
        model_fail_memory(error);
    }
    free(r);
    if (status) {
        place_free(p);
        return 1;
    }
    p->smart.objects = p->objects;
    p->smart.slots = p->slots;
    *out = p;
    return 0;
}

int place_read(const char *path, place_file **out)
{
    char subject[512];
    model_error error;
    uint32_t line = 0;
    size_t size;
    char *text = input_read_text(path, &size, &error);
    const int status = text ? place_parse(text, size, out, &line, &error) : 1;
    free(text);
    if (!status) return 0;
    if (!line) return tool_fail(path, "%s", error.what);
    (void)snprintf(subject, sizeof subject, "%s:%u", path, line);
    return tool_fail(subject, "%s", error.what);
}

void place_free(place_file *place)
{
    if (!place) return;
    for (uint32_t i = 0; i < NOH_SMART_NEEDS_MAX; i++) free(place->need_names[i]);
    for (uint32_t i = 0; i < place->clip_count; i++) free(place->clips[i]);
    free(place->obstacles);
    free(place->objects);
    free(place->slots);
    free(place);
}
