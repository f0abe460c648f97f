// Pass I's own anti-aliasing: a 3x3 Gaussian (1 2 1 by 1 2 1) over the peripheral half of the reduced buffer, which
// goes round in v and ends in u. Runs over the columns from w / 2.
#version 460

layout(set = 0, binding = 0) uniform sampler2D reduced;

layout(location = 0) out vec4 color;

vec4 column(int u, ivec3 v) {
    return texelFetch(reduced, ivec2(u, v.x), 0) + 2.0 * texelFetch(reduced, ivec2(u, v.y), 0) +
           texelFetch(reduced, ivec2(u, v.z), 0);
}

void main() {
    ivec2 size = textureSize(reduced, 0);
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int above = texel.y > 0 ? texel.y - 1 : size.y - 1;
    int below = texel.y + 1 < size.y ? texel.y + 1 : 0;
    ivec3 v = ivec3(above, texel.y, below);
    color = (column(max(texel.x - 1, 0), v) + 2.0 * column(texel.x, v) + column(min(texel.x + 1, size.x - 1), v)) / 16.0;
}
