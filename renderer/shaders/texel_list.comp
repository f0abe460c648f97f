// Writes the texels of each word to their place in the list: row after row.
#version 460
#define LIST_SET 0
#define WRITE_LIST
#include "texel_list.glsl"

layout(local_size_x = 64) in;

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint word = gl_GlobalInvocationID.y;
    if (row >= list.height) return;
    uint at = first_of_row[row];
    for (uint before = 0u; before < word; ++before) at += bitCount(words[before * list.height + row]);
    for (uint bits = words[word * list.height + row]; bits != 0u; bits &= bits - 1u, ++at)
        imageStore(listed, entry_at(at), uvec4(row << 16 | (kTexelsPerWord * word + uint(findLSB(bits)))));
}
