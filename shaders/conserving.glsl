// The material that conserves energy: what the reflection leaves of the light is what the diffuse part scatters, and light
// that bounces between facets before it leaves counts (Fdez-Aguera, "A Multiple-Scattering Microfacet Model for Real-Time
// Image-based Lighting", 2019). With albedo 1 it reflects all light, whatever its roughness.
#ifndef RELIEF_CONSERVING_GLSL
#define RELIEF_CONSERVING_GLSL

// How much of what a surface mirrors is seen, by how much of its whole half space is (Lagarde and de Rousiers, "Moving
// Frostbite to Physically Based Rendering", 2014).
float specularOpenness(float open, float nv, float roughness) {
    return clamp(pow(nv + open, exp2(-16.0 * roughness - 1.0)) - 1.0 + open, 0.0, 1.0);
}

// How far what the pixels beside this one mirror is from what it mirrors: a chord, which is nearly the angle in radians.
float mirrorFootprint(vec3 mirrored) {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = inputs.view.pictureSize;
    float footprint = 0.0;
    for (int i = 0; i < 2; ++i) {
        ivec2 aside = i == 0 ? ivec2(1, 0) : ivec2(0, 1);
        ivec2 beside = all(lessThan(at + aside, size)) ? at + aside : at - aside;
        Seen other = seenAt(beside, 0);
        if (other.depth == 0.0) continue;
        vec3 there = positionOf((vec2(beside) + 0.5) / vec2(size) * 2.0 - 1.0, other.depth);
        footprint = max(footprint, distance(reflect(normalize(there - inputs.view.eye), other.normal), mirrored));
    }
    return footprint;
}

// The level of the environment whose texels are as large as what a pixel mirrors, or as rough as the surface. Levels of less
// than 128 rows are blurred as rough surfaces do it, which is too much for a pixel's footprint.
float mirrorLevel(vec3 mirrored, Material material) {
    float rows = float(textureSize(environmentMap, 0).y), texel = kPi / rows;
    float footprint = log2(max(mirrorFootprint(mirrored), texel) / texel);
    return max(material.environmentLevel, min(footprint, max(log2(rows / 128.0), 0.0)));
}

// GGX as in keySpecular(), without Fresnel's factor. The sun and lamps are not points: the lobe has a least width.
float keyLobe(float nl, float nv, float nh, float roughness) {
    float r = max(roughness, 0.06), a2 = r * r * r * r;
    float d = (nh * a2 - nh) * nh + 1.0;
    float visibility = 0.5 / max(1e-5, nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    return a2 / (kPi * d * d) * visibility * nl;
}

// What is reflected after more than one facet, where one reflects `single`, and with Fresnel's factor 1 `whole`.
vec3 betweenFacets(vec3 single, vec3 f0, float whole) {
    vec3 mean = f0 + (1.0 - f0) / 21.0;
    return (1.0 - whole) * single * mean / (1.0 - (1.0 - whole) * mean);
}

vec3 conserving(vec3 position, vec3 n, vec3 v, vec3 albedo, Material material, float open) {
    float nv = max(dot(n, v), 1e-4), metallic = material.metallic;
    vec3 f0 = mix(vec3(0.04), albedo, metallic);

    // Shares of the light of an even environment: reflected by one facet, by several, and scattered from below, which is what
    // the dielectric part reflects in neither way.
    float whole = environmentBrdf(vec3(1), material.roughness, nv).x;
    vec3 dielectric = environmentBrdf(vec3(0.04), material.roughness, nv), metal = environmentBrdf(albedo, material.roughness, nv);
    vec3 dielectricMore = betweenFacets(dielectric, vec3(0.04), whole);
    vec3 single = mix(dielectric, metal, metallic);
    vec3 multiple = mix(dielectricMore, betweenFacets(metal, albedo, whole), metallic);
    vec3 scattered = (1.0 - metallic) * albedo * (1.0 - dielectric - dielectricMore);

    vec3 light = vec3(0);
    if (!kAddsLight) {
        vec3 mirrored = reflect(-v, n);
        float horizon = clamp(1.0 + 1.5 * dot(mirrored, n), 0.0, 1.0);
        vec3 around = textureLod(environmentMap, equirectangular(mirrored), mirrorLevel(mirrored, material)).rgb;
        if (kHasOcclusion) horizon *= specularOpenness(open, nv, material.roughness);
        light = around * single * horizon + irradiance(n) / kPi * (multiple + scattered) * open;
    }

    vec3 l = inputs.light.keyDirection, h = normalize(l + v);
    float nl = dot(n, l);
    if (nl > 0.0) {
        vec3 arriving = inputs.light.keyRadiance * keyVisibility(position, n);
        float x = 1.0 - clamp(dot(v, h), 0.0, 1.0);
        vec3 fresnel = f0 + (1.0 - f0) * (x * x * x * x * x);
        float lobe = keyLobe(nl, nv, clamp(dot(n, h), 0.0, 1.0), material.roughness);
        light += arriving * (fresnel * lobe + (multiple + scattered) * nl / kPi);
    }
    return light;
}
#endif
