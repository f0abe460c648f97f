// Pass I's own anti-aliasing: a 3x3 Gaussian over the peripheral half of the reduced buffer, which goes round in v and
// ends in u. Runs over the columns from w / 2, first along u, then along v (1 2 1 each).
#version 460

layout(constant_id = 0) const uint kAlongV = 0u;

layout(set = 0, binding = 0) uniform sampler2D samples;

layout(location = 0) out vec4 color;

void main() {
    ivec2 size = textureSize(samples, 0);
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 before = ivec2(max(texel.x - 1, 0), texel.y);
    ivec2 after = ivec2(min(texel.x + 1, size.x - 1), texel.y);
    if (kAlongV == 1u) {
        before = ivec2(texel.x, texel.y > 0 ? texel.y - 1 : size.y - 1);
        after = ivec2(texel.x, texel.y + 1 < size.y ? texel.y + 1 : 0);
    }
    color = 0.25 * (texelFetch(samples, before, 0) + texelFetch(samples, after, 0)) + 0.5 * texelFetch(samples, texel, 0);
}
