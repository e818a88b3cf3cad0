// The numbers of a cache: c_lm of each channel, W/m², in texels of four. Bands above CHROMA are the luminance's alone, and in each cache of the colour of its band 0,
//
//   c_lm = c_00 · Y_lm/Y_00        l ≥ CHROMA
//
// which loses nothing of light that is of one colour. (Vardis et al. 2014, which the thesis names in section 6.3, keep differences of chroma in fewer bands: what comes from one side
// in red and from another in white is then grey in the bands that are left out.)
//
//   bands 3, chroma 3   red 0–3, red 4–7, green 0–3, …, blue 4–7, and the last of red, green, blue: 7 texels
//   bands 3, chroma 2   red 0–3, green 0–3, blue 0–3, luminance 4–7, and its last: 5
//   bands 3, chroma 1   band 0 of red, green, blue and the last of luminance, luminance 1–3, luminance 4–7: 3
//   bands 2, chroma 2   red 0–3, green 0–3, blue 0–3: 3
//   bands 2, chroma 1   band 0 of red, green, blue, luminance 1–3: 2
#ifndef VOLUMES_NUMBERS
#define VOLUMES_NUMBERS

layout(constant_id = 0) const uint BANDS = 3u;
// At most BANDS.
layout(constant_id = 5) const uint CHROMA = 3u;

const int TEXELS = BANDS == 3u ? (CHROMA == 3u ? 7 : CHROMA == 2u ? 5 : 3) : CHROMA == 2u ? 3 : 2;

#endif
