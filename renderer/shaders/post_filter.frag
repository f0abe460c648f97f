// Post anti-aliasing of the screen: a Gaussian whose width grows with the distance from the gaze (Meng et al. 2018,
// Eq. 14, its bars read as floor): eta = 3 + 2 floor((r / e^L - 0.10) / 0.05), no filter below 0.10, eta no larger
// than the cap. The Gaussian has a standard deviation of eta / 6.
#version 460
#define METHOD_SET 0
#include "map_block.glsl"

layout(set = 0, binding = 1) uniform sampler2D screen;

layout(constant_id = 2) const int kLargestEta = 11;

layout(location = 0) out vec4 color;

void main() {
    ivec2 last = textureSize(screen, 0) - 1;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float share = length(gl_FragCoord.xy - map.gaze) / exp(map.log_max_radius);
    int eta = min(3 + 2 * int(floor((share - 0.10) / 0.05)), kLargestEta);
    int reach = share < 0.10 ? 0 : eta / 2;
    float sigma = float(2 * reach + 1) / 6.0;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            float weight = exp(-0.5 * float(x * x + y * y) / (sigma * sigma));
            sum += weight * texelFetch(screen, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).rgb;
            weights += weight;
        }
    }
    color = vec4(sum / weights, 1.0);
}
