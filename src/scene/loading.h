// The parts of load(), which are in files of their own.
#pragma once

#include <functional>

#include "cage/gltf.h"
#include "scene/scene.h"

namespace relief {

/// The triangles of a geometry image: polygons with normals, whose texture coordinates are places in the image.
/// Throws as readGeometryImage does, and Failure::usage for a mip that it does not have.
Cage readGeometryImageCage(const ObjectDesc& desc);

/// Applies ObjectDesc::placement to the texture coordinates of a cage, in double precision: repeat * (s,t) + offset.
/// Throws Failure::input for a cage without texture coordinates, Failure::usage for an object with a set of tiles.
void placeTexCoords(Cage& cage, const ObjectDesc& desc);

/// Reads the height map of an object, and adds its layers. Warns of a cage without texture coordinates, of tiles that a
/// set lacks, and as warnOutsideMap does. Throws Failure::usage for what does not go with a set of tiles or a map per
/// face, and Failure::input for a set and a cage without texture coordinates.
EncodedMap loadHeights(const ObjectDesc& desc, const Cage& cage, const Warn& warn);

/// Fits a map per face to the surface of its cage and stores it as its encoding says. Warns of other maps that say in
/// their header that they were baked over another cage, or for another mid or scale.
/// Throws Failure::input for a map per face that was made for another cage.
void fitHeights(LoadedObject& object, const ObjectDesc& desc, const Warn& warn);

/// Reads and compiles the height function of an object. Its bounds are not known yet.
FunctionHeights loadFunction(const ObjectDesc& desc, const Cage& cage);

/// Reads a color map. Throws Failure::input for fewer than 3 channels and for texels that are not finite; warns where
/// the file has several layers and where values are clamped to 0..1.
Image loadColors(const std::string& path, const Warn& warn);
/// Reads the color map of an object as loadColors() does: one picture, or all files of a set of tiles.
void loadAlbedo(LoadedObject& object, const std::string& path, const Warn& warn);

/// The pictures of a set of tiles in one, over all unit squares that the set spans.
struct JoinedPictures {
    Image image; ///< 3 channels
    PictureTiles tiles;
};
/// A picture of one unit square.
struct PictureSquare {
    ivec2 place{0};                         ///< lowest (s,t)
    ivec2 size{1};                          ///< pixels
    std::function<Image(const Warn&)> read; ///< 3 channels or more; is called on any thread
};
/// Joins them on all cores, as joinPictures() does; at least one. `name` stands for them in messages.
JoinedPictures joinSquares(const std::vector<PictureSquare>& squares, const std::optional<vec3>& empty,
                           const std::string& name, const Warn& warn);
/// Reads them on all cores. Tiles of other sizes become as large as the largest, or as the picture allows. Squares
/// without a tile have one color: `empty`, or where there is none the mean of all tiles.
/// Throws as listTiles and loadColors do; warns of tiles that are made smaller.
JoinedPictures joinPictures(const std::string& path, const std::optional<vec3>& empty, const Warn& warn);

/// Reads a square color picture of a ball. Colors of 8 and 16 bits are sRGB, as --albedo; floats are linear.
/// Throws Failure::input for other pictures and for texels that are not finite.
Image loadMatcap(const std::string& path);

/// Reads the normal map of an object.
/// Throws Failure::usage for one of object space on a cage that moves, and as loadNormalMap does.
NormalMap loadNormals(const ObjectDesc& desc, const LoadedObject& object, const Warn& warn);

/// The materials of a glTF file whose textures are taken: those that the command line does not name.
struct GltfLooks {
    std::vector<GltfMaterial> materials;
    bool isSplit = false; ///< the texture coordinates of material i were moved to the unit square (i,0)
};
/// Reads the materials of a glTF file; returns none for other files. Where materials have textures of their own and
/// nothing but those textures is looked up by texture coordinates, moves the coordinates of each material into a unit
/// square of its own. Materials are distinguished by their names, and textures that repeat over their faces cannot be
/// moved.
GltfLooks readLooks(Cage& cage, const ObjectDesc& desc, const Warn& warn);

/// Takes the base color and the normal map of the materials. Materials that are not split share one of each: others are
/// warned of, and so is a picture that cannot be read.
void takeGltfTextures(LoadedObject& object, const ObjectDesc& desc, const GltfLooks& looks, const Warn& warn);

/// Warns where the cage's texture coordinates leave the unit square and nothing says how `map` continues there.
void warnOutsideMap(const ObjectDesc& desc, const Cage& cage, const std::string& map, const Warn& warn);

/// Warns of faces whose texture coordinates span no area, where normals are bent or turned along them.
void warnOfFlatTexCoords(const LoadedObject& object, const std::string& path, const Warn& warn);

/// Takes heights into the unit of the cage's coordinates. Where they are much larger than the cage, that becomes a unit
/// in between, so that squares of both are within the range of floats.
void fitUnitToHeights(LoadedObject& object, const Warn& warn);

/// Joins the vertices of a cage and of what moves it. Throws Failure::usage when no face is left.
void weldObject(LoadedObject& object, const Distance& distance);

/// Warns of a surface that is open between vertices at the same position.
void warnOfCoincidentVertices(const Cage& cage, const std::string& path, const Warn& warn);

/// Warns of subdivision tags on polygons that are drawn themselves without being asked for.
void warnOfUnusedTags(const LoadedObject& object, const ObjectDesc& desc, const Warn& warn);

/// Moves the cage of an animation to the pose of MotionDesc::time, its normals with it.
void poseCage(LoadedObject& object, const MotionDesc& desc);

} // namespace relief
