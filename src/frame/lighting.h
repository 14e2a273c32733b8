// Light and materials: environments, distant lights, and how surfaces shade in them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gpu/gpu.h"
#include "light/light.h"

namespace relief {

/// An environment on the host, ready to light with: equirectangular, whatever shape it was read in.
struct Environment {
    std::vector<Image> levels; ///< RGB radiance; level l is seen by a surface of roughness l / (levels.size() - 1)
    vec3 irradiance[9];        ///< coefficients of polynomials of the normal, see environment.glsl
    bool isSharp = false;      ///< level l of h rows is seen by a roughness of 2 / sqrt(h)
};

/// The built-in neutral studio: a soft sky, a large soft box, a rim light, a warm floor.
Environment studioEnvironment();

/// The studio as a picture.
EnvironmentPicture makeStudioPicture();

/// Prepares a picture of any shape. Its first level has 512 rows at most, or 2048 where mirrors show it (`isSharp`).
Environment makeEnvironment(const EnvironmentPicture& picture, bool isSharp = false);
/// Loads an environment of the shape that its sides say. Throws as readEnvironment does.
Environment loadEnvironment(const std::string& path);

/// Returns the irradiance coefficients of an environment that is turned about Y by `degrees`, counter-clockwise seen
/// from above.
std::array<vec3, 9> turnIrradiance(const vec3 (&irradiance)[9], double degrees);

/// An environment on the device, which owns its texture: what Lighting refers to.
struct GpuEnvironment {
    Texture levels; ///< one mip per level, RGBA
    vec3 irradiance[9]{};
    bool isSharp = false;

    /// The level that a surface of a roughness sees, from 0 on.
    [[nodiscard]] float levelOf(float roughness) const;
};

/// Uploads a copy of `environment`: later changes of it do not show.
GpuEnvironment uploadEnvironment(Device& device, const Environment& environment);

/// A light that is far away, besides the key light.
struct DistantLight {
    double azimuth = 0, elevation = 0; ///< degrees, as the camera's
    double strength = 1;               ///< radiance times pi
    vec3 color{1};                     ///< linear
};

struct Lighting {
    double keyAzimuth = -25, keyElevation = 50; ///< degrees, as the camera's
    double keyStrength = 2.9;                   ///< radiance times pi of the key light
    vec3 keyColor{1.0f, 0.97f, 0.92f};          ///< linear; slightly warm
    std::vector<DistantLight> others; ///< each with shadows of its own; added one after another to the picture's halves
    bool castsShadows = true;
    const GpuEnvironment* environment = nullptr; ///< null: studioEnvironment()
    double environmentAzimuth = 0;               ///< degrees that it is turned by about Y, as the camera's azimuth
    /// How far away the surface can hide the environment from itself, as a share of the diagonal of
    /// RenderOptions::bounds; 0: nothing does. Occluders are those that the picture shows.
    double occlusionRadius = 0;
};

struct Material {
    vec3 albedo{0.52f, 0.50f, 0.47f}; ///< linear; multiplies the albedo map where there is one
    float roughness = 0.4f;           ///< below 0.05 only of a material that conserves energy
    /// 0..1: of a material that conserves energy (shaders/conserving.glsl); empty: a dielectric that adds its
    /// reflection to all of the diffuse light. Where one instance has a value, all have: that of the others is 0.
    std::optional<float> metallic;
};

/// Coefficients of c = k_a c_a + k_d c_d (n.l) + k_s c_s (v.r)^e (Hart, eq. 16.20), with the albedo for c_a and c_d,
/// and white for c_s, all in the light of Lighting::key.
struct PhongCoefficients {
    float ambient = 0.2f, diffuse = 0.8f, specular = 0.3f, exponent = 40;

    bool operator==(const PhongCoefficients&) const = default;
};

/// How surfaces shade.
enum class Shading {
    physical, ///< the material, in the environment and distant lights
    phong,    ///< PhongCoefficients, in distant lights
    table,    ///< the same, looked up in a table by n.l and v.r (Hart, eq. 16.22)
    matcap,   ///< a picture of a ball, looked up by the normal as the eye sees it (Hart, eq. 16.14)
    water,    ///< clear, over WaterFloor: reflection and refraction by Fresnel's weights (shaders/water.glsl)
};

/// The level floor under Shading::water, whose material's albedo is what `depth` of the water lets through. It is lit
/// through level water, without caustics and shadows, and scatters evenly.
struct WaterFloor {
    double height = -0.5;            ///< world units, as all lengths here: its y
    double depth = 0.5;              ///< under level water, above 0
    vec3 color{0.60f, 0.54f, 0.42f}; ///< linear albedo, 0..1
    double tile = 0; ///< side of tiles, which have its color and half of it by turns from x = z = 0 on; 0: none
};

/// A picture of a ball on the device: what --shading matcap looks up.
struct GpuMatcap {
    Texture ball;
};

/// Uploads a square picture of a ball that fills it, 3 channels. Texels outside of the ball are replaced by the nearest
/// ones in it.
GpuMatcap uploadMatcap(Device& device, Image ball);

/// Texels of PhongCoefficients' table, kShadingTableSide squared, in rows of equal v.r from 0 at the top to 1: what
/// ambient and diffuse light is multiplied with the albedo by, and the highlight. n.l goes from 0 at the left to 1.
Image makeShadingTable(const PhongCoefficients& phong);

/// Renders a ball of a material in a light, without shadows, as an eye far away sees it from an azimuth and elevation
/// in degrees: `side` pixels squared, the ball filling them, 3 channels of linear light; black outside.
Image renderMatcap(Device& device, const Material& material, const Lighting& lighting, const dvec2& from,
                   int side = 512);

} // namespace relief
