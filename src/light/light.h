// Pictures of the light that arrives from all directions, in three shapes: read, converted, blurred, written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/base.h"

namespace relief {

// --- shapes -------------------------------------------------------------------------------------------------------

enum class EnvironmentShape {
    equirect, ///< longitude and latitude: twice as wide as high, -Z in the middle, +X to the right of it, +Y at the top
    cube,     ///< six square faces
    sphere,   ///< a mirroring ball, seen from +Z at a great distance: square, black outside of the ball
};

/// Where the faces of a cube are.
enum class CubeLayout {
    files,  ///< six files, whose names have px, nx, py, ny, pz and nz where the path has {face}
    cross,  ///< four by three faces: nx pz px nz in the middle row, py above pz, ny below it
    column, ///< three by four faces: py, below it nx pz px, below pz ny, and nz below that, turned half around
    strip,  ///< six faces side by side, in the order of Vulkan
};

/// Radiance by direction: linear RGB, at least 0.
///
/// Faces of a cube have the order and the orientation of Vulkan's cube maps (+X -X +Y -Y +Z -Z), in a system with x to
/// the right, y up and z forward, as pictures of cubes have. The world looks along -Z: a direction (x, y, z) of the
/// world is (x, y, -z) in that system, so that every face shows what is seen from the inside, not mirrored. Face pz is
/// in front, px on the right.
struct EnvironmentPicture {
    EnvironmentShape shape = EnvironmentShape::equirect;
    std::vector<Image> images; ///< 3 channels; one of them, or the six faces of a cube

    /// Texels along a side of the picture, or of each face: of an equirectangular one its height.
    [[nodiscard]] int side() const { return images.front().height; }
};

inline constexpr int kCubeFaces = 6;

/// Number of pictures that a shape consists of.
constexpr int countImages(EnvironmentShape shape) { return shape == EnvironmentShape::cube ? kCubeFaces : 1; }

/// A point of a picture: the number of the image, and the point of it from (0,0) at the top left to (1,1).
struct PicturePoint {
    int image = 0;
    dvec2 at{0};
};

/// The unit direction of a point of a picture. Points outside of the ball of a sphere have that of its rim, -Z; points
/// beside a face of a cube continue its plane.
dvec3 directionOf(EnvironmentShape shape, const PicturePoint& point);

/// The point of a picture that shows a direction, which need not be of length 1.
/// Cube: Hart, eq. 16.19. Sphere: the inverse of his eq. 16.14 to 16.18, n = (r + v) / |r + v|.
PicturePoint pointOf(EnvironmentShape shape, const dvec3& direction);

/// Radiance from a direction, bilinear between texels: across the edges of cubes, the seam and the poles of an
/// equirectangular picture, and of a sphere map up to the last texels that lie in the ball with all of their area
/// (fillRing).
dvec3 lookUp(const EnvironmentPicture& picture, const dvec3& direction);

/// Replaces texels of a sphere map that are not wholly in the ball by means of the nearest ones that are. Directions
/// within about 4 / sqrt(side) of -Z, in radians, lie in the last ring of texels: a sphere map holds no more of them.
void fillRing(Image& sphere);

// --- other shapes and sizes ---------------------------------------------------------------------------------------

/// Height, or side of a face, of a picture of `shape` with about as many texels per radian as `picture` has in the
/// middle of its image: the same for a cube of side n, an equirectangular picture of height 2 n, and a sphere map of
/// side 4 n.
int sideOf(const EnvironmentPicture& picture, EnvironmentShape shape);

/// Makes a picture of another shape or size. Every texel is the mean of 2 x 2 to 24 x 24 lookups, so many that they are
/// nearer to each other than the texels of the source; of a sphere map of those in the ball alone.
EnvironmentPicture convert(const EnvironmentPicture& picture, EnvironmentShape shape, int side);

/// Blurs as a surface of roughness 0..1 does what it mirrors: the mean of the picture, weighted by the lobe of GGX
/// around every direction, with view and normal along it.
EnvironmentPicture blur(const EnvironmentPicture& picture, double roughness);

// --- equirectangular pictures, texel by texel ---------------------------------------------------------------------

/// Unit direction of the centre of a texel.
dvec3 texelDirection(const Image& equirect, int x, int y);
/// Solid angle of the texels of a row, steradians.
double texelSolidAngle(const Image& equirect, int y);
/// A picture of half the width and height, by means of 2 x 2 texels.
Image halved(const Image& from);
/// `source` seen by a GGX lobe of this roughness around every direction of a picture of the given size.
Image convolved(const Image& source, int width, int height, double roughness);

// --- files --------------------------------------------------------------------------------------------------------

/// What a file was taken for.
struct EnvironmentFile {
    EnvironmentPicture picture;
    CubeLayout layout = CubeLayout::files; ///< of a cube
    bool isChosen = false;                 ///< no shape was asked for: it is that of the picture's sides
};

/// Largest radiance of a file. The sun has 1.6e9 candela per square metre, and sums over all pixels stay finite.
inline constexpr float kMostRadiance = 1e12f;

/// Reads an environment. A path with {face} stands for six files, whose names have px nx py ny pz nz there, or posx
/// negx and so on, or right left up down front back. Without a shape, the sides of the picture decide: 2:1
/// equirectangular, 4:3 and 3:4 crosses, 6:1 a strip, 1:1 a sphere map where the corners outside of the ball are black.
/// Throws Failure::input for missing faces, faces of different sizes, sides that are no shape's, crosses with something
/// beside the faces, and texels that are not numbers in 0..kMostRadiance; as readImage does.
EnvironmentFile readEnvironment(const std::string& path, std::optional<EnvironmentShape> shape = {});

/// "a cube (cross) of 6 x 128 x 128 texels".
std::string describe(const EnvironmentPicture& picture, CubeLayout layout);

/// All faces of a cube in one picture; what is no face is black. `layout` is not files.
Image arrangeFaces(const EnvironmentPicture& cube, CubeLayout layout);

/// The files that an environment of that path is written to: six for a path with {face}.
std::vector<std::string> listEnvironmentFiles(const std::string& path);

/// Writes a picture as writeImage does. A cube goes to six files where the path has {face}, else to one picture.
/// Throws Failure::usage for a path with {face} and another shape than a cube.
void writeEnvironment(const std::string& path, const EnvironmentPicture& picture, CubeLayout layout, SampleType sample);

} // namespace relief
