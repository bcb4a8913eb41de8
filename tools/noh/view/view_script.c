#define _POSIX_C_SOURCE 200809L
#include "view/view_script.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

#include "cli/message.h"
#include "draw/silhouette.h"
#include "file/text_file.h"

#define QUEUE_MAX 512u
#define TEXT_BYTES_MAX (1u << 20)
#define WORDS_MAX 8

/* The events before one frame. */
typedef enum act_kind { ACT_NONE, ACT_WANT, ACT_PRESS, ACT_MOVE, ACT_RELEASE, ACT_KEY, ACT_UP, ACT_LETTER } act_kind;

typedef struct act {
    act_kind kind;
    char name[128]; /* of a control; "": `at` is a point */
    float at[2];    /* a share of the control, or points */
    int code, mods; /* button, key or letter */
} act;

struct view_script {
    char path[1024];
    char *text, *next;
    unsigned line;
    act queue[QUEUE_MAX];
    unsigned first, count;
    uint32_t frames; /* to be drawn yet */
    char until[256]; /* "": nothing is waited for */
    double inside;   /* of the silhouette, at least, in each of these frames; 0: whatever is seen */
    int loading;
};

/* ---- opening ---- */

static int read_input(char **text)
{
    *text = calloc(TEXT_BYTES_MAX, 1);
    if (!*text) return tool_fail("-", "out of memory");
    (void)fread(*text, 1, TEXT_BYTES_MAX - 1u, stdin);
    return 0;
}

view_script *view_script_open(const char *path)
{
    view_script *s = calloc(1, sizeof *s);
    int status = s ? 0 : tool_fail(path, "out of memory");
    if (!status) {
        snprintf(s->path, sizeof s->path, "%s", path);
        status = strcmp(path, "-") == 0 ? read_input(&s->text) : text_file_read(path, 0, TEXT_BYTES_MAX, &s->text);
    }
    if (status) {
        view_script_close(s);
        return NULL;
    }
    s->next = s->text;
    return s;
}

void view_script_close(view_script *s)
{
    if (s) free(s->text);
    free(s);
}

static int fail(const view_script *s, const char *what, const char *about)
{
    tool_fail(s->path, "line %u: %s '%s'", s->line, what, about);
    return -1;
}

/* ---- what happens ---- */

static act *add(view_script *s, act_kind kind)
{
    act *a = &s->queue[(s->first + s->count) % QUEUE_MAX];
    if (s->count < QUEUE_MAX) s->count++;
    memset(a, 0, sizeof *a);
    a->kind = kind;
    return a;
}

/* Before all that is queued. */
static void add_front(view_script *s, act_kind kind)
{
    s->first = (s->first + QUEUE_MAX - 1u) % QUEUE_MAX;
    s->count++;
    memset(&s->queue[s->first], 0, sizeof s->queue[0]);
    s->queue[s->first].kind = kind;
}

static void add_at(view_script *s, act_kind kind, const char *name, float x, float y, int code, int mods)
{
    act *a = add(s, kind);
    snprintf(a->name, sizeof a->name, "%s", name);
    a->at[0] = x;
    a->at[1] = y;
    a->code = code;
    a->mods = mods;
}

/* A point, or one of a control. */
static int point_of(view_script *s, const act *a, float at[2])
{
    float box[4];
    memcpy(at, a->at, 2 * sizeof *at);
    if (!a->name[0]) return 0;
    switch (view_panels_find(a->name, box)) {
    case 0: return fail(s, "there is no control", a->name);
    case 2: return fail(s, "scrolling does not bring it into the window:", a->name);
    default: break;
    }
    at[0] = box[0] + a->at[0] * (box[2] - box[0]);
    at[1] = box[1] + a->at[1] * (box[3] - box[1]);
    return 0;
}

/* Returns 1 where it needs no frame, 0 where one is to be drawn, -1 after printing an error. */
static int act_out(view_script *s, const act *a, view_window *w)
{
    float at[2], box[4];
    switch (a->kind) {
    case ACT_WANT:
        if (view_panels_find(a->name, box) == 1) return 1;
        view_panels_want(a->name);
        add_front(s, ACT_NONE); /* it scrolls in one frame and is there in the next */
        return 0;
    case ACT_PRESS:
        if (point_of(s, a, at)) return -1;
        view_on_move(w, (double)at[0], (double)at[1]);
        view_on_button(w, a->code, GLFW_PRESS, a->mods);
        return 0;
    case ACT_MOVE:
        if (point_of(s, a, at)) return -1;
        view_on_move(w, (double)at[0], (double)at[1]);
        return 0;
    case ACT_RELEASE: view_on_button(w, a->code, GLFW_RELEASE, a->mods); return 0;
    case ACT_KEY:
        w->input.keys[GLFW_KEY_LEFT_CONTROL] = (a->mods & GLFW_MOD_CONTROL) != 0;
        w->input.keys[GLFW_KEY_LEFT_SHIFT] = (a->mods & GLFW_MOD_SHIFT) != 0;
        view_on_key(w, a->code, GLFW_PRESS, a->mods);
        return 0;
    case ACT_UP:
        view_on_key(w, a->code, GLFW_RELEASE, 0);
        w->input.keys[GLFW_KEY_LEFT_CONTROL] = w->input.keys[GLFW_KEY_LEFT_SHIFT] = 0;
        return 0;
    case ACT_LETTER: view_on_letter(w, (unsigned)a->code); return 0;
    default: return 0;
    }
}

/* A press and a release, a frame apart, then a frame for the action and one for what it opens. Controls are scrolled
 * into view first. */
static void add_click(view_script *s, const char *name, float x, float y, int button, int mods)
{
    if (name[0]) add_at(s, ACT_WANT, name, 0.0f, 0.0f, 0, 0);
    add_at(s, ACT_PRESS, name, x, y, button, mods);
    add_at(s, ACT_RELEASE, "", 0.0f, 0.0f, button, mods);
    add(s, ACT_NONE);
    add(s, ACT_NONE);
}

static void add_drag(view_script *s, const char *name, const float from[2], const float to[2], int button)
{
    if (name[0]) add_at(s, ACT_WANT, name, 0.0f, 0.0f, 0, 0);
    add_at(s, ACT_PRESS, name, from[0], from[1], button, 0);
    add_at(s, ACT_MOVE, name, (from[0] + to[0]) / 2.0f, (from[1] + to[1]) / 2.0f, 0, 0);
    add_at(s, ACT_MOVE, name, to[0], to[1], 0, 0);
    add_at(s, ACT_RELEASE, "", 0.0f, 0.0f, button, 0);
    add(s, ACT_NONE);
}

static int key_of(const char *name)
{
    static const struct {
        const char *name;
        int key;
    } keys[] = { { "space", GLFW_KEY_SPACE },    { "escape", GLFW_KEY_ESCAPE },   { "enter", GLFW_KEY_ENTER },
                 { "tab", GLFW_KEY_TAB },        { "delete", GLFW_KEY_DELETE },   { "backspace", GLFW_KEY_BACKSPACE },
                 { "[", GLFW_KEY_LEFT_BRACKET }, { "]", GLFW_KEY_RIGHT_BRACKET }, { "home", GLFW_KEY_HOME },
                 { "end", GLFW_KEY_END } };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (strcasecmp(name, keys[i].name) == 0) return keys[i].key;
    }
    if ((name[0] == 'F' || name[0] == 'f') && name[1]) {
        const long n = strtol(name + 1, NULL, 10);
        if (n >= 1 && n <= 12) return GLFW_KEY_F1 + (int)n - 1;
    }
    if (name[0] >= 'a' && name[0] <= 'z' && !name[1]) return GLFW_KEY_A + name[0] - 'a';
    return 0;
}

static int add_key(view_script *s, const char *text)
{
    int mods = 0, key;
    const char *name = text;
    if (strncmp(name, "ctrl+", 5) == 0) mods |= GLFW_MOD_CONTROL, name += 5;
    if (strncmp(name, "shift+", 6) == 0) mods |= GLFW_MOD_SHIFT, name += 6;
    key = key_of(name);
    if (!key) return fail(s, "no such key:", text);
    add_at(s, ACT_KEY, "", 0.0f, 0.0f, key, mods);
    add_at(s, ACT_UP, "", 0.0f, 0.0f, key, 0);
    add(s, ACT_NONE);
    return 0;
}

/* ---- the state ---- */

static int state_has(view_app *a, const char *text)
{
    char *state = NULL;
    size_t bytes;
    FILE *out = open_memstream(&state, &bytes);
    int found;
    if (!out) return 0;
    if (a->compare.is.with != VIEW_COMPARE_OFF) (void)view_app_picture(a); /* it counts pixels */
    view_print(a, out);
    fclose(out);
    found = state && strstr(state, text) != NULL;
    free(state);
    return found;
}

static int expect(const view_script *s, view_app *a, const char *text, int wanted)
{
    if (state_has(a, text) == wanted) return 0;
    view_print(a, stdout);
    return fail(s, wanted ? "the state has no line with" : "the state has a line with", text);
}

/* ---- its lines ---- */

/* Cut at blanks; "..." is one word. Returns how many. */
static int cut(char *line, char *words[WORDS_MAX])
{
    int count = 0;
    while (count < WORDS_MAX) {
        char end = ' ';
        while (*line == ' ' || *line == '\t') line++;
        if (!*line || *line == '#') break;
        if (*line == '"') end = *line++;
        words[count++] = line;
        while (*line && *line != end) line++;
        if (*line) *line++ = 0;
    }
    return count;
}

static float number(const char *text)
{
    return strtof(text, NULL);
}

static int is_number(const char *text)
{
    char *end;
    (void)strtof(text, &end);
    return end != text && !*end;
}

static int point_line(view_script *s, char *words[WORDS_MAX], int count)
{
    const char *word = words[0];
    if (strcmp(word, "click") == 0 && count == 2) {
        add_click(s, words[1], 0.5f, 0.5f, GLFW_MOUSE_BUTTON_LEFT, 0);
    } else if (strcmp(word, "click") == 0 && count == 3) {
        add_click(s, "", number(words[1]), number(words[2]), GLFW_MOUSE_BUTTON_LEFT, 0);
    } else if (strcmp(word, "alt-click") == 0 && count == 3) {
        add_click(s, "", number(words[1]), number(words[2]), GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_ALT);
    } else if (strcmp(word, "drag") == 0 && count == 3) {
        const float from[2] = { 0.5f, 0.5f }, to[2] = { number(words[2]), 0.5f };
        add_drag(s, words[1], from, to, GLFW_MOUSE_BUTTON_LEFT);
    } else if (strcmp(word, "drag") == 0 && count == 6 && !is_number(words[1])) { /* within a control */
        const float from[2] = { number(words[2]), number(words[3]) }, to[2] = { number(words[4]), number(words[5]) };
        add_drag(s, words[1], from, to, GLFW_MOUSE_BUTTON_LEFT);
    } else if (strcmp(word, "drag") == 0 && count >= 5) {
        const float from[2] = { number(words[1]), number(words[2]) }, to[2] = { number(words[3]), number(words[4]) };
        add_drag(s, "", from, to, count > 5 ? GLFW_MOUSE_BUTTON_RIGHT : GLFW_MOUSE_BUTTON_LEFT);
    } else {
        return fail(s, "not a command:", word);
    }
    return 0;
}

static int save_line(view_script *s, view_window *w, const char *word, const char *path)
{
    const int with_panels = word[0] == 'w';
    (void)s;
    if (view_app_picture(&w->app)) return -1;
    if (with_panels) {
        view_app_present(&w->app);
        view_panels_draw(&w->app);
    }
    return view_save(&w->app, path, with_panels) ? -1 : 0;
}

static int other_line(view_script *s, view_window *w, char *words[WORDS_MAX], int count)
{
    const char *word = words[0], *what = count > 1 ? words[1] : "";
    if (strcmp(word, "frames") == 0 && count == 2) {
        s->frames = (uint32_t)number(what);
    } else if (strcmp(word, "wheel") == 0 && count == 4) {
        view_on_move(w, (double)number(what), (double)number(words[2]));
        view_on_wheel(w, (double)number(words[3]));
        s->frames = 2;
    } else if (strcmp(word, "key") == 0 && count == 2) {
        return add_key(s, what);
    } else if (strcmp(word, "type") == 0 && count == 2) {
        for (const char *c = what; *c; c++) add_at(s, ACT_LETTER, "", 0.0f, 0.0f, *c, 0);
        add(s, ACT_NONE);
    } else if (strcmp(word, "drop") == 0 && count == 2) {
        view_on_drop(w, what);
    } else if (strcmp(word, "state") == 0) {
        (void)state_has(&w->app, "");
        view_print(&w->app, stdout);
    } else if (strcmp(word, "expect") == 0 && count == 2) {
        return expect(s, &w->app, what, 1);
    } else if (strcmp(word, "expect-not") == 0 && count == 2) {
        return expect(s, &w->app, what, 0);
    } else if (strcmp(word, "until") == 0 && count == 3) {
        snprintf(s->until, sizeof s->until, "%s", what);
        s->frames = (uint32_t)number(words[2]);
    } else if (strcmp(word, "inside") == 0 && count == 3) {
        s->inside = (double)number(what);
        s->frames = (uint32_t)number(words[2]);
    } else if (strcmp(word, "loaded") == 0) {
        s->loading = 1;
    } else if ((strcmp(word, "save") == 0 || strcmp(word, "window") == 0) && count == 2) {
        return save_line(s, w, word, what);
    } else {
        return point_line(s, words, count);
    }
    return 0;
}

/* Enough of the silhouette is in the picture that was drawn last. */
static int stays_inside(const view_script *s, view_app *a)
{
    noh_gl_camera camera;
    silhouette seen;
    char text[64];
    orbit_camera(&a->camera.orbit, &camera);
    if (silhouette_measure(a->model->figure, &camera, NOH_LOD_LEVELS_MAX, &seen)) return -1;
    if (seen.inside >= s->inside) return 0;
    view_print(a, stdout);
    snprintf(text, sizeof text, "%.4f", seen.inside);
    return fail(s, "share of the silhouette in the picture:", text);
}

/* Whether a frame is to be drawn before the next line. */
static int waits(view_script *s, view_app *a)
{
    const struct timespec moment = { 0, 20000000 };
    if (s->inside > 0.0 && stays_inside(s, a)) return -1;
    if (!s->frames) s->inside = 0.0;
    if (s->until[0] && state_has(a, s->until)) s->until[0] = 0, s->frames = 0;
    if (s->until[0] && !s->frames) {
        view_print(a, stdout);
        return fail(s, "none of these frames had a state line with", s->until);
    }
    if (s->loading && a->files.load.state == VIEW_LOAD_RUNS) {
        nanosleep(&moment, NULL);
        return 1;
    }
    if (s->loading) { /* what was loaded is seen in the next frame */
        s->loading = 0;
        return 1;
    }
    if (!s->frames) return 0;
    s->frames--;
    return 1;
}

int view_script_step(view_script *s, view_window *w)
{
    for (;;) {
        char *words[WORDS_MAX], *line = s->next;
        int count, waiting;
        if (s->count) {
            const act a = s->queue[s->first];
            int done;
            s->first = (s->first + 1u) % QUEUE_MAX;
            s->count--;
            done = act_out(s, &a, w);
            if (done <= 0) return done;
            continue;
        }
        waiting = waits(s, &w->app);
        if (waiting) return waiting < 0 ? -1 : 0;
        if (!*s->next) return 1;
        s->line++;
        s->next += strcspn(s->next, "\n");
        if (*s->next) *s->next++ = 0;
        line[strcspn(line, "\r")] = 0;
        count = cut(line, words);
        if (count && other_line(s, w, words, count)) return -1;
    }
}
