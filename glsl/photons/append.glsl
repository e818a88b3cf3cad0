// Places in the lists of photons. `counts` holds STAGE_WORDS words a list (photons/records.glsl), which follow what is appended.
#include "lib/append.glsl"

// One place in list `stage` for each invocation that has one `wanted` (lib/append.glsl).
#define APPEND_TO_STAGE(counts, stage, wanted, place)                                                            \
    {                                                                                                            \
        uint head = (stage) * STAGE_WORDS;                                                                       \
        APPEND(counts[head + COUNT_WORD], wanted, place, {                                                       \
            atomicMax(counts[head], (new_length + 63u) / 64u);                                                   \
            atomicMax(counts[head + DRAW_WORD + 1u], new_length);                                                \
        })                                                                                                       \
    }
