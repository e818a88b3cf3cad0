// Morton (Z) order: consecutive indices stay close in the plane.
#ifndef LIB_MORTON
#define LIB_MORTON

uint even_bits(uint bits) {
    bits &= 0x55555555u;
    bits = (bits | bits >> 1) & 0x33333333u;
    bits = (bits | bits >> 2) & 0x0F0F0F0Fu;
    bits = (bits | bits >> 4) & 0x00FF00FFu;
    return (bits | bits >> 8) & 0x0000FFFFu;
}

ivec2 morton_decode(uint index) {
    return ivec2(even_bits(index), even_bits(index >> 1));
}

#endif
