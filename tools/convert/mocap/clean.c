#include "clean.h"

#include <string.h>

#include "contacts.h"
#include "gaps.h"
#include "jitter.h"

#define FEET (CLEAN_ROOT | CLEAN_CONTACTS | CLEAN_KEYS)

int clean_parse(const char *text, unsigned *what)
{
    static const char *const words[] = { "gaps", "jitter", "root", "contacts", "contact-keys" };
    *what = 0;
    if (strcmp(text, "off") == 0) return 0;
    if (strcmp(text, "all") == 0) {
        *what = CLEAN_GAPS | CLEAN_JITTER | CLEAN_ROOT | CLEAN_CONTACTS;
        return 0;
    }
    for (const char *word = text;; word++) {
        const size_t length = strcspn(word, ",");
        unsigned bit = 0;
        for (unsigned i = 0; i < sizeof words / sizeof words[0]; i++) {
            if (strlen(words[i]) == length && strncmp(words[i], word, length) == 0) bit = 1u << i;
        }
        if (!bit) return 1;
        *what |= bit;
        word += length;
        if (!*word) return 0;
    }
}

static int fill_gaps(const raw_skeleton *skeleton, raw_clip *clip, FILE *report)
{
    gaps_report r = { 0, 0, 0, 0, 0.0 };
    if (gaps_fill(skeleton, clip, &r)) return 1;
    if (report && (r.filled || r.left)) {
        fprintf(report, "clean '%s': filled %u gaps in %u tracks, the longest of %.3f s; left %u longer than %.0f s\n",
                clip->name, r.filled, r.tracks, r.longest_s, r.left, GAPS_LONGEST_S);
    }
    return 0;
}

static int filter_jitter(const raw_skeleton *skeleton, raw_clip *clip, FILE *report)
{
    jitter_report r = { 0, 0.0, 0.0, 0.0, 0.0, 0.0 };
    if (jitter_filter(skeleton, clip, &r)) return 1;
    if (report && r.tracks) {
        fprintf(report,
                "clean '%s': jitter of %u tracks filtered (up to %.2f degrees, %.2f cm; from %.1f Hz on); joints moved "
                "by %.3f cm (root mean square), %.3f at most\n",
                clip->name, r.tracks, r.degrees, r.cm, r.cutoff_hz, r.moved_cm, r.worst_cm);
    }
    return 0;
}

static int has_markers(const raw_clip *clip)
{
    for (uint32_t i = 0; i < clip->event_count; i++) {
        if (clip->events[i].is_marker) return 1;
    }
    return 0;
}

static int add_keys(const contacts *c, raw_clip *clip, FILE *report, FILE *warnings)
{
    uint32_t added = 0;
    const int failed = contacts_add_keys(c, clip, &added);
    if (report && added) {
        fprintf(report, "clean '%s': %u callback keys where %u feet come down\n", clip->name, added, contacts_feet(c));
    } else if (warnings && !added && !failed) {
        fprintf(warnings,
                "warning: clip '%s' has no contact-keys: no foot comes down in it; if it has steps, give keys with "
                "--events\n",
                clip->name);
    }
    return failed;
}

static int use_feet(const raw_skeleton *skeleton, raw_clip *clip, unsigned what, FILE *report, FILE *warnings)
{
    int failed;
    uint32_t marked = 0;
    contacts *c = contacts_find(skeleton, clip, &failed);
    if (failed) return 1;
    if (!c) {
        FILE *out = what & CLEAN_KEYS ? warnings : report;
        if (out) {
            fprintf(out, "%s '%s': no feet: no joints in the lowest tenth of the body%s\n",
                    what & CLEAN_KEYS ? "warning: clip" : "clean", clip->name,
                    what & CLEAN_KEYS ? ", so it has no contact-keys: give them with --events" : "");
        }
        return 0;
    }
    if ((what & CLEAN_ROOT) && contacts_on_the_spot(c)) {
        const double gone = contacts_move_root(c, skeleton, clip) * skeleton->unit_cm;
        if (report) fprintf(report, "clean '%s': the root moves %.1f cm, derived from the feet\n", clip->name, gone);
    } else if ((what & CLEAN_ROOT) && report) {
        fprintf(report, "clean '%s': its root already moves, and was left unchanged\n", clip->name);
    }
    if ((what & CLEAN_CONTACTS) && !has_markers(clip)) {
        failed = contacts_mark(c, skeleton, clip, &marked);
        if (report) fprintf(report, "clean '%s': %u feet come down %u times\n", clip->name, contacts_feet(c), marked);
    }
    if (!failed && (what & CLEAN_KEYS)) failed = add_keys(c, clip, report, warnings);
    contacts_free(c);
    return failed;
}

int clean_set(raw_set *set, unsigned what, FILE *report, FILE *warnings)
{
    for (uint32_t i = 0; i < set->clip_count; i++) {
        raw_clip *clip = &set->clips[i];
        if (!clip->joint_count) continue;
        if (what) clip->source = NULL;
        if ((what & CLEAN_GAPS) && fill_gaps(&set->skeleton, clip, report)) return 1;
        if ((what & CLEAN_JITTER) && filter_jitter(&set->skeleton, clip, report)) return 1;
        if ((what & FEET) && use_feet(&set->skeleton, clip, what, report, warnings)) return 1;
    }
    return 0;
}
