#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/particles.glsl"
#include "particles/again.glsl"
#include "particles/link_direction.glsl"
#include "particles/moved.glsl"
#include "particles/places.glsl"

// Which links may be others since something moved: all of a particle that moved, those that end on or near what moved, and those that a box around it as it is now
// crosses. What lies behind mirrors, glass and coats may be anywhere: links to the first two, and those that scatter, are always traced again. So are, in a second
// run, those that bring light, of particles of which any link is traced again: what the links of a particle bring is held as a sum.
//
// Eight invocations share the links of a particle, 32 at a time, so that neighbours in the list go about the same way.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer moved_triangles;
layout(set = 0, binding = 1) uniform samplerBuffer boxes;
layout(set = 0, binding = 2) uniform usamplerBuffer touched;
layout(set = 0, binding = 3) uniform usamplerBuffer links;         // four a texel
layout(set = 0, binding = 4) uniform samplerBuffer strata;   // strata.comp
layout(set = 0, binding = 5) buffer States { uint states[]; };  // of each particle of the chunk (moved.glsl)
layout(set = 0, binding = 6) buffer Head { uint head[]; };
layout(set = 0, binding = 7) writeonly buffer Again { uint again[]; };

layout(push_constant, scalar) uniform Push {
    uint first;         // particle of the chunk
    uint count;         // particles of the chunk
    uint gather_side;   // strata a side
    uint scatter_side;
    uint before_count;  // boxes around what moved, as it was; those as it is lie behind
    uint box_count;
    uint capacity;      // of the list
    uint lights;        // 1: the second run
} push;

const uint SHARES = 8u;
const uint BLOCK = 32u;
// Boxes around what moved, as it is.
const uint MOST_BOXES = 4u;
// Spacings that a link may be longer than the way to the particle that it ends on.
const float LONGER = 3.0;

// A box as the particle sees it: the cone around it, in the frame of the particle's normal.
struct Sight {
    vec3 axis;
    vec2 half_angle;  // cosine, sine
};

uint particle;
vec3 position;
vec3 normal;
bool moved;
Frame frame;
// Of the boxes as they are, corners as seen from the particle.
Sight sights[MOST_BOXES];
vec3 lows[MOST_BOXES];
vec3 highs[MOST_BOXES];

Sight sight_of(vec3 low, vec3 high) {
    vec3 way = 0.5 * (low + high);
    float away = length(way);
    float sine = 0.5 * length(high - low) / max(away, 1e-30);
    vec3 farthest = mix(low, high, greaterThan(normal, vec3(0.0)));
    if (dot(farthest, normal) <= 0.0) {
        return Sight(vec3(0.0), vec2(2.0, 0.0));  // below the surface: no stratum
    }
    // Around the particle: every stratum.
    return sine >= 1.0 ? Sight(vec3(0.0), vec2(-2.0, 0.0)) : Sight(to_local(frame, way / away), vec2(sqrt(1.0 - sine * sine), sine));
}

// Whether links of a stratum may pass a box.
bool may_cross(vec4 stratum) {
    vec3 axis = vec3(stratum.xy, sqrt(max(1.0 - dot(stratum.xy, stratum.xy), 0.0)));
    bool may = false;
    for (uint number = 0u; number < MOST_BOXES; ++number) {
        Sight sight = sights[number];
        may = may || dot(axis, sight.axis) >= stratum.z * sight.half_angle.x - stratum.w * sight.half_angle.y;
    }
    return may;
}

// Whether a link passes a box before `end`.
bool passes(vec3 low, vec3 high, vec3 inverse, float end) {
    vec3 near = min(low * inverse, high * inverse);
    vec3 far = max(low * inverse, high * inverse);
    return max(max(near.x, near.y), max(near.z, 0.0)) <= min(min(far.x, far.y), min(far.z, end));
}

// Whether a link is another one in any case, and whether it may be.
bvec2 is_touched(uint link, uint word) {
    bool ends = ends_on_particle(word);
    bool dark = word == DARK_LINK;
    uint end = ends ? particle_of_link(word) : 0u;
    bool surely = moved || (ends && (touched_bits(touched, end) & TOUCHED) != 0u) || (SPECULAR_LOBES != 0u && (dark || scatter_link_of(particle, link, push.gather_side, push.scatter_side) != NO_SCATTER_LINK));
    return bvec2(surely, !surely && (dark || may_cross(texelFetch(strata, int(link)))));
}

// Whether the link passes a box.
bool is_crossed(uint link, uint word) {
    bool dark = word == DARK_LINK;
    vec3 direction = to_world(frame, cosine_direction(link_square(particle, link, push.gather_side)));
    vec3 inverse = 1.0 / mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    float end = 3e38;
    if (ends_on_particle(word)) {
        end = distance(position, uintBitsToFloat(texelFetch(particle_places, int(particle_of_link(word))).xyz)) + LONGER * particle_spacing;
    }
    bool met = false;
    for (uint number = 0u; number < MOST_BOXES; ++number) {
        met = met || passes(lows[number], highs[number], inverse, end);
    }
    // It may have ended on what moved, where no particle is.
    [[dont_unroll]] for (uint number = 0u; dark && !met && number < push.before_count; ++number) {
        met = passes(low_corner(boxes, number) - position, high_corner(boxes, number) - position, inverse, end);
    }
    return met;
}

bool may_bring_light(uint word) {
    return word == DARK_LINK || (ends_on_particle(word) && (word & BRINGS_LIGHT) != 0u);
}

void main() {
    uint own = gl_GlobalInvocationID.x / SHARES;
    bool exists = own < push.count && (push.lights == 0u || states[min(own, push.count - 1u)] >= TRACED_AGAIN);
    own = min(own, push.count - 1u);
    particle = push.first + own;
    uvec4 record = texelFetch(particle_places, int(particle));
    position = uintBitsToFloat(record.xyz);
    normal = unpack_direction(record.w);
    moved = has_moved(moved_triangles, texelFetch(particle_places, second_place(particle_places, particle)).y);
    frame = frame_around(normal);
    for (uint number = 0u; number < MOST_BOXES; ++number) {
        uint box = push.before_count + number;
        bool exists = box < push.box_count;
        lows[number] = exists ? low_corner(boxes, box) - position : vec3(1e30);
        highs[number] = exists ? high_corner(boxes, box) - position : vec3(1e30);
        sights[number] = exists ? sight_of(lows[number], highs[number]) : Sight(vec3(0.0), vec2(2.0, 0.0));
    }
    uint link_count = push.gather_side * push.gather_side;
    bool any_again = false;
    uint escaping = 0u;
    uint end = exists ? link_count : 0u;
    [[dont_unroll]] for (uint first = BLOCK * (gl_GlobalInvocationID.x % SHARES); first < end; first += BLOCK * SHARES) {
        uint base = own * link_count + first;
        uint surely = 0u;
        uint maybe = 0u;
        uint looked_at = 0u;
        uint escaped = 0u;
        [[dont_unroll]] for (uint i = 0u; i < BLOCK; i += 4u) {
            uvec4 words = texelFetch(links, int((base + i) / 4u));
            for (uint j = 0u; j < 4u; ++j) {
                bvec2 is = is_touched(first + i + j, words[j]);
                surely |= (is.x ? 1u : 0u) << (i + j);
                maybe |= (is.y ? 1u : 0u) << (i + j);
                looked_at |= (push.lights == 0u || may_bring_light(words[j]) ? 1u : 0u) << (i + j);
                escaped |= (words[j] == ESCAPED_LINK ? 1u : 0u) << (i + j);
            }
        }
        // Few of them: branches around so much work would be passed through all the same on devices that mask them.
        [[dont_unroll]] for (uint left = maybe & looked_at; left != 0u; left &= left - 1u) {
            uint i = uint(findLSB(left));
            surely |= (is_crossed(first + i, texelFetch(links, int((base + i) / 4u))[i & 3u]) ? 1u : 0u) << i;
        }
        uint wanted = looked_at & (push.lights == 0u ? surely : ~surely);
        escaping += uint(bitCount(escaped & ~wanted));
        if (wanted != 0u) {
            any_again = true;
            uint place = atomicAdd(head[AGAIN_COUNT], uint(bitCount(wanted)));
            [[dont_unroll]] for (uint left = wanted; left != 0u; left &= left - 1u) {
                if (place < push.capacity) {
                    again[place] = base + uint(findLSB(left));
                }
                ++place;
            }
        }
    }
    if (exists && push.lights == 0u) {
        if (any_again) {
            atomicOr(states[own], TRACED_AGAIN);
        }
        if (escaping > 0u) {
            atomicAdd(states[own], escaping);
        }
    }
}
