// Rec. 709 primaries throughout; all values linear unless a name says otherwise.
#ifndef LIB_COLOR
#define LIB_COLOR

// The weight of each primary in perceived brightness (Rec. ITU-R BT.709), for any radiometric quantity.
float luminance(vec3 color) {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// IEC 61966-2-1: the curve that an 8-bit image is stored with.
vec3 srgb_encode(vec3 linear) {
    vec3 low = 12.92 * linear;
    vec3 high = 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

#endif
