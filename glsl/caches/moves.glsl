// How far caches move off their nodes: six numbers each, along +x, −x, +y, −y, +z, −z, in steps of a cell.
#ifndef CACHES_MOVES
#define CACHES_MOVES

// How far before the surfaces that ask for it a cache lies at least, cells.
const float MARGIN = 0.1;
const float LONGEST_MOVE = 2.0;
const float MOVE_STEPS = 65536.0;

#endif
