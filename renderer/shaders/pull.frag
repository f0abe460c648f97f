// Pull-push (Gortler et al. 1996), the way down: four texels become one, the mean of those that are known (alpha).
#version 460

layout(set = 0, binding = 0) uniform sampler2D fine;

layout(location = 0) out vec4 color;

void main() {
    ivec2 last = textureSize(fine, 0) - 1;
    ivec2 corner = 2 * ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 at = corner + ivec2(i & 1, i >> 1);
        vec4 texel = texelFetch(fine, min(at, last), 0);
        // Beyond the edge there is nothing.
        float weight = at.x > last.x || at.y > last.y ? 0.0 : texel.a;
        sum += vec4(texel.rgb * weight, weight);
    }
    color = vec4(sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0), min(sum.a, 1.0));
}
