// Finds where in the list each row's texels begin. One group.
#version 460
#define LIST_SET 0
#define WRITE_LIST
#include "texel_list.glsl"

const uint kThreads = 256u;
layout(local_size_x = 256) in;

shared uint counted[kThreads];

uint count_of(uint row) {
    uint count = 0u;
    for (uint word = 0u; word < words_of_row(); ++word) count += bitCount(words[word * list.height + row]);
    return count;
}

void main() {
    uint each = (list.height + kThreads - 1u) / kThreads;
    uint first = min(gl_LocalInvocationIndex * each, list.height);
    uint last = min(first + each, list.height);
    uint sum = 0u;
    for (uint row = first; row < last; ++row) {
        first_of_row[row] = sum;
        sum += count_of(row);
    }
    counted[gl_LocalInvocationIndex] = sum;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < gl_LocalInvocationIndex; ++i) before += counted[i];
    for (uint row = first; row < last; ++row) first_of_row[row] += before;
    if (gl_LocalInvocationIndex == kThreads - 1u) {
        list.count = before + sum;
        uint groups = (list.count + kTexelsPerGroup - 1u) / kTexelsPerGroup;
        list.groups_x = min(groups, kMostGroups);
        list.groups_y = (groups + kMostGroups - 1u) / kMostGroups;
    }
}
