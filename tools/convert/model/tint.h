/* tint.h: which materials take the tint of an instance. */
#ifndef NOH_CONVERT_MODEL_TINT_H
#define NOH_CONVERT_MODEL_TINT_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 1 if an instance's tint colours the material. By default it does not colour skin, eyes and teeth, found by surface or
 * by the words of the name: a change of clothes must not colour the face. */
int tint_is_taken(const model_material *m);

/* --tint MATERIAL=on|off, for all materials of that name. 1 with the error: no material has the name, or it is neither
 * on nor off. */
int tint_assign(model *m, const char *assignment, model_error *error);

#ifdef __cplusplus
}
#endif

#endif
