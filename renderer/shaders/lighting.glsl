// Light and surfaces: the sky, the GGX microfacet model, the tone curve. Reads the `lighting` block.
#ifndef LIGHTING_GLSL
#define LIGHTING_GLSL

const float kInversePi = 0.31830989;

struct Surface {
    vec3 normal;      // unit, world
    vec3 base_color;  // linear
    float metallic;
    float roughness;  // perceptual; alpha = roughness^2
};

// Clear-sky radiance: the horizon's colour gives way to the zenith's; below the horizon lies the ground.
vec3 sky_radiance(vec3 direction) {
    float up = clamp(direction.y, 0.0, 1.0);
    float haze = (1.0 - up) * (1.0 - up);
    vec3 sky = mix(lighting.sky_zenith.rgb, lighting.sky_horizon.rgb, haze * haze);
    float below = clamp(-direction.y * 12.0, 0.0, 1.0);
    return mix(sky, lighting.sky_ground.rgb, below);
}

// The sky with the glow around the sun and its disc, for the background.
vec3 sky_with_sun(vec3 direction) {
    float cosine = clamp(dot(direction, lighting.sun_direction.xyz), 0.0, 1.0);
    float glow = cosine * cosine;
    glow *= glow;
    glow *= glow;
    glow *= glow;  // cos^16
    float disc = smoothstep(0.99985, 0.99993, cosine);
    return sky_radiance(direction) + lighting.sun_irradiance.rgb * (0.05 * glow * glow + 8.0 * disc);
}

// Mean sky radiance over a lobe as wide as the roughness: the step at the horizon is blurred by it.
vec3 sky_reflection(vec3 direction, float roughness) {
    float spread = max(roughness, 0.05);
    float above = smoothstep(-spread, spread, direction.y);
    float up = clamp(direction.y * (1.0 - 0.5 * roughness) + 0.25 * roughness, 0.0, 1.0);
    float haze = (1.0 - up) * (1.0 - up);
    vec3 sky = mix(lighting.sky_zenith.rgb, lighting.sky_horizon.rgb, haze * haze);
    return mix(lighting.sky_ground.rgb, sky, above);
}

// Irradiance / pi of the sky on a surface that faces `normal` (Ramamoorthi and Hanrahan 2001; the constants are
// folded into the coefficients).
vec3 ambient_light(vec3 n) {
    return max(vec3(0.0), lighting.ambient[0].rgb + lighting.ambient[1].rgb * n.y + lighting.ambient[2].rgb * n.z +
                              lighting.ambient[3].rgb * n.x + lighting.ambient[4].rgb * (n.x * n.y) +
                              lighting.ambient[5].rgb * (n.y * n.z) +
                              lighting.ambient[6].rgb * (3.0 * n.z * n.z - 1.0) +
                              lighting.ambient[7].rgb * (n.x * n.z) +
                              lighting.ambient[8].rgb * (n.x * n.x - n.y * n.y));
}

vec3 specular_at_normal(Surface s) { return mix(vec3(0.04), s.base_color, s.metallic); }

// BRDF times cosine for one light direction: GGX (Walter et al. 2007) with the height-correlated Smith term in
// Hammon's form (2017), Schlick's Fresnel, Lambert below it.
vec3 reflected(Surface s, vec3 to_eye, vec3 to_light) {
    vec3 half_way = normalize(to_eye + to_light);
    float n_l = clamp(dot(s.normal, to_light), 0.0, 1.0);
    float n_v = max(dot(s.normal, to_eye), 1e-3);
    float n_h = clamp(dot(s.normal, half_way), 0.0, 1.0);
    float v_h = clamp(dot(to_eye, half_way), 0.0, 1.0);
    float alpha = max(s.roughness * s.roughness, 1e-3);
    float alpha2 = alpha * alpha;
    float d = n_h * n_h * (alpha2 - 1.0) + 1.0;
    float distribution = alpha2 * kInversePi / (d * d);
    float visibility = 0.5 / max(mix(2.0 * n_l * n_v, n_l + n_v, alpha), 1e-4);
    float away = 1.0 - v_h;
    float away2 = away * away;
    vec3 f0 = specular_at_normal(s);
    vec3 fresnel = f0 + (1.0 - f0) * (away2 * away2 * away);
    vec3 diffuse = s.base_color * ((1.0 - s.metallic) * kInversePi) * (1.0 - fresnel);
    return (diffuse + fresnel * (distribution * visibility)) * n_l;
}

// Share of a uniform environment that a GGX surface reflects (Lazarov 2013's fit).
vec3 environment_reflectance(vec3 f0, float roughness, float n_v) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    vec2 scale_bias = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * scale_bias.x + scale_bias.y;
}

// Ambient light on a surface: `irradiance` over pi from its hemisphere, `mirrored` from the reflected direction.
vec3 ambient_reflected(Surface s, vec3 to_eye, vec3 irradiance, vec3 mirrored) {
    float n_v = clamp(dot(s.normal, to_eye), 0.0, 1.0);
    vec3 specular = environment_reflectance(specular_at_normal(s), s.roughness, n_v);
    return s.base_color * (1.0 - s.metallic) * (1.0 - specular) * irradiance + specular * mirrored;
}

// Radiance to display-linear [0, 1]: exposure, then a filmic curve (Narkowicz 2015's fit to ACES).
vec3 tone_mapped(vec3 radiance) {
    vec3 x = max(radiance, vec3(0.0)) * lighting.sun_direction.w;
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

#endif
