// Paths of virtual point lights: n VPLs of one bounce, of which a share p̄ sends a path on to the next (Keller 1997).
#ifndef VPL_PATHS
#define VPL_PATHS

struct Bounce {
    uint parents;       // the first VPL of the bounce that paths leave from
    uint parent_count;
    uint children;      // the first VPL of the bounce that paths lead to
    uint child_count;
    uint number;        // of that bounce; the light's own reflection is 1
};

// The VPL that path `child` leaves from: one of the equal shares of all parents that each path gets, so that a parent sends child_count/parent_count
// paths on average and neighbours do not both.
uint parent_of_path(Bounce bounce, uint child, float random) {
    float place = (float(child) + random) * (float(bounce.parent_count) / float(bounce.child_count));
    return bounce.parents + min(uint(place), bounce.parent_count - 1u);
}

uint seed_of_bounce(Bounce bounce) {
    return 0x9E3779B9u * bounce.number;
}

#endif
