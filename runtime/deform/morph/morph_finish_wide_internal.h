/* morph_finish_wide_internal.h (private to deform/): the kernel of morph_finish_template.h with AVX2: noh_v8_finish. */
#ifndef NOH_DEFORM_MORPH_FINISH_WIDE_INTERNAL_H
#define NOH_DEFORM_MORPH_FINISH_WIDE_INTERNAL_H

#include "core/base/simd_internal.h"
#include "deform/morph/morph_finish_internal.h"
#include "core/base/compiler_internal.h"

#ifdef NOH_AVX2_AT_RUN_TIME
#define LANES(name) noh_v8_##name
#define LANES_TYPE noh_v8
#define LANES_COUNT 8
#define LANES_INLINE NOH_TARGET_AVX2 NOH_ALWAYS_INLINE
#include "deform/morph/morph_finish_template.h"
#endif

#endif
