// Which triangle a pixel shows: its instance and its number in that (src/frame/drawn_triangles.rs).
#ifndef GEOMETRY_DRAWN_TRIANGLE
#define GEOMETRY_DRAWN_TRIANGLE

// The instance of a pixel that shows none.
const uint NOTHING_DRAWN = 0xFFFFFFFFu;

#endif
