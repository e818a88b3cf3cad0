// Cascades of address volumes (Reich 2015, section 4.2.2): grids around the eye, each of R³ nodes at whole multiples of its cell from an anchor, which is the scene's
// middle at rest. The cell doubles from one to the next. A node's word in the list of addresses says which cache lies there: its number plus one, 0 while there is none.
//
// A volume begins R/2 − 1 nodes below the node under the eye, so that the box of half width (R/2 − 1) cells around the eye itself lies within it however the grid snaps. That
// box is the cascade's decision boundary: what is inside has all of its eight nodes, and moves smoothly with the eye. Over the outermost two cells, one of the next
// cascade, what is there belongs to both cascades by shares. What lies beyond the last boundary takes the nearest nodes of the last volume.
#ifndef CACHES_CASCADES
#define CACHES_CASCADES

struct Cascades {
    vec3 anchor_rs;
    float cell;      // of the finest, m
    vec3 eye;        // from the anchor
    int resolution;  // R
    int count;
};

// A point among the nodes of one cascade: the lowest of its eight nodes, counted in the volume, and where it is between these.
struct Place {
    int cascade;
    ivec3 lowest;
    vec3 along;
};

const uint NO_ADDRESS = 0xFFFFFFFFu;
// In place of an address while a cache is being made, and where there was no room for one.
const uint LOCKED = 0xFFFFFFFFu;
// Caches that one group of invocations lights.
const uint GROUP_CACHES = 8u;

float cell_of_cascade(Cascades cascades, int cascade) {
    return cascades.cell * float(1 << cascade);
}

// The volume's first node, counted from the anchor.
vec3 first_node(Cascades cascades, int cascade) {
    precise vec3 first = floor(cascades.eye / cell_of_cascade(cascades, cascade)) - float(cascades.resolution / 2 - 1);
    return first;
}

// The cascade whose boundary holds the point, and in `next` the share of the one after it.
int cascade_of(Cascades cascades, vec3 position_rs, out float next) {
    precise vec3 way = abs(position_rs - cascades.anchor_rs - cascades.eye);
    // In cells of the finest.
    precise float reach = max(way.x, max(way.y, way.z)) / cascades.cell;
    float half_width = float(cascades.resolution / 2 - 1);
    int cascade = 0;
    while (cascade + 1 < cascades.count && reach >= half_width * float(1 << cascade)) {
        ++cascade;
    }
    float inner = (half_width - 2.0) * float(1 << cascade);
    precise float share = (reach - inner) / float(2 << cascade);
    next = cascade + 1 < cascades.count ? clamp(share, 0.0, 1.0) : 0.0;
    return cascade;
}

Place place_in(Cascades cascades, int cascade, vec3 position_rs) {
    precise vec3 place = (position_rs - cascades.anchor_rs) / cell_of_cascade(cascades, cascade) - first_node(cascades, cascade);
    vec3 lowest = clamp(floor(place), vec3(0.0), vec3(float(cascades.resolution - 2)));
    return Place(cascade, ivec3(lowest), clamp(place - lowest, vec3(0.0), vec3(1.0)));
}

uint address_of(Cascades cascades, int cascade, ivec3 node) {
    int side = cascades.resolution;
    return uint(((cascade * side + node.z) * side + node.y) * side + node.x);
}

// Corner 0 to 7 of the eight nodes around a place.
ivec3 corner_of(int corner) {
    return ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
}

// From the lowest node's address to a corner's.
uint corner_offset(int resolution, int corner) {
    ivec3 node = corner_of(corner);
    return uint((node.z * resolution + node.y) * resolution + node.x);
}

int cascade_of_address(Cascades cascades, uint address) {
    return int(address) / (cascades.resolution * cascades.resolution * cascades.resolution);
}

// The node's number along each axis, counted from the anchor: the same in all frames.
ivec3 node_of_address(Cascades cascades, uint address) {
    int side = cascades.resolution;
    int index = int(address);
    ivec3 node = ivec3(index % side, index / side % side, index / (side * side) % side);
    return ivec3(first_node(cascades, cascade_of_address(cascades, address))) + node;
}

#endif
