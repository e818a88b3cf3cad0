// Lists of the surfaces behind each texel (Yang et al. 2010; Quyen 2014, section 3.3.2.1), in texels of four words:
//
//   pixels   1   first node, NO_NODE if none | least depth of its nodes | complement of the largest | nothing
//   nodes    1   depth | normal | next node, NO_NODE after the last | material
//
// Depths are linear, in metres, as bits of a float: of positive floats these are ordered as the floats are. All ones mean nothing in each word of
// `pixels`, so that one fill empties all lists. The paper's node has 12 bytes; with the material, which tells what a photon that lands there does
// next, it has 16: one fetch of a texel buffer.
#ifndef PHOTON_LISTS_NODE
#define PHOTON_LISTS_NODE

const uint NO_NODE = 0xFFFFFFFFu;

// No list has more nodes than there are: walks along one end there, whatever the lists hold.
#define FOR_NODES_OF_LIST(index) for (int left = textureSize(list_nodes); index != NO_NODE && left > 0; --left)

#endif
