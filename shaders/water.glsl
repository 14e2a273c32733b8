// Clear water over a level floor: what its surface mirrors, and what it refracts, each with Fresnel's weight. The floor is lit
// through level water: no caustics, and no shadows on it.
#ifndef RELIEF_WATER_GLSL
#define RELIEF_WATER_GLSL

const float kWaterIndex = 1.333;
// Of light that comes evenly from everywhere (Judd 1942): from outside water lets T = 1 - integral of 2 F cos sin over the angles
// of incidence through; from inside it lets T / n^2 through and reflects the rest.
const float kWaterInnerReflectance = 0.4746, kWaterOuterTransmittance = 0.9336;

// The cosine between the ray inside and the normal, of the cosine between the ray outside and the normal, 0..1 (Snell).
float cosineInWater(float outside) {
    return sqrt(1.0 - (1.0 - outside * outside) / (kWaterIndex * kWaterIndex));
}

// The share of light that is reflected, the mean of both polarizations (Fresnel); `outside` as above.
float waterFresnel(float outside) {
    float inside = cosineInWater(outside);
    float s = (outside - kWaterIndex * inside) / (outside + kWaterIndex * inside);
    float p = (kWaterIndex * outside - inside) / (kWaterIndex * outside + inside);
    return 0.5 * (s * s + p * p);
}

// A line of sight in the water: where it meets the floor, and how long it is, in units of the object. Lines that rise meet
// nothing: they are a hundred depths of the floor long.
struct WaterRay {
    vec2 floorAt; // x and z
    float reach;
};

WaterRay waterRay(vec3 position, vec3 n, vec3 v) {
    vec3 d = refract(-v, n, 1.0 / kWaterIndex);
    float height = max(position.y - inputs.light.floorHeight, 0.0);
    float reach = min(height / max(-d.y, 1e-4), 100.0 * inputs.light.floorDepth);
    return WaterRay(position.xz + reach * d.xz, reach);
}

// How far along x and z the floor points of neighbouring pixels lie from `at`, in units of the object.
vec2 floorFootprint(vec2 at) {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = inputs.view.pictureSize;
    vec2 footprint = vec2(1e-6);
    for (int i = 0; i < 2; ++i) {
        ivec2 aside = i == 0 ? ivec2(1, 0) : ivec2(0, 1);
        ivec2 beside = all(lessThan(pixel + aside, size)) ? pixel + aside : pixel - aside;
        Seen other = seenAt(beside, 0);
        if (other.depth == 0.0) continue;
        vec3 there = positionOf((vec2(beside) + 0.5) / vec2(size) * 2.0 - 1.0, other.depth);
        footprint = max(footprint, abs(waterRay(there, other.normal, normalize(inputs.view.eye - there)).floorAt - at));
    }
    return footprint;
}

// The share of light tiles in a box of the floor: tiles are light and dark by turns, and the mean over a box of a product of square
// waves is the product of differences of triangle waves (Quilez, "Filtering the checkerboard pattern").
float lightTiles(vec2 at, vec2 footprint) {
    vec2 p = at / inputs.light.floorTile;
    vec2 w = max(footprint / inputs.light.floorTile, 1e-5 * max(abs(p), vec2(1))); // no less than differences of p are precise
    vec2 waves = 2.0 * (abs(fract(0.5 * (p - 0.5 * w)) - 0.5) - abs(fract(0.5 * (p + 0.5 * w)) - 0.5)) / w;
    waves = clamp(waves, vec2(-1), vec2(1));
    return 0.5 + 0.5 * waves.x * waves.y;
}

// What a length of water lets through, where floorDepth of it lets `color` through (Beer and Lambert).
vec3 throughWater(vec3 color, float reach) {
    return pow(max(color, vec3(1e-4)), vec3(reach / inputs.light.floorDepth));
}

// Light that leaves the floor along a line of sight, in the water. `irradiance` has come through the surface and down to the
// floor; what the floor scatters and the surface throws back meets the floor once more, and so on.
vec3 floorLight(WaterRay ray, vec3 color, vec3 irradiance) {
    vec3 albedo = inputs.light.floorColor;
    if (inputs.light.floorTile > 0.0) albedo *= mix(0.5, 1.0, lightTiles(ray.floorAt, floorFootprint(ray.floorAt)));
    vec3 back = albedo * kWaterInnerReflectance * color * color;
    return albedo * irradiance / (kPi * (1.0 - back));
}

// `color`: what floorDepth of the water lets through.
vec3 water(vec3 position, vec3 n, vec3 v, vec3 color, Material material) {
    float nv = max(dot(n, v), 1e-4), fresnel = waterFresnel(nv);
    vec3 mirrorLight = vec3(0), floorIrradiance = vec3(0);
    if (!kAddsLight) {
        // Lines below the horizon meet other waves, which mirror the sky about as far above it.
        vec3 mirrored = reflect(-v, n);
        float level = mirrorLevel(mirrored, material);
        mirrored.y = abs(mirrored.y);
        mirrorLight = textureLod(environmentMap, equirectangular(mirrored), level).rgb;
        floorIrradiance = irradiance(vec3(0, 1, 0)) * kWaterOuterTransmittance * throughWater(color, inputs.light.floorDepth);
    }

    vec3 l = inputs.light.keyDirection;
    if (l.y > 0.0) {
        vec3 down = throughWater(color, inputs.light.floorDepth / cosineInWater(l.y));
        floorIrradiance += inputs.light.keyRadiance * l.y * (1.0 - waterFresnel(l.y)) * down;
    }
    // Radiance shrinks by n^2 where light leaves the water.
    WaterRay ray = waterRay(position, n, v);
    vec3 light = floorLight(ray, color, floorIrradiance) * throughWater(color, ray.reach);
    light *= (1.0 - fresnel) / (kWaterIndex * kWaterIndex);
    light += fresnel * mirrorLight;

    // The sun's own picture on the waves.
    vec3 h = normalize(l + v);
    float nl = dot(n, l);
    if (nl > 0.0) {
        float lobe = keyLobe(nl, nv, clamp(dot(n, h), 0.0, 1.0), material.roughness);
        light += inputs.light.keyRadiance * keyVisibility(position, n) * lobe * waterFresnel(clamp(dot(v, h), 0.0, 1.0));
    }
    return light;
}
#endif
