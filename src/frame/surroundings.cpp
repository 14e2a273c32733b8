// The environment at a point of a scene.
#include "frame/frame.h"

namespace relief {

EnvironmentPicture captureSurroundings(Device& device, std::span<const Instance> instances, RenderOptions options,
                                       const SurroundingsDesc& desc) {
    Renderer renderer(device, {.width = desc.side, .height = desc.side});
    const EnvironmentPicture studio = desc.behind == nullptr ? makeStudioPicture() : EnvironmentPicture();
    const EnvironmentPicture& behind = desc.behind == nullptr ? studio : *desc.behind;
    EnvironmentPicture cube{.shape = EnvironmentShape::cube, .images = {}};
    options.layers.clear();
    for (int face = 0; face < kCubeFaces; ++face) {
        // A camera whose picture is the face: it looks along the middle, and perspectiveMatrix() has the face's own
        // right and up there, above and below too.
        options.camera = {.eye = desc.at,
                          .target = desc.at + directionOf(EnvironmentShape::cube, {face, dvec2(0.5)}),
                          .fieldOfView = 90};
        fitDepth(options.camera, options.bounds);
        const Image seen = renderer.render(instances, options).image();

        // Over what is behind, which is seen through what the instances do not cover of a pixel.
        Image& image = cube.images.emplace_back(Image{desc.side, desc.side, 3, {}});
        for (int y = 0; y < desc.side; ++y)
            for (int x = 0; x < desc.side; ++x) {
                const float* c = seen.at(x, y);
                const dvec2 at = (dvec2(x, y) + 0.5) / double(desc.side);
                const dvec3 far = lookUp(behind, directionOf(EnvironmentShape::cube, {face, at}));
                for (int i = 0; i < 3; ++i) image.texels.push_back(float(c[i] + (1.0 - c[3]) * far[i]));
            }
    }
    return cube;
}

} // namespace relief
