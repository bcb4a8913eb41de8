/* contacts.h: finds when feet stand, and the motion of a body that stands on them.
 *
 * Feet are found by shape: joints with all descendants in the lowest tenth of the bind pose. A foot stands
 * while a point of it (a joint, or the end of the last) is low and slow; both have two thresholds, so that a foot at
 * one of them does not flicker. Heights are measured from each point's own floor, the height under which it is in a
 * twentieth of the frames: the ground is assumed to be level. Where the last frame is the first again, a foot that
 * stands across that seam comes down once.
 *
 * Mechanical capture (an exoskeleton) knows angles and no place: its root stays where it is, as it does in a walk made
 * on the spot for a game. The feet give its motion: at each step the root moves against the points that are
 * lowest, and, where it was held at one height, is lifted so that the lowest of them is at the floor. A body so
 * captured cannot jump. */
#ifndef NOH_CONVERT_MOCAP_CONTACTS_H
#define NOH_CONVERT_MOCAP_CONTACTS_H

#include "convert/clips/raw_clip.h"

#define CONTACT_FEET_MAX 8u

typedef struct contacts contacts;

/* NULL: out of memory, no feet, or no frames; *failed: it was memory. */
contacts *contacts_find(const raw_skeleton *skeleton, const raw_clip *clip, int *failed);
void contacts_free(contacts *c);

uint32_t contacts_feet(const contacts *c);
uint32_t contacts_joint(const contacts *c, uint32_t foot);
int contacts_stands(const contacts *c, uint32_t foot, uint32_t frame);

/* Whether the body stays within a tenth of its height of one place. */
int contacts_on_the_spot(const contacts *c);

/* Move the roots as the feet say, in a clip that stays on the spot. Returns the way gone along the floor, in the
 * skeleton's units. */
double contacts_move_root(const contacts *c, const raw_skeleton *skeleton, raw_clip *clip);

/* A sync marker at each time at which a foot comes down, of its joint's name; the first of those that do in one frame.
 * *added: how many. Returns 1 when out of memory. */
int contacts_mark(const contacts *c, const raw_skeleton *skeleton, raw_clip *clip, uint32_t *added);

/* A callback key at each of these times, of all feet: left_foot, right_foot, or foot for one that is neither, by the
 * names of the joint and of those above it, else by where it is in the bind pose (+x is left). The payload is the
 * foot's number, from 0 in the order of the joints, as a 64-bit integer. Feet of one side that come down together,
 * within 0.05 s, have one key. *added, and returns, as above. */
int contacts_add_keys(const contacts *c, raw_clip *clip, uint32_t *added);

#endif
