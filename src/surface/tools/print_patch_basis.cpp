// Writes OpenSubdiv's patch basis functions as GLSL to the file named on the command line. A build tool.
#include <fstream>
#include <iostream>

#include <opensubdiv/osd/glslPatchShaderSource.h>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ofstream file(argv[1]);
    file << OpenSubdiv::Osd::GLSLPatchShaderSource::GetPatchBasisShaderSource();
    file.close();
    if (!file) std::cerr << argv[1] << ": cannot be written\n";
    return file ? 0 : 4;
}
