// What the passes of the splatting tell each other (src/caustics/photons/splat.rs): eleven words.
#ifndef PHOTON_SPLAT_STATE
#define PHOTON_SPLAT_STATE

const uint STATE_ROWS = 0u;    // arguments of the dispatches over rows of cells (3), over blocks of tiles (3),
const uint STATE_BLOCKS = 3u;
const uint STATE_TILES = 6u;   // and over the tiles that photons reach (3): LISTED_A_ROW at most along x
const uint STATE_LISTED = 9u;  // number of such tiles
const uint STATE_LEVELS = 10u; // bit l: cells of level l hold photons

// A dispatch may have 65535 groups along an axis at most.
const uint LISTED_A_ROW = 32768u;

#endif
