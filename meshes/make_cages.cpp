// make_cages OUTDIR: writes every cage of this folder as OBJ. The same bytes every time.
#include <exception>
#include <filesystem>

#include "lantern.h"
#include "octopus.h"
#include "simple_cages.h"
#include "strawberry.h"

int main(int argc, char** argv) {
    using namespace relief;
    using namespace relief::meshes;
    const std::pair<const char*, Cage (*)()> kCages[] = {
        {"ball", makeBall},   {"cube", makeCube},   {"lantern", makeLantern},       {"octopus", makeOctopus},
        {"plane", makePlane}, {"torus", makeTorus}, {"strawberry", makeStrawberry},
    };
    try {
        if (argc != 2) fail(Failure::usage, "usage: make_cages OUTDIR");
        std::filesystem::create_directories(argv[1]);
        for (const auto& [name, make] : kCages) writeObj(fmt::format("{}/{}.obj", argv[1], name), make());
    } catch (const Error& error) {
        fmt::print(stderr, "make_cages: {}\n", error.what());
        return int(error.failure);
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_cages: {}\n", error.what());
        return int(Failure::internal);
    }
    return 0;
}
