// What the passes of the splatting tell each other (src/caustics/photons/splat.rs).
//
// Two lists of the tiles that photons may reach: the crowded ones, of which one group would take too long or, on a driver that ends loops after
// 65535 rounds, lose photons; and all others. For each: arguments of a dispatch of a group a tile, LISTED_A_ROW at most along x, and
// the number of tiles.
#ifndef PHOTON_SPLAT_STATE
#define PHOTON_SPLAT_STATE

const uint STATE_ROWS = 0u;     // arguments of the dispatches over rows of cells (3)
const uint STATE_BLOCKS = 3u;   // and over blocks of tiles (3)
const uint STATE_TILES = 6u;    // the list of ordinary tiles (4)
const uint STATE_CROWDED = 10u; // the list of crowded tiles (4)
const uint STATE_PARTS = 14u;   // arguments of a dispatch over the crowded tiles and their parts: rows of the list along z (3)
const uint STATE_LEVELS = 17u;  // bit l: cells of level l hold photons
const uint STATE_DROPPED = 18u; // photons left out since something of them is no number

// A dispatch may have 65535 groups along an axis at most.
const uint LISTED_A_ROW = 32768u;

// Photons of a part.
const uint PART_PHOTONS = 32000u;

#endif
