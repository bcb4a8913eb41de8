/* surface_kind.h: finds materials of skin, eyes, teeth and tongue, hair. */
#ifndef NOH_CONVERT_MODEL_SURFACE_KIND_H
#define NOH_CONVERT_MODEL_SURFACE_KIND_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The NOH_SURFACE_* called "plain", "skin", "eye", "teeth", "toon" or "hair"; MODEL_NONE for any other word. */
uint32_t surface_kind_named(const char *word);

/* By the words of a material's name (names.h) in English, German, French, Spanish, Portuguese, Italian, Dutch, Polish,
 * Russian, Japanese, Chinese and Korean: "EyeLeft", "head_skin.001", "Haut", "N00_000_Body_00_SKIN". A word ends where
 * letters do, and before a capital behind a small letter. The surroundings of an eye are excluded: lashes, brows,
 * lids, shadows, glasses. name: UTF-8; other bytes match no word. */
uint32_t surface_kind_of_name(const char *name);
/* The same of a material: hair that is opaque is plain, because only cards are known to have strands. */
uint32_t surface_kind_by_name(const char *name, model_alpha alpha);

/* Whether a part has no vertex colours, or white ones. */
int surface_is_white(const model_mesh *mesh, const model_submesh *part);

/* Whether a material's name means lashes, or, with all of its words, what is soft in a mouth, or a part of the body
 * that is skin unless it has a colour, or skin: "M_Face_L", and not "head_scarf", "Zombie_Skin" or "Mouth_Guard". */
int surface_is_lashes(const char *name);
int surface_is_gums(const char *name);
int surface_is_bare(const char *name);

/* 1 for the materials of VRoid Studio ("N00_000_00_Face_00_SKIN"), whose characters are drawn as toons, also where an
 * exporter dropped their MToon. */
int surface_is_of_vroid(const char *name);

/* Set a material's kind. Unlit materials stay plain. The default reflectance (0.04) becomes the surface's: 0.028 for
 * skin, 0.025 for eyes. */
void surface_kind_set(model_material *m, uint32_t kind);

/* Opaque materials whose names say nothing, and which are no metal, are eyes where all objects that have them are, by
 * the names of nodes or meshes: "Eye.L" of "Material.003".
 * returns  1: out of memory */
int surface_kinds_of_objects(model *m);

/* Make a material one that draws nothing. */
void surface_hide(model_material *m);

/* Opaque shells in front of eyes would hide them. Occlusion shells ("Eye_Occlusion") become black with an alpha of 0.2
 * and so darken; tear shells ("Tearline") are not drawn, because eyes gloss by themselves. Each adds a warning to the
 * model. A surface that --surface gave stays. Returns 0, or 1: out of memory. */
int surface_shells_set(model *m);

/* --surface MATERIAL=KIND, for all materials of that name. 1 with the error: no material has the name, or no surface.
 */
int surface_kind_assign(model *m, const char *assignment, model_error *error);

#ifdef __cplusplus
}
#endif

#endif
