#ifndef AVERAGED_NORMAL_GLSL
#define AVERAGED_NORMAL_GLSL

// Averaging normals in the smaller levels of their map shortened them: what was lost there is roughness (Toksvig 2005).
float toksvig_roughness(float roughness, vec3 averaged) {
    float shortness = clamp(dot(averaged, averaged), 0.04, 1.0);
    float alpha = roughness * roughness;
    float variance = (1.0 - sqrt(shortness)) / sqrt(shortness);
    return sqrt(sqrt(clamp(alpha * alpha + min(2.0 * variance, 0.3), 0.0, 1.0)));
}

#endif
