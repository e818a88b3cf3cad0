// Slots of virtual area lights before those without flux are dropped: each view of the lights has a square of 4^order slots along Morton's curve (Morton 1966), of which
// slot s is the block of `side` × `side` texels in column x and row y, s = … y₁x₁y₀x₀ in binary. Blocks beyond the view's edge stay empty.
#ifndef CACHES_SLOTS
#define CACHES_SLOTS

struct SlotView {
    uint first;  // slot
    uint view;
};

uint every_second_bit(uint bits) {
    bits &= 0x55555555u;
    bits = (bits | bits >> 1) & 0x33333333u;
    bits = (bits | bits >> 2) & 0x0F0F0F0Fu;
    bits = (bits | bits >> 4) & 0x00FF00FFu;
    return (bits | bits >> 8) & 0x0000FFFFu;
}

ivec2 block_of_slot(uint slot) {
    return ivec2(every_second_bit(slot), every_second_bit(slot >> 1));
}

#endif
