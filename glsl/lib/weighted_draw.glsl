// One of several things, drawn with a chance in proportion to its weight while they are met one after the other (a reservoir of one, Chao 1982), by a single random number.
#ifndef LIB_WEIGHTED_DRAW
#define LIB_WEIGHTED_DRAW

struct WeightedDraw {
    float random;  // 0 to 1, of what is still undecided
    float sum;
    int drawn;     // -1: nothing had a weight
};

WeightedDraw start_draw(uint bits) {
    return WeightedDraw(float(bits >> 8) / 16777216.0, 0.0, -1);
}

// `weight`: above 0.
void offer(inout WeightedDraw draw, int thing, float weight) {
    float before = draw.sum;
    draw.sum += weight;
    float place = draw.random * draw.sum;
    bool taken = place < weight;
    draw.random = (taken ? place : place - weight) / (taken ? weight : before);
    draw.drawn = taken ? thing : draw.drawn;
}

#endif
