// Pass I for the texels of a list.
#define LIST_SET 2
#include "pass_1.glsl"
#include "texel_list.glsl"

layout(set = LIST_SET, binding = 2) uniform restrict writeonly image2D reduced;

void shade_listed(uint index) {
    ivec2 texel = listed_texel(index);
    imageStore(reduced, texel, pass_1(vec2(texel) + 0.5));
}
